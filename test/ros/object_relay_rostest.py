#!/usr/bin/env python3
"""Boxes of jsk_recognition_msgs and odometry become landmarks, live, with the launch files; what is wrong is told."""
import copy
import os
import subprocess
import sys
import threading
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "object_relay"))

import roslib.packages  # noqa: E402
import rospy  # noqa: E402
import rostest  # noqa: E402
import street  # noqa: E402
import tf2_ros  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rosgraph_msgs.msg import Log  # noqa: E402
from std_msgs.msg import String  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

from semantic_mht_slam.msg import SemanticMap, SemanticObjectArray  # noqa: E402

WAIT_S = 30.0


class ObjectRelayTest(unittest.TestCase):
    """The relays of object_relay.test: beside slam_node, on a topic of text, and for boxes in a world frame."""

    def setUp(self):
        self.detector = street.JskDetector()
        self.heard = {}
        self.changed = threading.Condition()
        self.warnings, self.statuses = [], {}
        self.odometry = rospy.Publisher("/odometry", Odometry, queue_size=1000)
        self.boxes = rospy.Publisher("/boxes", self.detector.message_class, queue_size=1000)
        rospy.Subscriber("/objects", SemanticObjectArray, lambda m: self.note("objects", m), queue_size=1000)
        rospy.Subscriber("/map", SemanticMap, lambda m: self.note("map", m))
        rospy.Subscriber("/map_as_detections", rospy.AnyMsg, lambda m: self.note("map out", m))
        rospy.Subscriber("/rosout", Log, lambda m: self.warnings.append(m.msg) if m.level >= Log.WARN else None)
        rospy.Subscriber("/diagnostics", DiagnosticArray, lambda m: [self.statuses.update({s.name: s}) for s in m.status])

    def note(self, kind, message):
        with self.changed:
            self.heard.setdefault(kind, []).append(message)
            self.changed.notify_all()

    def wait_for(self, condition, what):
        deadline = time.monotonic() + WAIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, f"{what}: {self.warnings}")
            time.sleep(0.05)

    def drive(self):
        """The first pole is in every message once more, with a class that the table lacks."""
        for frame in range(street.FRAMES):
            self.odometry.publish(street.odometry(frame))
            message = self.detector.detections(frame)
            message.boxes.append(copy.copy(message.boxes[0]))
            message.boxes[-1].label = 1234
            self.boxes.publish(message)
            with self.changed:  # no faster than it is taken, so that no queue overflows
                arrived = self.changed.wait_for(lambda n=frame: len(self.heard.get("objects", [])) > n, WAIT_S)
            self.assertTrue(arrived, f"frame {frame}: {self.warnings}")

    def test_boxes_become_landmarks_and_bad_boxes_are_told(self):
        rospy.wait_for_service("/finish_submap", WAIT_S)
        self.wait_for(lambda: self.boxes.get_num_connections() and self.odometry.get_num_connections(), "subscribers")
        self.wait_for(lambda: any(s.message == "no message on /boxes yet" for s in self.statuses.values()), "diagnostics")
        self.drive()
        answer = rospy.ServiceProxy("/finish_submap", Trigger)()
        self.assertTrue(answer.success, answer.message)
        self.wait_for(lambda: self.heard.get("map") and self.heard["map"][-1].landmarks, "a map")
        landmarks = self.heard["map"][-1].landmarks
        self.assertEqual(street.unmapped([(m.position.x, m.position.y) for m in landmarks]), [])
        self.assertEqual({m.class_id for m in landmarks}, {street.POLE})
        self.wait_for(lambda: self.heard.get("map out"), "the map as vision_msgs")
        self.assertEqual(self.heard["map out"][-1]._connection_header["type"], "vision_msgs/Detection3DArray")
        problem = "class '1234' is not in the class table"
        self.wait_for(lambda: any("/boxes: " in text and problem in text for text in self.warnings), "a warning")
        name = "object_relay: /boxes"
        self.wait_for(lambda: name in self.statuses and any(
            problem in item.key and item.value == str(street.FRAMES) for item in self.statuses[name].values), "counts")
        told = [text for text in self.warnings if problem in text]
        self.assertLess(len(told), street.FRAMES / 4, "warnings are throttled")

    def test_type_without_preset_is_an_error_in_log_and_diagnostics(self):
        publisher = rospy.Publisher("/text", String, queue_size=10)
        self.wait_for(publisher.get_num_connections, "a subscriber")
        publisher.publish("pole")
        problem = "/text is std_msgs/String, for which there is no preset"
        self.wait_for(lambda: any(problem in text for text in self.warnings), "an error")
        name = "of_text/object_relay: /text"
        self.wait_for(lambda: name in self.statuses and self.statuses[name].level == DiagnosticStatus.ERROR, "a status")
        self.assertIn(problem, self.statuses[name].message)
        counts = {item.key: item.value for item in self.statuses[name].values}
        self.assertEqual(counts["messages of a type that cannot be relayed"], "1")

    def test_boxes_in_a_world_frame_come_in_the_frame_of_the_robot(self):
        publisher = rospy.Publisher("/boxes_in_world", self.detector.message_class, queue_size=10)
        rospy.Subscriber("/of_world/objects", SemanticObjectArray, lambda m: self.note("of world", m))
        self.wait_for(publisher.get_num_connections, "a subscriber")
        message = self.detector.detections(0)
        message.header.frame_id = message.boxes[0].header.frame_id = "world"
        publisher.publish(message)
        problem = "/boxes_in_world: 1 messages dropped: no transform from 'world' at their time to target_frame"
        self.wait_for(lambda: problem in self.warnings, "a warning")

        broadcaster = tf2_ros.StaticTransformBroadcaster()
        T_world_base = TransformStamped(child_frame_id="base_link")
        T_world_base.header.frame_id = "world"
        T_world_base.transform.translation.x = 5.0
        T_world_base.transform.rotation.w = 1.0
        broadcaster.sendTransform(T_world_base)
        deadline = time.monotonic() + WAIT_S
        while not self.heard.get("of world") and time.monotonic() < deadline:
            publisher.publish(message)
            time.sleep(0.2)
        array = self.heard["of world"][-1]
        self.assertEqual(array.header.frame_id, "base_link")
        self.assertEqual(len(array.objects), len(message.boxes))
        self.assertAlmostEqual(array.objects[0].position.x, message.boxes[0].pose.position.x - 5.0)

    def test_parameter_that_there_is_not_ends_the_program_with_one_line(self):
        program = roslib.packages.find_node("semantic_mht_slam", "object_relay")[0]
        run = subprocess.run([program, "__name:=wrong", "_colour:=red"], capture_output=True, text=True, check=False,
                             timeout=WAIT_S)
        self.assertEqual(run.returncode, 1)
        self.assertIn("object_relay: unknown parameter '~colour' (parameters: class_table,", run.stderr)


if __name__ == "__main__":
    rospy.init_node("object_relay_rostest")
    rostest.rosrun("semantic_mht_slam", "object_relay_test", ObjectRelayTest)
