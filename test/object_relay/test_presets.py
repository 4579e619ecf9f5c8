"""A bag of each type that a preset reads becomes objects, without the package of the type."""
import unittest

import genpy
import rosbag
from definitions import RELEASED_MD5SUMS, classes
from relay_case import RelayCase
from samples import STAMP, samples

from semantic_mht_slam.object_relay.mapping import presets


class PresetTest(RelayCase):
    """One test for each sample, added below."""

    def expect_object(self, found, expected):
        self.assertEqual(found.class_id, expected.cls)
        self.assertEqual(found.is_moving, expected.is_moving)
        for value, wanted in zip((found.position.x, found.position.y, found.position.z), expected.xyz):
            self.assertAlmostEqual(value, wanted, 6)
        for value, wanted in zip((found.size.x, found.size.y, found.size.z), expected.size or (0, 0, 0)):
            self.assertAlmostEqual(value, wanted, 6)
        for i, value in enumerate(found.covariance):
            wanted = expected.variances[i // 4] if expected.variances and i % 4 == 0 else 0.0
            self.assertAlmostEqual(value, wanted, 6)
        self.assertAlmostEqual(found.score, expected.score, 6)

    def expect_sample(self, sample):
        bag = self.bag_of([sample.message, sample.message])
        code, said = self.relay(bag, *sample.arguments)
        self.assertEqual(code, 0, said)
        arrays = self.messages(self.path("out.bag"), "/objects")
        self.assertEqual(len(arrays), 2, said)
        for number, (array, received) in enumerate(arrays):
            self.assertEqual(received, genpy.Time(number + 1))
            has_stamp = hasattr(sample.message, "header") or hasattr(sample.message, "markers")
            self.assertEqual(array.header.stamp, STAMP if has_stamp else received)
            self.assertEqual(array.header.frame_id, sample.frame)
            self.assertEqual(len(array.objects), len(sample.expected), said)
            for found, expected in zip(array.objects, sample.expected):
                self.expect_object(found, expected)
        self.assertIn(f"2 messages of /detections ({sample.message._type}) -> 2 messages with"
                      f" {2 * len(sample.expected)} objects on /objects", said)
        with rosbag.Bag(self.path("out.bag")) as made:
            topics = made.get_type_and_topic_info().topics
        self.assertEqual(topics["/detections"].message_count, 2)
        self.assertEqual(topics["/detections"].msg_type, sample.message._type)

    def test_every_preset_has_a_sample(self):
        self.assertEqual({sample.preset for sample in samples().values()}, set(presets()))

    def test_definitions_of_the_tests_are_those_of_the_released_packages(self):
        for package, name, md5sum in RELEASED_MD5SUMS:
            self.assertEqual(classes(package, name)[name]._md5sum, md5sum, name)


def _test_of(name):
    return lambda self: self.expect_sample(samples()[name])


for _name in samples():
    setattr(PresetTest, f"test_{_name}", _test_of(_name))

if __name__ == "__main__":
    unittest.main()
