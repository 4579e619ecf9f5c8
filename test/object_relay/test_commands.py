"""The commands of docs/bring_your_own_data.md, as they stand there, from a detector's bag to a map."""
import csv
import os
import re
import subprocess
import unittest

import rosbag
import street
from relay_case import RelayCase

REPOSITORY = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")


def commands(marker):
    """The lines of the code block behind a comment of the document."""
    with open(os.path.join(REPOSITORY, "docs", "bring_your_own_data.md"), encoding="utf-8") as file:
        block = re.search(re.escape(f"<!-- {marker} -->") + r"\s*```sh\n(.*?)```", file.read(), re.DOTALL)
    return block.group(1)


class CommandsTest(RelayCase):
    def expect_map(self, detector):
        with rosbag.Bag(self.path("drive.bag"), "w") as bag:
            for frame in range(street.FRAMES):
                bag.write("/odometry", street.odometry(frame), street.stamp_of(frame))
                bag.write("/detections", detector.detections(frame), street.stamp_of(frame))
        lines = commands("commands: bag to map")
        self.assertEqual(len(lines.splitlines()), 3, "three commands")
        run = subprocess.run(["bash", "-euc", lines], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             text=True, check=False, timeout=300)
        self.assertEqual(run.returncode, 0, run.stdout)
        with open(self.path("result/landmarks.csv"), encoding="utf-8") as file:
            landmarks_m = [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]
        self.assertEqual(street.unmapped(landmarks_m), [], run.stdout)
        self.assertLess(len(landmarks_m), 1.2 * len(street.POLES_M))
        (message, _), = self.messages(self.path("map_detections.bag"), "/map_out")
        self.assertEqual(len(message.detections), len(landmarks_m))

    def test_readme_has_the_same_commands(self):
        with open(os.path.join(REPOSITORY, "README.md"), encoding="utf-8") as file:
            self.assertIn("```sh\n" + commands("commands: bag to map") + "```", file.read())

    def test_bag_of_jsk_boxes(self):
        self.expect_map(street.JskDetector())

    def test_bag_of_vision_msgs(self):
        self.expect_map(street.VisionDetector())


if __name__ == "__main__":
    unittest.main()
