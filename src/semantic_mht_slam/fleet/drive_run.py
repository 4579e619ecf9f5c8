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
MAP = "map.bag"


def result_folder(output: Path, drive: Drive) -> Path:
    return output / "drives" / drive.name


def failed_folder(output: Path, drive: Drive) -> Path:
    return output / "failed" / drive.name


def made_of(drive: Drive, list_folder: Path) -> dict:
    """What a result is made of, as far as a list says it."""
    return {"folder": str(list_folder), "arguments": list(drive.arguments)}


def is_complete(output: Path, drive: Drive, list_folder: Path) -> bool:
    """Raises FleetError for a folder that is no result of this drive: nobody's results are replaced unasked."""
    folder = result_folder(output, drive)
    if not folder.exists():
        return False
    try:
        made = json.loads((folder / ARGUMENTS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise FleetError(f"'{folder}' is no result of a drive, or a broken one: remove it") from None
    if made != made_of(drive, list_folder):
        raise FleetError(f"'{folder}' was made with other arguments or for another list (see {ARGUMENTS} in it): remove it, "
                         "or give the drive another name")
    return True


def last_line(log: Path) -> str:
    """What a program said at last."""
    lines = log.read_text(encoding="utf-8", errors="replace").split("\n")
    said = [line.strip() for line in lines if line.strip()]
    return said[-1] if said else "said nothing"


def reason_of_failure(output: Path, drive: Drive) -> str:
    """The last line that a drive said which failed; why there is none otherwise."""
    if is_locked(output, drive.name):
        return "is being run"
    log = failed_folder(output, drive) / LOG
    if not log.exists():
        return "has not been run"
    return last_line(log)


def lock_file(output: Path, name: str) -> Path:
    return output / "locks" / name


def is_locked(output: Path, name: str) -> bool:
    try:
        with open(lock_file(output, name), "rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False


@contextmanager
def sole_run(output: Path, name: str) -> Iterator[int]:
    """While it lasts no other process does the same, on whatever machine. Gives the descriptor of the lock, which a child
    process keeps for as long as it lives. The lock of a killed process is free."""
    lock_file(output, name).parent.mkdir(parents=True, exist_ok=True)
    with open(lock_file(output, name), "w", encoding="utf-8") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise FleetError(f"another process runs '{name}'") from None
        except OSError as problem:
            raise FleetError(f"'{lock.name}' cannot be locked: {os.strerror(problem.errno or 0)}") from None
        yield lock.fileno()


def run_program(command: list[str], folder: Path, log: Path, lock: int) -> int:
    """Its exit code; what it says goes to the log. A request to end is handed on, and it is waited for."""
    with open(log, "w", encoding="utf-8") as file:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT,
                                   pass_fds=(lock,))
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


def new_folder(parent: Path, name: str) -> Path:
    """An empty folder beside the others; what killed processes left of that name goes. For who holds the lock."""
    parent.mkdir(exist_ok=True)
    for left in parent.glob(f".{name}.tmp-" + 8 * "?"):
        shutil.rmtree(left)
    folder = Path(tempfile.mkdtemp(prefix=f".{name}.tmp-", dir=parent))
    folder.chmod(0o755)
    return folder


def write_surely(path: Path, text: str) -> None:
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


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
    with sole_run(output, drive.name) as lock:
        if is_complete(output, drive, list_folder):
            return f"{drive.name}: is complete"
        unfinished = new_folder(output / "drives", drive.name)
        code = run_program([program, *drive.arguments, "--output", str(unfinished)], list_folder, unfinished / LOG, lock)
        if code == 0 and not (unfinished / MAP).exists():
            code = 1
            with open(unfinished / LOG, "a", encoding="utf-8") as log:
                log.write(f"it wrote no {MAP}\n")
        if code != 0:
            failed = keep_failure(unfinished, output, drive)
            raise FleetError(f"{drive.name}: failed: {last_line(failed / LOG)} (all it said: {failed / LOG})")
        write_surely(unfinished / ARGUMENTS, json.dumps(made_of(drive, list_folder)) + "\n")
        os.rename(unfinished, result_folder(output, drive))
        shutil.rmtree(failed_folder(output, drive), ignore_errors=True)
        return f"{drive.name}: done"
