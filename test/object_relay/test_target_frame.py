"""Objects in another frame than that of their message, by the transforms of the bag."""
import unittest

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from relay_case import RelayCase
from samples import HALF, STAMP, samples
from tf2_msgs.msg import TFMessage


def transform(stamp, parent, child, xyz, quarter_turn=False):
    """T_parent_child, with a quarter turn about z if wanted."""
    made = TransformStamped(child_frame_id=child)
    made.header.stamp, made.header.frame_id = stamp, parent
    made.transform.translation.x, made.transform.translation.y, made.transform.translation.z = xyz
    made.transform.rotation.w = HALF if quarter_turn else 1.0
    made.transform.rotation.z = HALF if quarter_turn else 0.0
    return TFMessage(transforms=[made])


class TargetFrameTest(RelayCase):
    def bag_with_transforms(self):
        """The sample of vision_msgs in `sensor`; base_link moves in it along x, 10 m/s, passing 5 m at the message's stamp."""
        path = self.path("in.bag")
        with rosbag.Bag(path, "w") as bag:
            bag.write("/detections", samples()["vision_msgs_noetic"].message, STAMP)
            bag.write("/tf_static", transform(genpy.Time(0), "world", "sensor", (1.0, 0.0, 0.0), True), genpy.Time(1))
            for seconds in (-1, 1):
                stamp = STAMP + genpy.Duration(seconds)
                bag.write("/tf", transform(stamp, "sensor", "base_link", (5.0 + 10.0 * seconds, 0.0, 0.0)), stamp)
        return path

    def test_position_size_and_covariance_are_transformed_at_the_stamp(self):
        code, said = self.relay(self.bag_with_transforms(), "--target-frame", "base_link")
        self.assertEqual(code, 0, said)
        (array, _), = self.messages(self.path("out.bag"), "/objects")
        self.assertEqual((array.header.frame_id, array.header.stamp), ("base_link", STAMP))
        found = array.objects[0]
        self.assertAlmostEqual(found.position.x, 5.0, 6)
        self.assertAlmostEqual(found.position.y, 2.0, 6)

        code, said = self.relay(self.bag_with_transforms(), "--target-frame", "world")
        self.assertEqual(code, 0, said)
        (array, _), = self.messages(self.path("out.bag"), "/objects")
        found = array.objects[0]
        for value, wanted in ((found.position.x, -1.0), (found.position.y, 10.0), (found.position.z, -1.0),
                              (found.size.x, 4.0), (found.size.y, 2.0), (found.covariance[0], 0.2),
                              (found.covariance[4], 0.1)):
            self.assertAlmostEqual(value, wanted, 6)

    def test_message_without_a_transform_is_dropped_and_said(self):
        said = self.refused(self.bag_with_transforms(), "--target-frame", "rear_axle")
        self.assertIn("1 messages dropped: no transform from 'sensor' at their time to target_frame", said)


if __name__ == "__main__":
    unittest.main()
