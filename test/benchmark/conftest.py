"""Shared by the tests of the benchmark: the programs of the package, and a benchmark of a short simulated drive."""
from __future__ import annotations

import functools
import re
import subprocess
from pathlib import Path

import pandas
import pytest
import roslib.packages

REPOSITORY = Path(__file__).resolve().parents[2]


@functools.lru_cache(maxsize=None)
def program_folder() -> Path:
    return Path(roslib.packages.find_node("semantic_mht_slam", "slam_offline")[0]).parent


def run(program: Path | str, *arguments: object) -> subprocess.CompletedProcess:
    """With standard output and standard error in one text."""
    return subprocess.run([str(program), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, encoding="utf-8", check=False)


class SmallBenchmark:
    """A short simulated drive in a folder with blanks in its name, and a benchmark of two methods and two seeds on it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.data = folder / "the data"
        self.output = folder / "a report"

    def run(self, output: Path, *more: str) -> subprocess.CompletedProcess:
        return run(program_folder() / "benchmark", "--data", self.data, "--output", output, "--methods", "dpmhm,ukf",
                   "--seeds", "1-2", *more)


def run_folder(output: Path, method: str, seed: int) -> Path:
    return output / f"runs/town/odometry/objects/{method}/seed_{seed}"


def results(output: Path) -> pandas.DataFrame:
    return pandas.read_csv(output / "results.csv")


def unmeasured(output: Path) -> str:
    """The report without what is measured anew each time."""
    html = (output / "report.html").read_text()
    without, count = re.subn("<!-- measured begin -->.*<!-- measured end -->", "", html, flags=re.DOTALL)
    assert count == 1
    return without


@pytest.fixture(scope="session")
def small(tmp_path_factory) -> SmallBenchmark:
    benchmark = SmallBenchmark(tmp_path_factory.mktemp("benchmark"))
    drive = run(program_folder() / "simulate_drive", "--scenario", REPOSITORY / "config/scenarios/short.yaml",
                "--set", "route.length=300", "--output", benchmark.data / "town")
    assert drive.returncode == 0, drive.stdout
    first = benchmark.run(benchmark.output, "--odometries", "odometry")
    assert first.returncode == 0, first.stdout
    assert "4 runs made, 0 found complete, 0 failed" in first.stdout
    return benchmark
