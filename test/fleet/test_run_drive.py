"""run_drive: what is complete is whole and stays, what fails is named, what cannot be used is refused."""
import fcntl
import json
import os
import signal
import subprocess
import time

import pytest
from conftest import program


def test_a_drive_is_run_once(fleet):
    first = fleet.run(2)
    assert first.returncode == 0 and first.stdout == "drive_2: done\n"
    written = fleet.written()
    assert [path.parent.name for path in written] == ["drive_2"]
    again = fleet.run(2)
    assert again.returncode == 0 and again.stdout == "drive_2: is complete\n"
    assert fleet.written() == written
    assert not list(fleet.output.glob("drives/.*"))


def test_a_failure_is_named_and_mended(fleet):
    failed = fleet.run(4)
    assert failed.returncode == 1
    assert "drive_4: failed: " in failed.stdout and "calib.txt" in failed.stdout
    assert not fleet.written()
    assert "calib.txt" in (fleet.output / "failed/drive_4/run.log").read_text()
    fleet.mend()
    assert fleet.run(4).returncode == 0
    assert not (fleet.output / "failed/drive_4").exists()


def test_results_of_other_arguments_stay(fleet):
    assert fleet.run(1).returncode == 0
    written = fleet.written()
    fleet.write_list("drive_1 --dataset drive_1 --odometry odometry/odometry.txt --seed 7\n")
    refused = fleet.run(1)
    assert refused.returncode == 1 and "made with other arguments" in refused.stdout
    assert fleet.written() == written


