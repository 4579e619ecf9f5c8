"""Shared by the tests of run_drive: the programs of the package and short simulated drives through one town."""
from __future__ import annotations

import functools
import shutil
import subprocess
from pathlib import Path

import pytest
import roslib.packages

REPOSITORY = Path(__file__).resolve().parents[2]
DRIVES = 6
BROKEN = "drive_4"


@functools.lru_cache(maxsize=None)
def program(name: str) -> str:
    return roslib.packages.find_node("semantic_mht_slam", name)[0]


def run(name: str, *arguments: object, **how) -> subprocess.CompletedProcess:
    """A program of the package, with standard output and standard error in one text."""
    return subprocess.run([program(name), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, text=True, check=False, **how)


class Fleet:
    """A folder with a list of drives, one of which is broken, and an output folder; both have blanks in their names."""

    def __init__(self, folder: Path, town: Path) -> None:
        self.list = folder / "the list" / "drives.txt"
        self.output = folder / "all results"
        self.list.parent.mkdir()
        for i in range(1, DRIVES + 1):
            shutil.copytree(town, self.list.parent / f"drive_{i}")
        (self.list.parent / BROKEN / "calib.txt").unlink()
        self.write_list("".join(f"drive_{i} --dataset drive_{i} --odometry odometry/odometry.txt --seed {i}  # of six\n"
                                for i in range(1, DRIVES + 1)))

    def write_list(self, text: str) -> None:
        self.list.write_text(text)

    def run(self, *arguments: object) -> subprocess.CompletedProcess:
        return run("run_drive", "--drives", self.list, "--output", self.output, *arguments)

    def mend(self) -> None:
        shutil.copy(self.list.parent / "drive_1" / "calib.txt", self.list.parent / BROKEN)

    def written(self) -> dict[Path, int]:
        """When each map was written."""
        return {path: path.stat().st_mtime_ns for path in self.output.glob("drives/*/map.bag")}


@pytest.fixture(scope="session")
def town(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("town") / "drive"
    drive = run("simulate_drive", "--scenario", REPOSITORY / "config/scenarios/short.yaml", "--set", "route.length=300",
                "--output", folder)
    assert drive.returncode == 0, drive.stdout
    return folder


@pytest.fixture
def fleet(tmp_path, town) -> Fleet:
    return Fleet(tmp_path, town)
