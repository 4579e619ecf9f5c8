"""Every command of README and docs: what needs files alone is run, launch files are resolved, service calls are made into
requests, and of the rest the program and its options are looked up. Launches and service calls are run on a running
system by test/ros/document_commands_rostest.py."""
import os
import re
import shlex
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

import genpy
import roslib.message
import roslib.packages
import yaml

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = "semantic_mht_slam"
PROGRAMS = Path(roslib.packages.find_node(PACKAGE, "slam_offline")[0]).parent
RUN = {"slam_offline", "evaluate", "kitti_to_bag", "extract_objects", "map_info", "merge_maps",
       "simulate_drive"}  # on a simulated drive
OTHERS = {"source", "cd", "roscore", "rosdep", "catkin_make"}  # not of this package
RUN_ELSEWHERE = {"object_relay": "object_relay/test_program.py", "benchmark": "benchmark/test_benchmark.py"}
NEEDS = {"000001.png", "sequences/00", "objects.bag"}  # what of these files the other tests make


def commands():
    """(document, command) for each line of a shell block, without comments."""
    for path in [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted((REPOSITORY / "docs").glob("*.md"))]:
        for block in re.findall(r"```(?:sh|bash)\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL):
            for line in block.replace("\\\n", " ").splitlines():
                for command in re.sub(r"(^|\s)#.*", "", line).split(" & "):
                    if command.strip():
                        yield path.name, command.strip()


def words_of(command):
    """Its words, without a variable before and without rosrun and the package."""
    words = shlex.split(command)
    while "=" in words[0] and ":=" not in words[0]:
        words = words[1:]
    return words[2:] if words[:2] == ["rosrun", PACKAGE] else words


def module_of(test):
    """The module whose test a program is."""
    return re.sub("_test$", "", os.path.basename(test))


class CommandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        drive = os.path.join(cls.folder, "KITTI", "00")
        cls.run_program("simulate_drive", "--scenario", str(REPOSITORY / "config/scenarios/town.yaml"), "--seed", "1", "--set",
                        "route.length=150", "--output", drive)
        shutil.copy(os.path.join(drive, "odometry", "odometry.txt"), os.path.join(drive, "odometry", "vo_orb.txt"))
        os.symlink(drive, os.path.join(cls.folder, "DIR"))
        cls.run_program("slam_offline", "--bag", os.path.join(drive, "drive.bag"), "--output", "result")
        shutil.copy(os.path.join(cls.folder, "result", "trajectory.tum"), os.path.join(cls.folder, "truth.tum"))
        for name in ("town.bag", "A.bag", "B.bag"):
            shutil.copy(os.path.join(cls.folder, "result", "map.bag"), os.path.join(cls.folder, name))
        os.symlink(REPOSITORY / "config", os.path.join(cls.folder, "config"))
        pole = [(8.0 + 0.01 * (i % 5), 2.0, 0.1 * (i // 5)) for i in range(100)]
        with open(os.path.join(cls.folder, "000052.bin"), "wb") as file:
            file.write(b"".join(struct.pack("<4f", x, y, z, 0.5) for x, y, z in pole))
        with open(os.path.join(cls.folder, "000052.label"), "wb") as file:
            file.write(struct.pack("<I", 80) * len(pole))

    @classmethod
    def run_program(cls, program, *arguments):
        run = subprocess.run([str(PROGRAMS / program), *arguments], cwd=cls.folder, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, text=True, check=False, timeout=120)
        if run.returncode != 0:
            raise AssertionError(f"{program} {' '.join(arguments)}: {run.stdout}")
        return run.stdout

    def check_launch(self, words):
        arguments = [word.replace("$PWD", self.folder) for word in words[1:]]
        run = subprocess.run(["roslaunch", "--dump-params", *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        said = {arg.split(":=")[0] for arg in arguments if ":=" in arg}
        known = subprocess.run(["roslaunch", "--ros-args", *arguments[:2]], capture_output=True, text=True, check=False).stdout
        for name in said:
            self.assertRegex(known, rf"(?m)^\s*{name}\b", words)

    def check_service_call(self, words):
        self.assertEqual(words[1], "call")
        name = "".join(part.capitalize() for part in words[2].lstrip("/").split("_"))
        service = roslib.message.get_service_class(f"{PACKAGE}/{name}")
        self.assertIsNotNone(service, words)
        request = service._request_class()
        genpy.message.fill_message_args(request, [yaml.safe_load(words[3])])

    def check_script(self, words):
        script = REPOSITORY / words[0]
        self.assertTrue(os.access(script, os.X_OK), words)
        for option in words[1:]:
            known = script.read_text(encoding="utf-8")
            is_test = (REPOSITORY / "test" / module_of(option)).is_dir()
            is_count = option.isdigit() and "SECONDS" in known
            self.assertTrue(option in known or is_count or (words[0] == "scripts/test.sh" and is_test), words)

    def check_options(self, words):
        program = PROGRAMS / words[0]
        self.assertTrue(program.exists(), words)
        known = subprocess.run([str(program), "--help"], capture_output=True, text=True, check=False, timeout=30).stdout
        for option in words[1:]:
            if option.startswith("--"):
                self.assertIn(option, known, words)

    def check(self, command):
        words = words_of(command)
        if words[0] in OTHERS:
            return
        if words[0] == "rosparam":
            self.assertTrue((REPOSITORY / words[2]).exists())
        elif words[0] == "roslaunch":
            self.check_launch(words)
        elif words[0] == "rosservice":
            self.check_service_call(words)
        elif words[0].startswith("scripts/"):
            self.check_script(words)
        elif words[0].startswith("build/"):
            self.assertIn(module_of(words[0]), os.listdir(REPOSITORY / "test"))
        elif words[0] in RUN and not NEEDS & set(words):
            self.run_program(words[0], *(re.sub("^~", self.folder, word) for word in words[1:]))
        else:
            self.check_options(words)

    def test_every_command(self):
        listed = list(commands())
        self.assertGreater(len(listed), 40)
        for document, command in sorted(listed, key=lambda entry: "slam_offline --dataset" not in entry[1]):
            with self.subTest(document=document, command=command):
                self.check(command)

    def test_programs_that_are_run_elsewhere_are(self):
        for program, test in RUN_ELSEWHERE.items():
            text = (REPOSITORY / "test" / test).read_text(encoding="utf-8")
            self.assertIn(program, text + (REPOSITORY / "test" / "benchmark" / "conftest.py").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main()
