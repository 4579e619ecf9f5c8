"""One drive: its folder is complete or not there, whatever happens to the process or the machine."""
from __future__ import annotations

import fcntl
import json
import os
import shutil
import signal
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

from .drive_list import Drive
from .errors import FleetError

ARGUMENTS = "drive.json"
LOG = "run.log"


def result_folder(output: Path, drive: Drive) -> Path:
    return output / "drives" / drive.name


def failed_folder(output: Path, drive: Drive) -> Path:
    return output / "failed" / drive.name


def is_complete(output: Path, drive: Drive) -> bool:
    """Raises FleetError if there is a result of other arguments: nobody's results are replaced unasked."""
    path = result_folder(output, drive) / ARGUMENTS
    if not path.exists():
        return False
    if json.loads(path.read_text(encoding="utf-8")) != list(drive.arguments):
        raise FleetError(f"'{path.parent}' was made with other arguments (see {ARGUMENTS} in it): remove it, or give the "
                         "drive another name")
    return True


def reason_of_failure(output: Path, drive: Drive) -> str:
    """The last line that a drive said which failed; why there is none otherwise."""
    log = failed_folder(output, drive) / LOG
    if not log.exists():
        return "has not been run"
    lines = log.read_text(encoding="utf-8", errors="replace").split("\n")
    said = [line.strip() for line in lines if line.strip()]
    return said[-1] if said else "said nothing"


@contextmanager
def sole_run(output: Path, drive: Drive) -> Iterator[None]:
    """While it lasts no other process runs this drive, on whatever machine. The lock of a killed one is free."""
    folder = output / "locks"
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / drive.name, "w", encoding="utf-8") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise FleetError(f"another process runs the drive '{drive.name}'") from None
        yield


def run_program(command: list[str], folder: Path, log: Path) -> int:
    """Its exit code; what it says goes to the log. A request to end is handed on, and it is waited for."""
    with open(log, "w", encoding="utf-8") as file:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT)
        before = {number: signal.signal(number, lambda *_: process.terminate())
                  for number in (signal.SIGTERM, signal.SIGINT)}
        try:
            code = process.wait()
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
        if code < 0:
            file.write(f"ended by signal {-code} ({signal.Signals(-code).name})\n")
    return code


def keep_failure(unfinished: Path, output: Path, drive: Drive) -> Path:
    failed = failed_folder(output, drive)
    shutil.rmtree(failed, ignore_errors=True)
    failed.parent.mkdir(exist_ok=True)
    os.rename(unfinished, failed)
    return failed


def run_drive(program: str, drive: Drive, list_folder: Path, output: Path) -> str:
    """Runs a drive unless it is complete; returns what came of it. Paths in its arguments begin at the list's folder.

    Raises FleetError if it fails: its log and what it wrote are then in failed/NAME.
    """
    with sole_run(output, drive):
        if is_complete(output, drive):
            return f"{drive.name}: is complete"
        parent = output / "drives"
        parent.mkdir(exist_ok=True)
        for left in parent.glob(f".{drive.name}.tmp-*"):  # of a killed run: nobody else holds the lock
            shutil.rmtree(left)
        unfinished = Path(tempfile.mkdtemp(prefix=f".{drive.name}.tmp-", dir=parent))
        unfinished.chmod(0o755)
        code = run_program([program, *drive.arguments, "--output", str(unfinished)], list_folder, unfinished / LOG)
        if code != 0:
            failed = keep_failure(unfinished, output, drive)
            raise FleetError(f"{drive.name}: failed: {reason_of_failure(output, drive)} (all it said: {failed / LOG})")
        (unfinished / ARGUMENTS).write_text(json.dumps(list(drive.arguments)) + "\n", encoding="utf-8")
        os.rename(unfinished, result_folder(output, drive))
        shutil.rmtree(failed_folder(output, drive), ignore_errors=True)
        return f"{drive.name}: done"
