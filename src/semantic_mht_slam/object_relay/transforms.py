"""Transforms for objects that are wanted in another frame than their message's."""
import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

from . import geometry


class TargetFrame:
    """Looks up T_target_source at a stamp. `wait`: how long a transform that is still to come is waited for."""

    def __init__(self, frame, buffer, wait):
        self._frame = frame.lstrip("/")
        self._buffer = buffer
        self._wait = wait

    def __call__(self, source, stamp):
        """(target frame, rotation matrix, translation in metres), or None without a transform at that time."""
        if source == self._frame:
            return self._frame, geometry.IDENTITY, (0.0, 0.0, 0.0)
        try:
            if self._wait is None:
                found = self._buffer.lookup_transform_core(self._frame, source, stamp)
            else:
                found = self._buffer.lookup_transform(self._frame, source, stamp, self._wait)
        except tf2_ros.TransformException:
            return None
        q, t = found.transform.rotation, found.transform.translation
        R = geometry.rotation(q.x, q.y, q.z, q.w)
        return R and (self._frame, R, (t.x, t.y, t.z))


def of_bag(bag, frame):
    """The TargetFrame of a bag's /tf and /tf_static."""
    length_s = max(bag.get_end_time() - bag.get_start_time(), 0.0) + 1.0
    buffer = tf2_ros.BufferCore(rospy.Duration(length_s))
    for topic, raw, _ in bag.read_messages(topics=["/tf", "/tf_static"], raw=True):
        for transform in TFMessage().deserialize(raw[1]).transforms:  # tf2 wants the installed classes, not the bag's
            put = buffer.set_transform_static if topic == "/tf_static" else buffer.set_transform
            put(transform, "bag")
    return TargetFrame(frame, buffer, None)


def live(frame, wait_s):
    """The TargetFrame of tf, and the listener that must be kept alive."""
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    return TargetFrame(frame, buffer, rospy.Duration(wait_s)), listener
