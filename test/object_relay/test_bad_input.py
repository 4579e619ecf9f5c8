"""What cannot be used is refused in one line that names file or topic, type, field and the fix; single objects are dropped,
counted and said."""
import io
import math
import unittest

import definitions
import genpy
import rosbag
import std_msgs.msg
from relay_case import RelayCase
from samples import samples, set_header, set_xyz

JSK = "jsk_recognition_msgs/BoundingBoxArray"


def boxes(*changes):
    """A jsk message with a good box for each change, changed by it; None leaves the box good."""
    types = definitions.classes(definitions.JSK, JSK)
    message = types[JSK]()
    set_header(message.header)
    for change in changes:
        box = types["jsk_recognition_msgs/BoundingBox"](label=5, value=0.5)
        box.pose.orientation.w = 1.0
        set_xyz(box.pose.position, 1.0, 2.0, 3.0)
        set_xyz(box.dimensions, 1.0, 1.0, 1.0)
        if change:
            change(box)
        message.boxes.append(box)
    return message


class DroppedObjectsTest(RelayCase):
    def expect_drop(self, change, cause):
        """Of three boxes the changed one is dropped, which is said once with its count."""
        code, said = self.relay(self.bag_of([boxes(None, change, None), boxes(change)]))
        self.assertEqual(code, 0, said)
        self.assertEqual([len(m.objects) for m, _ in self.messages(self.path("out.bag"), "/objects")], [2, 0])
        self.assertIn(f"/detections: 2 {cause}", said)

    def test_unknown_class_is_named_with_the_table(self):
        self.expect_drop(lambda box: setattr(box, "label", 6), "objects dropped: class '6' is not in the class table"
                         f" ({self.table})")

    def test_position_that_is_not_finite(self):
        self.expect_drop(lambda box: setattr(box.pose.position, "y", math.nan),
                         "objects dropped: the position is not finite")
        self.expect_drop(lambda box: setattr(box.pose.position, "z", math.inf),
                         "objects dropped: the position is not finite")

    def test_object_in_another_frame_than_its_message(self):
        self.expect_drop(lambda box: setattr(box.header, "frame_id", "map"),
                         "objects dropped: in frame 'map', their message in 'sensor'")

    def test_object_without_hypotheses(self):
        message = samples()["vision_msgs_noetic"].message
        message.detections[0].results = []
        said = self.refused(self.bag_of([message]))
        self.assertIn("no object could be used: /detections: 1 objects dropped: field 'results' is empty", said)

    def test_covariance_that_is_none(self):
        message = samples()["eufs_msgs"].message
        message.blue_cones[0].covariance = [-1.0, 0.0, 0.0, 1.0]
        code, said = self.relay(self.bag_of([message]))
        self.assertEqual(code, 0, said)
        self.assertIn("1 objects dropped: the covariance is not finite or has a variance that is not above 0", said)

    def test_size_and_score_that_cannot_be_used_are_left_out_and_the_object_stays(self):
        def change(box):
            box.dimensions.x = math.nan
            box.value = 17.0

        code, said = self.relay(self.bag_of([boxes(change)]))
        self.assertEqual(code, 0, said)
        (array, _), = self.messages(self.path("out.bag"), "/objects")
        self.assertEqual((array.objects[0].size.x, array.objects[0].score), (0.0, -1.0))
        self.assertIn("1 sizes left out: not finite, or below 0", said)
        self.assertIn("1 scores taken as unknown: not in [0, 1]", said)

    def test_message_without_a_frame(self):
        message = boxes(None)
        message.header.frame_id = message.boxes[0].header.frame_id = ""
        said = self.refused(self.bag_of([message]))
        self.assertIn("1 messages dropped: no frame_id", said)
        self.assertEqual(self.relay(self.bag_of([message]), "--source-frame", "lidar")[0], 0)

    def test_bytes_that_do_not_fit_the_definition(self):
        good = boxes(None)
        buffer = io.BytesIO()
        good.serialize(buffer)
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            for data in (buffer.getvalue(), buffer.getvalue()[:-7], b"", b"\xff" * 200):
                bag.write("/detections", (JSK, data, good._md5sum, type(good)), genpy.Time(1), raw=True)
        code, said = self.relay(self.path("in.bag"))
        self.assertEqual(code, 0, said)
        self.assertEqual([len(m.objects) for m, _ in self.messages(self.path("out.bag"), "/objects")], [1])
        counts = [int(line.split()[1]) for line in said.splitlines() if "the bytes do not fit the definition" in line]
        self.assertEqual(sum(counts), 3, said)

    def test_array_of_objects_that_is_not_there(self):
        message = samples()["vision_msgs_noetic"].message
        message.detections = []
        mapping = self.write("mine.yaml", "type: vision_msgs/Detection3DArray\nobjects: detections[0].results\nclass: id\n"
                                          "position: pose.pose.position")
        self.assertIn("1 messages dropped: field 'detections' is empty", self.refused(self.bag_of([message]), "--mapping",
                                                                                     mapping))

    def test_labels_that_are_to_be_left_out_are_counted_but_no_problem(self):
        code, said = self.relay(self.bag_of([boxes(None)]), "--classes", "{5: null}")
        self.assertEqual(code, 0, said)
        self.assertIn("/detections: 1 objects of the class '5', to be left out", said)

    def test_an_empty_message_is_passed_on(self):
        code, said = self.relay(self.bag_of([boxes()]))
        self.assertEqual(code, 0, said)
        self.assertEqual([len(m.objects) for m, _ in self.messages(self.path("out.bag"), "/objects")], [0])


