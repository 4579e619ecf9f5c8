"""The installed program from outside."""
import subprocess
import unittest

import rosbag
from geometry_msgs.msg import PoseArray
from relay_case import RelayCase, installed_program
from samples import samples


class ProgramTest(RelayCase):
    def run_installed(self, *arguments):
        return subprocess.run([installed_program(), *arguments], capture_output=True, text=True, check=False, timeout=60)

    def test_help_and_wrong_options(self):
        run = self.run_installed("--help")
        self.assertEqual(run.returncode, 0)
        self.assertIn("rosrun semantic_mht_slam object_relay --bag IN.bag --output OUT.bag", run.stdout)
        self.assertIn("--output is missing", self.run_installed("--bag", "x.bag").stderr)

    def test_error_is_one_line_and_code_1(self):
        run = self.run_installed("--bag", self.path("none.bag"), "--output", self.path("out.bag"))
        self.assertEqual((run.returncode, run.stderr.splitlines()),
                         (1, [f"object_relay: {self.path('none.bag')}: No such file or directory"]))

    def test_same_bag_same_bytes(self):
        bag = self.bag_of([samples()["jsk"].message] * 3)
        made = []
        for _ in range(2):
            self.assertEqual(self.relay(bag)[0], 0)
            with open(self.path("out.bag"), "rb") as file:
                made.append(file.read())
        self.assertEqual(made[0], made[1])

    def test_topic_is_needed_where_several_fit_and_others_may_be_left_out(self):
        bag = self.bag_of([samples()["jsk"].message])
        with rosbag.Bag(bag, "a") as more:
            more.write("/particles", PoseArray())
        self.assertIn("several topics could be relayed: name one with --topic", self.refused(bag))
        code, said = self.relay(bag, "--topic", "/detections", "--keep", "/particles", "--output-topic", "/found")
        self.assertEqual(code, 0, said)
        with rosbag.Bag(self.path("out.bag")) as made:
            self.assertEqual(set(made.get_type_and_topic_info().topics), {"/particles", "/found"})


if __name__ == "__main__":
    unittest.main()