def start_stopped(fleet):
    """A run of the first drive whose slam_offline waits for a file that is a pipe; its process and the pipe."""
    pipe = fleet.list.parent / "drive_1" / "odometry" / "pipe.txt"
    os.mkfifo(pipe)
    fleet.write_list("drive_1 --dataset drive_1 --odometry odometry/pipe.txt\n"
                     "drive_2 --dataset drive_2 --odometry odometry/odometry.txt\n")
    process = subprocess.Popen([program("run_drive"), "1", "--drives", str(fleet.list), "--output", str(fleet.output)],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    log = None
    for _ in range(500):
        log = next(fleet.output.glob("drives/.drive_1.tmp-*/run.log"), None)
        if log:
            break
        time.sleep(0.02)
    assert log, "it has begun"
    return process


def test_lists_are_read_as_they_are_meant(fleet):
    fleet.write_list("\ufeffmonday --bag run#3.bag  # a remark\r\n#tuesday --bag b.bag\r\n")
    assert fleet.run("--count").stdout == "1\n"
    failed = fleet.run(1)
    assert failed.returncode == 1 and "run#3.bag" in failed.stdout


def test_what_wrote_no_map_has_failed(fleet):
    fleet.write_list("help --help\n")
    failed = fleet.run(1)
    assert failed.returncode == 1 and "it wrote no map.bag" in failed.stdout


def test_a_folder_that_is_no_result_stays(fleet):
    (fleet.output / "drives/drive_1").mkdir(parents=True)
    refused = fleet.run(1)
    assert refused.returncode == 1 and "is no result of a drive" in refused.stdout
    assert "is no result of a drive" in fleet.run("--merge").stdout
    assert list((fleet.output / "drives/drive_1").iterdir()) == []


def test_the_lock_lives_as_long_as_the_program(fleet):
    process = start_stopped(fleet)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    refused = fleet.run(1)
    assert refused.returncode == 1 and "another process runs 'drive_1'" in refused.stdout
    assert "drive_1: is being run" in fleet.run("--merge").stdout
    subprocess.run(["pkill", "-KILL", "-f", f"slam_offline.*{fleet.output}"], check=False)


def test_two_processes_never_run_one_drive(fleet):
    (fleet.output / "locks").mkdir(parents=True)
    with open(fleet.output / "locks/drive_1", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        refused = fleet.run(1)
    assert refused.returncode == 1 and "another process runs 'drive_1'" in refused.stdout
    assert fleet.run(1).returncode == 0


def test_a_killed_run_leaves_nothing_that_counts(fleet):
    process = start_stopped(fleet)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    subprocess.run(["pkill", "-KILL", "-f", f"slam_offline.*{fleet.output}"], check=False)
    assert list(fleet.output.glob("drives/.drive_1.tmp-*")) and not fleet.written()
    (fleet.output / "drives/.drive_1.tmp-b.tmp-12345678").mkdir()  # of a drive of another name
    fleet.write_list("drive_1 --dataset drive_1 --odometry odometry/odometry.txt\n")
    assert fleet.run(1).returncode == 0
    assert [path.name for path in fleet.output.glob("drives/.*")] == [".drive_1.tmp-b.tmp-12345678"]


def test_a_request_to_end_is_a_failure_that_says_so(fleet):
    process = start_stopped(fleet)
    process.terminate()
    said, _ = process.communicate(timeout=30)
    assert process.returncode == 1 and "SIGTERM" in said
    assert not list(fleet.output.glob("drives/.*")) and not fleet.written()


@pytest.mark.parametrize("text, problem", [
    ("", "names no drive"),
    ("# a remark\n\n", "names no drive"),
    ("../monday --bag a.bag\n", "drives.txt:1: '../monday' is no name of a drive"),
    ("monday --bag a.bag\0\n", "drives.txt:1: a zero byte"),
    ("monday\n", "drives.txt:1: no arguments of slam_offline behind the name"),
    ("a --bag a.bag\na --bag b.bag\n", "drives.txt:2: a second drive 'a'"),
    ("a --bag 'a.bag\n", "drives.txt:1: No closing quotation"),
    ("a --bag a.bag --output here\n", "drives.txt:1: --output is set by run_drive"),
])
def test_lists_that_cannot_be_used(fleet, text, problem):
    fleet.write_list(text)
    refused = fleet.run(1)
    assert refused.returncode == 1 and problem in refused.stdout
    assert refused.stdout.count("\n") == 1 and not fleet.output.exists()


@pytest.mark.parametrize("arguments, problem", [
    (["0"], "there is no drive 0: the list"),
    (["7"], "names 6"),
    (["one"], "invalid int value: 'one'"),
    ([], "one of the arguments N --merge --count is required"),
    (["--merge"], "0 of 6 drives are complete: nothing to join"),
])
def test_arguments_that_cannot_be_used(fleet, arguments, problem):
    refused = fleet.run(*arguments)
    assert refused.returncode == 1 and problem in refused.stdout


def test_drives_with_other_parameters_are_not_joined(fleet):
    fleet.write_list("a --dataset drive_1 --odometry odometry/odometry.txt\n"
                     "b --dataset drive_2 --odometry odometry/odometry.txt --method mhm\n")
    assert fleet.run(1).returncode == 0 and fleet.run(2).returncode == 0
    refused = fleet.run("--merge")
    assert refused.returncode == 1 and "the drives 'a' and 'b' have other parameters" in refused.stdout


def test_merging_is_done_once_and_again_when_a_drive_comes(fleet):
    assert fleet.run(1).returncode == 0 and fleet.run(2).returncode == 0
    merged = fleet.run("--merge")
    assert merged.returncode == 0 and "missing: drive_3: has not been run" in merged.stdout
    assert "joined: drive_1/map.bag, drive_2/map.bag" in merged.stdout
    all_maps = fleet.output / "merged/all.bag"
    first = all_maps.stat().st_mtime_ns
    assert "is complete" in fleet.run("--merge").stdout and all_maps.stat().st_mtime_ns == first
    assert fleet.run(3).returncode == 0
    assert "3 of 6 drives" in fleet.run("--merge").stdout
    summary = json.loads((fleet.output / "merged/drives.json").read_text())
    assert list(summary["merged"]) == ["drive_1", "drive_2", "drive_3"]
    assert not (fleet.output / "merged/before").exists()
