"""A map goes out as another message by the mapping that reads that message, in reverse."""
import unittest

import definitions
import genpy
from relay_case import RelayCase
from samples import STAMP

from semantic_mht_slam.msg import Landmark, SemanticClass, SemanticMap
from semantic_mht_slam.object_relay.mapping import load_mapping
from semantic_mht_slam.object_relay.map_export import exported_type

DETECTIONS = "vision_msgs/Detection3DArray"


def town():
    """A map of a pole and a vehicle."""
    message = SemanticMap()
    message.header.stamp, message.header.frame_id = STAMP, "map"
    message.classes = [SemanticClass(id=5, name="pole"), SemanticClass(id=7, name="vehicle")]
    for class_id, x, existence in ((5, 3.0, 0.9), (7, -8.0, 0.5)):
        landmark = Landmark(class_id=class_id, existence_prob=existence, covariance=[x, 0, 0, 0, 2, 0.5, 0, 0.5, 3])
        landmark.position.x, landmark.position.y, landmark.position.z = x, 1.0, -0.5
        message.landmarks.append(landmark)
    return message


class MapExportTest(RelayCase):
    def exported(self, *arguments):
        code, said = self.relay(self.bag_of([town()], "/map"), "--map-as", *arguments)
        self.assertEqual(code, 0, said)
        self.assertIn("1 messages of /map (semantic_mht_slam/SemanticMap) -> 1 messages with 2 landmarks on /map_out", said)
        (message, received), = self.messages(self.path("out.bag"), "/map_out")
        self.assertEqual(received, genpy.Time(1))
        return message

    def test_the_type_that_is_written_is_that_of_the_released_package(self):
        released = {name: md5sum for _, name, md5sum in definitions.RELEASED_MD5SUMS}
        self.assertEqual(exported_type(load_mapping("vision_msgs")).root._md5sum, released[DETECTIONS])

    def test_map_as_vision_msgs(self):
        message = self.exported("vision_msgs")
        self.assertEqual(message._type, DETECTIONS)
        self.assertEqual((message.header.frame_id, message.header.stamp), ("map", STAMP))
        self.assertEqual([d.results[0].id for d in message.detections], [5, 7])
        self.assertEqual([d.results[0].score for d in message.detections], [0.9, 0.5])
        pole = message.detections[0]
        self.assertEqual((pole.header.frame_id, pole.header.stamp), ("map", STAMP))
        position = pole.bbox.center.position
        self.assertEqual((position.x, position.y, position.z), (3.0, 1.0, -0.5))
        self.assertEqual(pole.bbox.center.orientation.w, 1.0)
        covariance = pole.results[0].pose.covariance
        self.assertEqual({i: v for i, v in enumerate(covariance) if v}, {0: 3.0, 7: 2.0, 8: 0.5, 13: 0.5, 14: 3.0})

    def test_what_was_written_is_read_back_as_objects(self):
        self.exported("vision_msgs")
        written = self.path("map.bag")
        self.bag_of([m for m, _ in self.messages(self.path("out.bag"), "/map_out")], "/map_out", "map.bag")
        code, said = self.relay(written)
        self.assertEqual(code, 0, said)
        (array, _), = self.messages(self.path("out.bag"), "/objects")
        for found, landmark in zip(array.objects, town().landmarks):
            self.assertEqual(found.class_id, landmark.class_id)
            self.assertEqual([getattr(found.position, axis) for axis in "xyz"],
                             [getattr(landmark.position, axis) for axis in "xyz"])
            self.assertEqual(list(found.covariance), list(landmark.covariance))
            self.assertEqual(found.score, landmark.existence_prob)

    def test_names_of_the_detector_are_used_where_the_type_has_text(self):
        message = self.exported("marker_array", "--classes", "{mast: pole}")
        self.assertEqual([marker.ns for marker in message.markers], ["mast", "car"])
        self.assertEqual([marker.pose.position.x for marker in message.markers], [3.0, -8.0])
        self.assertEqual({marker.header.frame_id for marker in message.markers}, {"map"})

    def test_what_cannot_be_written_is_refused(self):
        bag = self.bag_of([town()], "/map")
        self.assertIn("zed_interfaces/ObjectsStamped is not installed and the mapping has no 'definition'",
                      self.refused(bag, "--map-as", "zed"))
        self.assertIn("must each be one path to write a map", self.refused(bag, "--map-as", "pose_array"))
        self.assertIn("'mast' is to be 'tree', which is not in the class table of the map (5 pole, 7 vehicle)",
                      self.refused(bag, "--map-as", "vision_msgs", "--classes", "{mast: tree}"))
        broken = town()
        broken.classes.pop()
        self.assertIn("the map has a landmark of class 7, which its class table lacks (5 pole)",
                      self.refused(self.bag_of([broken], "/map"), "--map-as", "vision_msgs"))


if __name__ == "__main__":
    unittest.main()
