#!/usr/bin/env python3
"""README's lines for one's own robot, run as they are written but for the names that stand for a user's own."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from semantic_mht_slam.msg import SemanticMap

WAIT_S = 60.0
PACKAGE = "semantic_mht_slam"
REPOSITORY = Path(__file__).resolve().parents[2]


class ReadmeCommandsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = dict(os.environ, HOME=self.folder, ROS_HOME=os.path.join(self.folder, "ros"))
        text = (REPOSITORY / "README.md").read_text(encoding="utf-8")
        own = text.split("## Your own robot")[1].split("\n## ")[0]
        self.lines = [re.sub(r"\s+#.*", "", line) for block in re.findall(r"```sh\n(.*?)```", own, re.DOTALL)
                      for line in block.splitlines()]
        rospy.set_param("/use_sim_time", True)
        self.run_line(f"rosrun {PACKAGE} simulate_drive --scenario {REPOSITORY}/config/scenarios/town.yaml --seed 1 "
                      "--set route.length=150 --output drive")

    def line(self, begin):
        """README's one line that begins so, with names that there are."""
        found = [line for line in self.lines if line.startswith(begin)]
        self.assertEqual(len(found), 1, begin)
        names = {"/your/objects": "/objects", "/your/odometry": "/odometry",
                 "/path/to/your_classes.yaml": str(REPOSITORY / "config/classes_semantic_kitti.yaml"),
                 "/path/to/map.bag": os.path.join(self.folder, "map.bag")}
        for name, own in names.items():
            found[0] = found[0].replace(name, own)
        return found[0]

    def run_line(self, line):
        run = subprocess.run(["bash", "-c", line], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, check=False, timeout=WAIT_S)
        self.assertEqual(run.returncode, 0, line + "\n" + run.stdout)
        return run.stdout

    def launch(self, line):
        """Starts it without a display, and waits until its node is there."""
        launch = subprocess.Popen(["bash", "-c", "exec " + line + " rviz:=false"], env=self.environment,
                                  stdout=subprocess.DEVNULL)
        self.addCleanup(self.end, launch)
        rospy.wait_for_service("/save_results", WAIT_S)
        return launch

    @staticmethod
    def end(launch):
        if launch.poll() is None:
            launch.send_signal(signal.SIGINT)
            launch.wait(WAIT_S)

    def play(self, topic, message):
        """Plays the drive and returns the first message that has something."""
        player = subprocess.Popen(["rosbag", "play", "--quiet", "--clock", "--rate", "3", "--delay", "1",
                                   os.path.join(self.folder, "drive", "drive.bag")], stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL)
        try:
            return rospy.wait_for_message(topic, message, WAIT_S)
        finally:
            self.assertEqual(player.wait(WAIT_S), 0)

    def test_a_drive_is_mapped_looked_at_saved_and_found_again(self):
        launch = self.launch(self.line(f"roslaunch {PACKAGE} slam.launch"))
        self.assertTrue(self.play("/map", SemanticMap).landmarks)
        self.run_line(self.line(f"rosrun {PACKAGE} doctor"))
        self.assertIn("success: True", self.run_line(self.line("rosservice call /save_results")))
        shutil.copy(os.path.join(self.folder, "result", "trajectory.tum"), os.path.join(self.folder, "truth.tum"))
        self.assertIn("se3", self.run_line(self.line(f"rosrun {PACKAGE} evaluate")))
        self.assertIn("success: True", self.run_line(f"rosservice call /save_map '{{path: {self.folder}/map.bag}}'"))
        self.end(launch)
        self.launch(self.line(f"roslaunch {PACKAGE} localization.launch"))
        self.assertEqual(rospy.get_param("/slam_node/node/mode"), "localization")
        self.assertEqual(self.play("/pose", PoseWithCovarianceStamped).header.frame_id, "map")


if __name__ == "__main__":
    rospy.init_node("readme_commands_rostest")
    rostest.rosrun(PACKAGE, "readme_commands", ReadmeCommandsTest)
