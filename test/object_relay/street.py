"""A drive along a street with poles: odometry and detections as messages of a detector's own type."""
import math
import random

import definitions
import genpy
from nav_msgs.msg import Odometry
from samples import set_xyz

POLE = 80  # of classes_semantic_kitti.yaml
STEP_S = 0.1
STEP_M = 0.5
SIGHT_M = 25.0
FRAMES = 160
POLES_M = [(4.0 * i + (1.3 * i) % 2.0, (-1) ** i * (5.0 + (0.7 * i) % 3.0)) for i in range(1, 22)]


def stamp_of(frame):
    """When a frame was taken."""
    return genpy.Time.from_sec(100.0) + genpy.Duration.from_sec(STEP_S * frame)


def odometry(frame):
    """odom -> base_link: straight along x."""
    message = Odometry(child_frame_id="base_link")
    message.header.stamp, message.header.frame_id = stamp_of(frame), "odom"
    message.pose.pose.position.x = STEP_M * frame
    message.pose.pose.orientation.w = 1.0
    return message


def seen_m(frame):
    """Places of the poles in sight, in base_link, as a detector measures them (0.05 m)."""
    rng = random.Random(frame)
    places = [(x - STEP_M * frame, y) for x, y in POLES_M]
    return [(x + rng.gauss(0, 0.05), y + rng.gauss(0, 0.05), 0.5) for x, y in places if math.hypot(x, y) < SIGHT_M]


class JskDetector:
    """Says boxes of jsk_recognition_msgs."""

    def __init__(self):
        self._types = definitions.classes(definitions.JSK, "jsk_recognition_msgs/BoundingBoxArray")
        self.message_class = self._types["jsk_recognition_msgs/BoundingBoxArray"]

    def detections(self, frame):
        """The message of a frame."""
        message = self.message_class()
        message.header.stamp, message.header.frame_id = stamp_of(frame), "base_link"
        for place in seen_m(frame):
            box = self._types["jsk_recognition_msgs/BoundingBox"](label=POLE, value=0.9)
            box.header = message.header
            set_xyz(box.pose.position, *place)
            box.pose.orientation.w = 1.0
            set_xyz(box.dimensions, 0.2, 0.2, 3.0)
            message.boxes.append(box)
        return message


class VisionDetector:
    """Says Detection3D of vision_msgs."""

    def __init__(self):
        self._types = definitions.classes(definitions.VISION_NOETIC, "vision_msgs/Detection3DArray")
        self.message_class = self._types["vision_msgs/Detection3DArray"]

    def detections(self, frame):
        """The message of a frame."""
        message = self.message_class()
        message.header.stamp, message.header.frame_id = stamp_of(frame), "base_link"
        for place in seen_m(frame):
            found = self._types["vision_msgs/Detection3D"](header=message.header)
            found.results = [self._types["vision_msgs/ObjectHypothesisWithPose"](id=POLE, score=0.9)]
            set_xyz(found.bbox.center.position, *place)
            message.detections.append(found)
        return message


def unmapped(landmarks_m):
    """The poles that were passed and have no landmark within 0.3 m."""
    passed = [(x, y) for x, y in POLES_M if x < STEP_M * FRAMES]
    return [pole for pole in passed if not any(math.dist(pole, place[:2]) < 0.3 for place in landmarks_m)]
