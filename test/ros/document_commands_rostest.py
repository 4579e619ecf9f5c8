#!/usr/bin/env python3
"""The commands of README and docs that need a running system, run as they are written but for what stands for a user's own
(names, files and ids) and for hours."""
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import rospy
import rostest
from geometry_msgs.msg import PoseWithCovarianceStamped
from semantic_mht_slam.msg import SemanticMap
from semantic_mht_slam.srv import GetLandmarks

WAIT_S = 60.0
STAYS_S = 3.0  # what a launch or node that has begun gets to end in
PACKAGE = "semantic_mht_slam"
REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "test" / folder) for folder in ("documents", "support")]
from documented import LAUNCH, LONG_RUN, commands  # noqa: E402 pylint: disable=wrong-import-position
from tiny_network import write_tiny_network  # noqa: E402 pylint: disable=wrong-import-position


def lines(begin):
    """The commands of shell blocks that begin so, each once."""
    return list(dict.fromkeys(command for _, command in commands() if re.match(begin, command)))


class DocumentCommandsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = dict(os.environ, HOME=self.folder, ROS_HOME=os.path.join(self.folder, "ros"), PWD=self.folder)
        rospy.set_param("/use_sim_time", True)
        os.symlink(REPOSITORY / "config", os.path.join(self.folder, "config"))
        self.run_line(f"rosrun {PACKAGE} simulate_drive --scenario config/scenarios/town.yaml --seed 1 "
                      "--set route.length=150 --output drive")
        self.bag = os.path.join(self.folder, "drive", "drive.bag")
        shutil.copy(self.bag, os.path.join(self.folder, "kitti_00.bag"))
        os.mkdir(os.path.join(self.folder, "maps"))

    def own(self, line):
        """The line with names that there are here."""
        names = {"/your/objects": "/objects", "/your/odometry": "/odometry", "rviz:=true": "rviz:=false",
                 "/path/to/your_classes.yaml": str(REPOSITORY / "config/classes_semantic_kitti.yaml"),
                 "/path/to/map.bag": os.path.join(self.folder, "map.bag"),
                 "/path/to/network.onnx": os.path.join(self.folder, "network.onnx"),
                 "/path/to/espnet.onnx": os.path.join(self.folder, "network.onnx"),
                 "/data/town.bag": os.path.join(self.folder, "map.bag"), "/tmp/town": os.path.join(self.folder, "town"),
                 "/data/maps": os.path.join(self.folder, "maps"), "/data/world.bag": os.path.join(self.folder, "world.bag")}
        for name, own in names.items():
            line = line.replace(name, own)
        return line

    def one(self, begin):
        """README's line that begins so."""
        self.assertGreaterEqual(len(lines(begin)), 1, begin)
        return self.own(lines(begin)[0])

    def run_line(self, line):
        run = subprocess.run(["bash", "-c", line], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, check=False, timeout=WAIT_S)
        self.assertEqual(run.returncode, 0, line + "\n" + run.stdout)
        return run.stdout

    def start(self, line, output=subprocess.DEVNULL):
        started = subprocess.Popen(["bash", "-c", line], cwd=self.folder, env=self.environment, stdout=output,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        self.addCleanup(self.end, started)
        return started

    @staticmethod
    def end(started):
        if started.poll() is None:
            os.killpg(started.pid, signal.SIGINT)
            started.wait(WAIT_S)

    def play(self, topic, message):
        """Plays the drive and returns the first message."""
        player = self.start(f"rosbag play --quiet --clock --rate 3 --delay 1 {self.bag} < /dev/null")
        try:
            return rospy.wait_for_message(topic, message, WAIT_S)
        finally:
            self.assertEqual(player.wait(WAIT_S), 0)

    def wait_for(self, holds):
        until = time.time() + WAIT_S
        while not holds():
            self.assertLess(time.time(), until)
            time.sleep(0.1)

    def check_each(self, lines_to_check, check):
        """All of them, whatever the others do (a failed subTest is in no result file of a rostest)."""
        problems = []
        for line in lines_to_check:
            try:
                check(line)
            except AssertionError as error:
                problems.append(f"{line}: {error}")
        self.assertFalse(problems, "\n".join(problems))

    def begin(self, begin):
        """Launches README's line, and waits until the node is there."""
        launch = self.start(self.one(begin) + " rviz:=false")
        rospy.wait_for_service("/save_results", WAIT_S)
        return launch

    def test_a_drive_is_mapped_looked_at_saved_and_found_again(self):
        launch = self.begin(f"roslaunch {PACKAGE} slam.launch")
        self.assertTrue(self.play("/map", SemanticMap).landmarks)
        self.run_line(self.one(f"rosrun {PACKAGE} doctor"))
        self.assertIn("success: True", self.run_line(self.one("rosservice call /save_results")))
        shutil.copy(os.path.join(self.folder, "result", "trajectory.tum"), os.path.join(self.folder, "truth.tum"))
        self.assertIn("se3", self.run_line(self.one(f"rosrun {PACKAGE} evaluate trajectory --truth truth.tum")))
        self.assertIn("success: True", self.run_line(f"rosservice call /save_map '{{path: {self.folder}/map.bag}}'"))
        self.end(launch)
        self.begin(f"roslaunch {PACKAGE} localization.launch")
        self.assertEqual(rospy.get_param("/slam_node/node/mode"), "localization")
        self.assertEqual(self.play("/pose", PoseWithCovarianceStamped).header.frame_id, "map")

    def test_every_service_call_does_what_it_says(self):
        self.begin(f"roslaunch {PACKAGE} slam.launch")
        self.play("/map", SemanticMap)
        self.run_line("rosservice call /finish_submap")
        ids = [landmark.id for landmark in rospy.ServiceProxy("/get_landmarks", GetLandmarks)().landmarks]
        calls = lines("rosservice call (?!/map_server)")
        self.assertGreater(len(calls), 8)

        def check(call):
            call = self.own(call).replace("id: 17", f"id: {ids[0]}").replace("id: 21", f"id: {ids[1]}")
            call = call.replace("secs: 90", "secs: 12").replace("match_stamp: {secs: 12", "match_stamp: {secs: 3")
            said = self.run_line(call.replace("id: 4", "id: 0") if "remove_closure" in call else call)
            self.assertIn("success: True", said)

        self.check_each(calls, check)

    def test_a_map_server_takes_the_maps_of_a_folder(self):
        self.run_line(f"rosrun {PACKAGE} slam_offline --bag drive/drive.bag --output result && "
                      "cp result/map.bag maps/monday.bag")
        self.start(self.one(f"roslaunch {PACKAGE} map_server.launch folder:=") + " rviz:=false")
        rospy.wait_for_service("/map_server/save_map", WAIT_S)
        self.assertTrue(rospy.wait_for_message("/world/map", SemanticMap, WAIT_S).landmarks)
        self.assertIn("monday", self.run_line(self.one("rostopic echo -n 1 /merge_status")))
        calls = lines("rosservice call /map_server")
        self.assertGreater(len(calls), 2)
        for call in calls:
            self.assertIn("success: True", self.run_line(self.own(call)))

    def test_every_launch_file_begins_as_it_is_called(self):
        shutil.copy(self.bag, os.path.join(self.folder, "map.bag"))
        self.run_line(f"rosrun {PACKAGE} slam_offline --bag drive/drive.bag --output result && cp result/map.bag map.bag")
        write_tiny_network(os.path.join(self.folder, "network.onnx"))
        launches = lines(LAUNCH)
        self.assertGreater(len(launches), 9)

        def check(line):
            line = self.own(line)
            if re.search(r"(slam|localization|kitti|map_server|two_robots)\.launch", line):
                line += " rviz:=false"
            with tempfile.NamedTemporaryFile("w+") as output:
                launch = self.start(line, output)
                if "roslaunch" in line:
                    self.wait_for(lambda: "started with pid" in Path(output.name).read_text() or launch.poll() is not None)
                time.sleep(STAYS_S)
                self.assertIsNone(launch.poll())
                self.end(launch)
                self.assertNotRegex(Path(output.name).read_text(), "process has died|REQUIRED process|Traceback|RLException")

        self.check_each(launches + lines(f"rosrun {PACKAGE} odometry_relay"), check)

    def test_a_long_run_says_how_it_went(self):
        with socket.socket() as free:
            free.bind(("", 0))
            port = free.getsockname()[1]
        self.environment["ROS_MASTER_URI"] = f"http://localhost:{port}"
        core, parameters, node, drive = [self.one(f"{command}$") for command in LONG_RUN]
        self.start(f"{core} -p {port}")
        self.wait_for(lambda: subprocess.run(["rosparam", "list"], env=self.environment, stdout=subprocess.DEVNULL,
                                             stderr=subprocess.DEVNULL, check=False).returncode == 0)
        self.run_line(parameters)
        self.start(node)
        said = self.run_line(drive.replace("--hours 8 --row 1", "--hours 0.01 --row 0.01 --set route.length=300"))
        self.assertRegex(said, r"drive \(h\).*\n +0\.01 ")


if __name__ == "__main__":
    rospy.init_node("document_commands_rostest")
    rostest.rosrun(PACKAGE, "document_commands", DocumentCommandsTest)
