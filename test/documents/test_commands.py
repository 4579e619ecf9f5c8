"""Every command of README, CONTRIBUTING and docs is run by a test: here the programs that need files alone, as they are written
but for what would take long, on files of the same names that are made here; scripts by test_scripts.py; nodes, launches and
service calls by test/ros/document_commands_rostest.py. What nobody runs is in EXEMPT of documented.py."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import roslib.packages
from documented import (EXEMPT, ON_A_RUNNING_SYSTEM, PACKAGE, REPOSITORY, commands, needs_checkout, needs_running_system,
                        words_of)
from own_files import write_foreign_detections, write_pole_scan, write_sequence, write_short_scenarios

PROGRAMS = Path(roslib.packages.find_node(PACKAGE, "slam_offline")[0]).parent
LIMIT_S = 120
# What would take long is asked for in the small, by options that the program has.
SHORTER = {
    "benchmark": (("--seeds 1-5", "--seeds 1"), "--methods dpmhm --odometries vo_orb"),
    "train_submap_evaluator": (("--seeds 1-30", "--seeds 1-2"), "--min-samples 5"),
}


class CommandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        home = Path(cls.folder)
        shutil.copytree(REPOSITORY / "config", home / "config")
        (home / "drives.txt").write_text("monday --bag KITTI/00/drive.bag\ntuesday --bag KITTI/00/drive.bag\n")
        write_short_scenarios(home / "config" / "scenarios")
        drive = home / "KITTI" / "00"
        cls.run_line(f"simulate_drive --scenario config/scenarios/town.yaml --seed 1 --output {drive}")
        shutil.copy(drive / "odometry" / "odometry.txt", drive / "odometry" / "vo_orb.txt")
        shutil.copy(drive / "objects.csv", drive / "objects_noisy.csv")
        (drive / "fixes.csv").write_text("time,latitude,longitude\n0.0,47.3769,8.5417\n1.0,47.37695,8.5417\n")
        os.symlink(drive, home / "DIR")
        cls.run_line(f"slam_offline --bag {drive}/drive.bag --output result")
        shutil.copy(home / "result" / "trajectory.tum", home / "truth.tum")
        for name in ("town.bag", "A.bag", "B.bag"):
            shutil.copy(home / "result" / "map.bag", home / name)
        write_foreign_detections(drive / "drive.bag", home / "drive.bag")
        for scan in ("000052", "000001"):
            write_pole_scan(home, scan)
        write_sequence(home / "sequences" / "00")
        shutil.copy(home / "sequences" / "00" / "calib.txt", home)

    @classmethod
    def run_line(cls, line, folder="."):
        environment = dict(os.environ, HOME=cls.folder, PATH=f"{PROGRAMS}:{REPOSITORY / 'scripts'}:{os.environ['PATH']}")
        run = subprocess.run(["bash", "-c", line], cwd=os.path.join(cls.folder, folder), env=environment, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False,
                             timeout=LIMIT_S)
        if run.returncode != 0:
            raise AssertionError(f"{line}: {run.stdout}")
        return run.stdout

    def check(self, command, folder):
        program = words_of(command)[0]
        self.assertTrue(roslib.packages.find_node(PACKAGE, program), f"no test knows how to run this; the program {program} is not there")
        line = re.sub(f"^rosrun {PACKAGE} ", "", command)  # the folder of programs is on the PATH
        if program in SHORTER:
            (long, short), more = SHORTER[program]
            self.assertIn(long, line)
            line = f"{line.replace(long, short)} {more}"
        self.run_line(line, folder)

    def test_every_command(self):
        listed = {}  # each once, with the document that has it first
        for document, command in commands():
            listed.setdefault(command, document)
        self.assertGreater(len(listed), 40)
        folders = {}  # where the commands of a document are by now
        for command, document in listed.items():
            if command in EXEMPT or needs_checkout(command):
                continue
            with self.subTest(document=document, command=command):
                if needs_running_system(command):
                    self.assertRegex(command, "^(" + "|".join(ON_A_RUNNING_SYSTEM) + ")", "no test runs it")
                elif command.startswith("cd "):
                    folders[document] = command[3:]
                    self.run_line(command)
                else:
                    self.check(command, folders.get(document, "."))

    def test_what_nobody_runs_is_documented(self):
        self.assertFalse(set(EXEMPT) - {command for _, command in commands()})


if __name__ == "__main__":
    unittest.main()