class RefusedInputTest(RelayCase):
    def expect_mapping_error(self, text, problem):
        said = self.refused(self.bag_of([boxes(None)]), "--mapping", self.write("mine.yaml", text))
        self.assertIn(problem, said)

    def test_field_that_the_type_lacks_is_named_with_topic_type_and_what_there_is(self):
        self.expect_mapping_error(
            f"type: {JSK}\nobjects: boxes\nclass: label\nposition: pose.center",
            f"/detections ({JSK}), mapping 'mine', key 'position': 'pose.center': geometry_msgs/Pose has no field 'center'"
            " (it has position, orientation)")

    def test_fields_of_the_wrong_kind(self):
        head = f"type: {JSK}\nobjects: boxes\n"
        self.expect_mapping_error(head + "class: pose\nposition: pose.position", "key 'class': 'pose' is geometry_msgs/Pose")
        self.expect_mapping_error(head + "class: label\nposition: value", "'value' is float32, which is no vector")
        self.expect_mapping_error(head + "class: label\nposition: pose.position\nscore: header.frame_id",
                                  "key 'score': 'header.frame_id' is string")
        self.expect_mapping_error(f"type: {JSK}\nobjects: header\nposition: pose.position",
                                  "key 'objects': 'header' is std_msgs/Header, no array")

    def test_mapping_files_that_are_none(self):
        self.expect_mapping_error("[1, 2", "mine.yaml: no YAML")
        self.expect_mapping_error("just text", "mine.yaml: a mapping is a YAML table")
        self.expect_mapping_error("type: a/B\nobjects: x\nposition: p\ncolour: red", "unknown key 'colour' (keys: type,")
        self.expect_mapping_error("type: a/B\nobjects: x", "key 'position' is missing")
        self.expect_mapping_error("type: a/B\nobjects: x\nposition: [a, b]", "key 'position' must be a path, three paths")
        self.expect_mapping_error("type: a/B\nobjects: x\nposition: p\naxes: [x, x, z]", "key 'axes' must name x, y and z")
        self.expect_mapping_error("type: a/B\nobjects: x\nposition: p\nscore_max: 0", "key 'score_max' must be a number")
        self.expect_mapping_error("type: a/B\nobjects: x\nposition: p", f"is {JSK}, mapping 'mine' is for a/B")

    def test_preset_that_there_is_not(self):
        self.assertIn("no preset 'jks' (presets: autoware,", self.refused(self.bag_of([boxes(None)]), "--mapping", "jks"))

    def test_type_without_preset(self):
        bag = self.bag_of([std_msgs.msg.String("pole")])
        said = self.refused(bag, "--topic", "/detections")
        self.assertIn("/detections is std_msgs/String, for which there is no preset (there are: autoware_msgs/", said)
        self.assertIn("no topic that a preset can read: name one with --topic", self.refused(bag))

    def test_topic_that_there_is_not(self):
        said = self.refused(self.bag_of([boxes(None)]), "--topic", "/boxes")
        self.assertIn(f"in.bag: no topic /boxes (topics: /detections ({JSK}))", said)

    def test_messages_without_classes_need_one(self):
        bag = self.bag_of([samples()["pose_array"].message])
        self.assertIn("geometry_msgs/PoseArray says no class: name the one of all objects", self.refused(bag))
        self.assertIn("class 'tree' is not in", self.refused(bag, "--class", "tree"))

    def test_class_tables_and_renamings(self):
        bag = self.bag_of([boxes(None)])
        self.assertIn("none.yaml: No such file", self.refused(bag, table=self.path("none.yaml")))
        self.assertIn("it has no list 'classes'", self.refused(bag, table=self.write("t.yaml", "a: 1")))
        self.assertIn("'5' is to be 'mast', which is not in", self.refused(bag, "--classes", "{5: mast}"))

    def test_bags_that_are_none(self):
        self.assertIn("none.bag: No such file or directory", self.refused(self.path("none.bag")))
        self.assertIn("no bag at all", self.refused(self.write("text.bag", "text")))
        whole = self.bag_of([boxes(None)] * 20)
        with open(whole, "rb") as file:
            cut = file.read()[:6000]
        with open(self.path("cut.bag"), "wb") as file:
            file.write(cut)
        self.assertIn("cut.bag: ", self.refused(self.path("cut.bag")))

    def test_output_that_would_overwrite_the_input_or_a_topic(self):
        bag = self.bag_of([boxes(None)], "/objects")
        self.assertIn("topic /objects is in the bag already: name another one with --output-topic", self.refused(bag))
        code, said = self.relay(bag, "--output", bag)
        self.assertEqual(code, 1)
        self.assertIn("the output is the input", said)


if __name__ == "__main__":
    unittest.main()
