#!/usr/bin/env python3
"""What the launch files make of their arguments, and how they end when they cannot begin."""
import os
import shlex
import shutil
import signal
import subprocess
import tempfile
import unittest

import rosgraph
import roslaunch.config
import roslaunch.xmlloader
import rospkg
import rospy
import rostest
import yaml

WAIT_S = 60.0
PACKAGE = "semantic_mht_slam"


def parameters(*arguments):
    """({name: value} that a launch file sets, what roslaunch said)."""
    run = subprocess.run(["roslaunch", "--dump-params", PACKAGE, *arguments], capture_output=True, text=True, check=False,
                         timeout=WAIT_S)
    return yaml.safe_load(run.stdout) or {}, run.stdout + run.stderr


class LaunchFilesTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def user_config(self):
        """A parameter file of a user who has other frames and classes."""
        path = os.path.join(self.folder, "mine.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write("class_table: classes_cityscapes.yaml\nnode: {base_frame: rear_axle, publish_tf: false}\n")
        return path

    def launched(self, *arguments):
        """What a launch that ends by itself says, and its exit code."""
        run = subprocess.run(["roslaunch", PACKAGE, *arguments, "rviz:=false"], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, check=False, timeout=WAIT_S)
        return run.stdout, run.returncode

    def expect_end(self, line, *arguments):
        """A required node ends with code 1 and says its line once, and the launch with it.

        Node and roslaunch write to the same pipe, so that roslaunch's text may stand in the same line before or after.
        """
        said, _ = self.launched(*arguments)
        self.assertIn("REQUIRED process", said)
        self.assertIn("exit code 1", said)
        self.assertEqual(said.count(line), 1, said)
        self.assertNotIn("Traceback", said)

    def test_what_stands_in_the_users_file_is_not_overridden(self):
        for launch in (["slam.launch"], ["localization.launch", "map:=/town.bag"]):
            given, said = parameters(*launch, f"config:={self.user_config()}")
            self.assertEqual(given.get("/slam_node/class_table"), "classes_cityscapes.yaml", said)
            self.assertEqual(given["/slam_node/node/base_frame"], "rear_axle")
            self.assertIs(given["/slam_node/node/publish_tf"], False)
            self.assertNotIn("/slam_node/node/odom_frame", given, "left to the default of the node")

    def test_arguments_come_before_the_file(self):
        given, said = parameters("slam.launch", f"config:={self.user_config()}", "base_frame:=base", "map_frame:=world",
                                 "odom_frame:=odometry", "class_table:=mine.yaml", "publish_tf:=true",
                                 "map:=/town.bag", "mode:=localization")
        expected = {"base_frame": "base", "map_frame": "world", "odom_frame": "odometry", "publish_tf": True,
                    "map": "/town.bag", "mode": "localization"}
        self.assertEqual({name: given.get("/slam_node/node/" + name) for name in expected}, expected, said)
        self.assertEqual(given["/slam_node/class_table"], "mine.yaml")

    def test_rviz_shows_the_frame_of_the_map(self):
        for launch in (["slam.launch"], ["localization.launch", "map:=/town.bag"]):
            for arguments, frame in ([], "map"), (["map_frame:=robot1/map"], "robot1/map"):
                nodes = roslaunch.config.ROSLaunchConfig()
                file = os.path.join(rospkg.RosPack().get_path(PACKAGE), "launch", launch[0])
                roslaunch.xmlloader.XmlLoader().load(file, nodes, argv=launch + arguments, verbose=False)
                said = [shlex.split(node.args)[-2:] for node in nodes.nodes if node.type == "rviz"]
                self.assertEqual(said, [["-f", frame]], launch)

    def test_localization_needs_a_map_and_localizes(self):
        given, _ = parameters("localization.launch", "map:=/town.bag")
        self.assertEqual((given["/slam_node/node/map"], given["/slam_node/node/mode"]), ("/town.bag", "localization"))
        said, code = self.launched("localization.launch")
        self.assertEqual(code, 1)
        self.assertIn("arg 'map' is not defined", said)

    def test_map_that_cannot_be_used_is_told_in_one_line(self):
        self.expect_end("slam_node: cannot read '/nope.bag': no such file, or no regular one", "localization.launch",
                        "map:=/nope.bag")

    def test_bag_that_there_is_not_is_told_in_one_line(self):
        self.expect_end("play_bag: there is no bag '/nope.bag' (bag:= must be an absolute path)", "kitti.launch",
                        "bag:=/nope.bag")

    def test_all_names_are_in_the_namespace_and_old_parameters_are_gone(self):
        rospy.set_param("/robot1/slam_node/node/map", "/of/an/earlier/launch.bag")
        launch = subprocess.Popen(["roslaunch", PACKAGE, "slam.launch", "rviz:=false"], stdout=subprocess.DEVNULL,
                                  env=dict(os.environ, ROS_NAMESPACE="robot1"))
        try:
            rospy.wait_for_service("/robot1/save_map", WAIT_S)
            self.assertFalse(rospy.has_param("/robot1/slam_node/node/map"))
            published, subscribed, services = rosgraph.Master("/test").getSystemState()
            names = {name for group in (published, subscribed, services) for name, nodes in group
                     if "/robot1/slam_node" in nodes}
            self.assertLessEqual({"/robot1/odometry", "/robot1/objects", "/robot1/map", "/robot1/pose"}, names)
            others = {name for name in names if not name.startswith("/robot1/")}
            self.assertEqual(others - {"/tf", "/tf_static", "/diagnostics", "/rosout", "/clock"}, set())
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(WAIT_S)


if __name__ == "__main__":
    rospy.init_node("launch_files_rostest")
    rostest.rosrun(PACKAGE, "launch_files", LaunchFilesTest)
