"""Six drives, one of them broken, under GNU parallel and under a Slurm of one node that the test starts."""
import json
import os
import shutil
import socket
import subprocess
import time

import pytest
from conftest import BROKEN, DRIVES, run

SLURM = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""
LIMIT_S = 240


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def wait_for(is_so, what: str, log=None) -> None:
    deadline = time.monotonic() + LIMIT_S
    while not is_so():
        assert time.monotonic() < deadline, f"{what}\n{log.read_text() if log and log.exists() else ''}"
        time.sleep(0.2)


@pytest.fixture
def slurm(tmp_path):
    """The environment in which sbatch finds a cluster of this machine."""
    if not shutil.which("slurmctld"):
        pytest.skip("slurm-wlm is not installed")
    if os.getuid() != 0:
        pytest.skip("a cluster of one's own needs root")
    folder = tmp_path / "slurm"
    (folder / "state").mkdir(parents=True)
    (folder / "spool").mkdir()
    settings = folder / "slurm.conf"
    settings.write_text(SLURM.format(host=socket.gethostname().split(".")[0], controller=free_port(), node=free_port(),
                                     folder=folder, cores=os.cpu_count()))
    environment = {**os.environ, "SLURM_CONF": str(settings)}
    daemons = []
    try:
        for daemon in ("slurmctld", "slurmd"):
            daemons.append(subprocess.Popen([daemon, "-D", "-f", str(settings)], env=environment, stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL))
        wait_for(lambda: "idle" in subprocess.run(["sinfo", "-h", "-o", "%T"], env=environment, stdout=subprocess.PIPE,
                                                  stderr=subprocess.DEVNULL, text=True, check=False).stdout,
                 "the node takes jobs", folder / "slurmctld.log")
        yield environment
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            daemon.wait(timeout=30)


def expect_five_merged(fleet) -> None:
    summary = json.loads((fleet.output / "merged/drives.json").read_text())
    assert list(summary["merged"]) == [f"drive_{i}" for i in range(1, DRIVES + 1) if f"drive_{i}" != BROKEN]
    assert list(summary["missing"]) == [BROKEN] and "calib.txt" in summary["missing"][BROKEN]
    report = json.loads((fleet.output / "merged/merge_report.json").read_text())
    assert len(report["maps_joined"]) == DRIVES - 1 and report["islands"] == []


def expect_all_merged(fleet, before) -> None:
    """And nothing was done twice."""
    summary = json.loads((fleet.output / "merged/drives.json").read_text())
    assert len(summary["merged"]) == DRIVES and summary["missing"] == {}
    after = fleet.written()
    assert len(after) == DRIVES and {path: after[path] for path in before} == before


def test_gnu_parallel(fleet):
    if not shutil.which("parallel"):
        pytest.skip("parallel is not installed")
    first = run("fleet_parallel", fleet.list, fleet.output)
    assert first.returncode == 1 and f"{BROKEN}: failed: " in first.stdout and f"missing: {BROKEN}: " in first.stdout
    expect_five_merged(fleet)
    before = fleet.written()
    fleet.mend()
    second = run("fleet_parallel", fleet.list, fleet.output)
    assert second.returncode == 0, second.stdout
    expect_all_merged(fleet, before)


def test_slurm(fleet, slurm):
    def submit():
        submitted = run("fleet_slurm", fleet.list, fleet.output, "--time=5", env=slurm)
        assert submitted.returncode == 0, submitted.stdout
        assert f"{DRIVES} drives are job " in submitted.stdout
        log = fleet.output / "slurm/merge.log"
        wait_for(lambda: log.exists() and "drives\n" in log.read_text(), "the maps are joined", log)
        said = log.read_text()
        log.unlink()
        return said

    assert f"missing: {BROKEN}: " in submit()
    assert f"{BROKEN}: failed: " in (fleet.output / "slurm/4.log").read_text()
    expect_five_merged(fleet)
    before = fleet.written()
    fleet.mend()
    submit()
    assert (fleet.output / "slurm/1.log").read_text() == "drive_1: is complete\n"
    expect_all_merged(fleet, before)
