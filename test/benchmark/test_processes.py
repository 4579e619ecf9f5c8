"""How many runs there are at once, and that none outlives the benchmark."""
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from semantic_mht_slam.benchmark.processes import Interrupted, Processes
from conftest import program_folder


def wait_for(condition, limit_s=120.0):
    end_s = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < end_s, "waited in vain"
        time.sleep(0.02)


def is_alive(process_id: int) -> bool:
    try:
        return Path(f"/proc/{process_id}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_no_more_than_the_wanted_number_runs_at_once_and_every_result_comes():
    lock, running, most = threading.Lock(), [0], [0]
    three = threading.Barrier(3, timeout=120.0)

    def work(item):
        with lock:
            running[0] += 1
            most[0] = max(most[0], running[0])
        three.wait()
        with lock:
            running[0] -= 1
        return 10 * item

    assert sorted(Processes().each(work, list(range(12)), 3)) == [(i, 10 * i) for i in range(12)]
    assert most[0] == 3


def test_an_exception_ends_what_runs_and_cancels_what_waits():
    processes = Processes()
    started = []

    def work(item):
        started.append(item)
        if item == 0:
            wait_for(lambda: len(started) > 1)
            raise ValueError("broken")
        return processes.run(["sleep", "600"]).returncode

    begin_s = time.monotonic()
    with pytest.raises(ValueError):
        list(processes.each(work, list(range(50)), 2))
    assert time.monotonic() - begin_s < 300.0
    assert len(started) < 10
    with pytest.raises(Interrupted):
        processes.run(["true"])


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_benchmark_leaves_no_run_behind_and_goes_on_later(small, tmp_path, how):
    fake = tmp_path / "programs"
    fake.mkdir()
    for name in ("benchmark", "evaluate"):
        (fake / name).symlink_to(program_folder() / name)
    slow = fake / "slam_offline"
    slow.write_text(f"""#!/bin/sh
case "$*" in *--print-config*) exec '{program_folder()}/slam_offline' "$@" ;; esac
echo $$ > '{tmp_path}'/$$.id
exec sleep 600
""")
    slow.chmod(0o755)
    output = tmp_path / "report"
    process = subprocess.Popen(
        [sys.executable, str(fake / "benchmark"), "--data", str(small.data), "--output", str(output), "--odometries",
         "odometry", "--methods", "ukf", "--seeds", "1-9", "--jobs", "2"], stderr=subprocess.PIPE, encoding="utf-8")
    try:
        wait_for(lambda: len([path for path in tmp_path.glob("*.id") if path.read_text()]) == 2)
        os.kill(process.pid, how)
        _, errors = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 130
    assert "interrupted" in errors
    ids = [int(path.read_text()) for path in tmp_path.glob("*.id")]
    assert len(ids) == 2, "a run was begun after the interrupt"
    assert not any(is_alive(process_id) for process_id in ids)
    assert not list(output.rglob("benchmark_key.txt"))
    slow.unlink()
    slow.symlink_to(program_folder() / "slam_offline")
    later = subprocess.run([*process.args, "--seeds", "1"], capture_output=True, encoding="utf-8", check=False)
    assert "1 runs made, 0 found complete, 0 failed" in later.stdout, later.stderr
