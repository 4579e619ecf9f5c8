"""Makes the runs of the benchmark that are not there yet."""
from __future__ import annotations

import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import yaml

from .cells import Cell, Request
from .files import write_file
from .programs import Programs, hash_of, package_config_file

KEY_FILE = "benchmark_key.txt"
LOG_FILE = "log.txt"


@dataclass
class Counts:
    """How many runs were made, and found complete."""

    made: int = 0
    found: int = 0


class Keys:
    """Everything that a run's result depends on, as text; a result beside the same text is not made again."""

    def __init__(self, request: Request, programs: Programs) -> None:
        self.request = request
        self.programs = programs
        self.program = programs.hash()
        self._hashes: dict[Path, str] = {}
        self._configs: dict[str, str] = {}

    def key_of(self, cell: Cell) -> str:
        lines = [f"program {self.program}", f"seed {cell.seed}"]
        lines += [f"{name} {self.hash_of(cell.dataset / name)}" for name in cell.input_files]
        return "\n".join(lines) + "\n" + self.config_of(cell)

    def hash_of(self, path: Path) -> str:
        if path not in self._hashes:
            self._hashes[path] = hash_of(path)
        return self._hashes[path]

    def config_of(self, cell: Cell) -> str:
        """Effective parameters of a cell's method, with the hashes of the files that they name."""
        if cell.method.name not in self._configs:
            settings = cell.settings(self.request) + [f"method={cell.method.method}"]
            config = self.programs.effective_config(self.request.config, settings)
            named = "".join(f"{path.name} {self.hash_of(path)}\n" for path in files_named_in(yaml.safe_load(config)))
            self._configs[cell.method.name] = named + config
        return self._configs[cell.method.name]


def files_named_in(value: object) -> list[Path]:
    """Files that stand in an effective configuration: absolute paths, and names in the package's configuration folder."""
    if isinstance(value, dict):
        return [path for part in value.values() for path in files_named_in(part)]
    if not isinstance(value, str) or not value:
        return []
    path = package_config_file(value)  # an absolute path stays as it is
    return [path] if path.is_file() else []


class Progress:
    """How many things are done, and the time left by their sizes. On a terminal in place, elsewhere a line every 10 s."""

    def __init__(self, what: str, sizes: list[float]) -> None:
        self.what = what
        self.count = len(sizes)
        self.left = sum(sizes)
        self.done = 0
        self.done_size = 0.0
        self.is_terminal = sys.stderr.isatty()
        self.begin_s = self.printed_s = time.monotonic()
        self.is_line_open = False

    def add(self, size: float) -> None:
        self.done += 1
        self.done_size += size
        self.left -= size
        now_s = time.monotonic()
        if self.done < self.count and now_s - self.printed_s < (1.0 if self.is_terminal else 10.0):
            return
        self.printed_s = now_s
        minutes, seconds = divmod(int((now_s - self.begin_s) * self.left / max(self.done_size, 1.0)), 60)
        line = f"{self.what} {self.done}/{self.count}, about {minutes} min {seconds:02} s left"
        self.is_line_open = self.is_terminal and self.done < self.count
        print(f"\r{line}  " if self.is_terminal else line, end="" if self.is_line_open else "\n", file=sys.stderr)
        sys.stderr.flush()

    def tell(self, message: str) -> None:
        """A message on a line of its own."""
        print(("\n" if self.is_line_open else "") + f"benchmark: {message}", file=sys.stderr, flush=True)
        self.is_line_open = False


def is_complete(cell: Cell, key: str) -> bool:
    try:
        return (cell.folder / "report.json").is_file() and (cell.folder / KEY_FILE).read_text() == key
    except OSError:
        return False


def command_of(request: Request, cell: Cell, program: str) -> list[str]:
    command = [program, "--config", request.config, "--dataset", str(cell.dataset), "--objects", cell.objects_file,
               "--odometry", cell.odometry_file, "--method", cell.method.method, "--seed", str(cell.seed)]
    for setting in cell.settings(request):
        command += ["--set", setting]
    return command + ["--output", str(cell.folder)]


def failure_of(code: int, log: Path) -> str:
    """Why a run failed: its exit code, and the last line that it said."""
    said = log.read_text(errors="replace").strip().splitlines()[-1:]
    return ": ".join([f"signal {-code}" if code < 0 else f"code {code}", *said])


def make_run(request: Request, cell: Cell, key: str, programs: Programs) -> str:
    """Runs slam_offline for a cell. Returns why it failed, "" if it did not."""
    shutil.rmtree(cell.folder, ignore_errors=True)  # what an older program wrote is not this one's result
    try:
        cell.folder.mkdir(parents=True)
        log = cell.folder / LOG_FILE
        with log.open("wb") as output:
            run = programs.processes.run(command_of(request, cell, programs.slam_offline), stdout=output, stderr=output)
        if run.returncode != 0:
            return failure_of(run.returncode, log)
        write_file(cell.folder / KEY_FILE, key)
    except OSError as problem:
        return str(problem)
    return ""


def frames_of(cell: Cell) -> float:
    return float((cell.dataset / "times.txt").read_bytes().count(b"\n"))


def run_cells(request: Request, cells: list[Cell], programs: Programs, keys: Keys) -> tuple[Counts, dict[Path, str]]:
    """Runs slam_offline for each cell whose folder does not hold the complete result of the same configuration, input
    files and program; at most `request.jobs` at once, with progress on standard error. A run that fails is told there
    and does not stop the others. Returns the counts and, by the folders of failed runs, why they failed. Raises
    InputError for a configuration that is refused, before anything runs.
    """
    counts = Counts()
    planned: list[tuple[Cell, str]] = []
    by_folder: dict[Path, Cell] = {}
    for cell in cells:
        by_folder.setdefault(cell.folder, cell)
    for cell in by_folder.values():
        key = keys.key_of(cell)
        if is_complete(cell, key):
            counts.found += 1
        else:
            planned.append((cell, key))
    failures: dict[Path, str] = {}
    progress = Progress("runs", [frames_of(cell) for cell, _ in planned])
    runs = programs.processes.each(lambda run: make_run(request, *run, programs), planned, request.jobs)
    for place, failure in runs:
        cell = planned[place][0]
        counts.made += 1
        progress.add(frames_of(cell))
        if failure:
            failures[cell.folder] = failure
            progress.tell(f"{cell.name} failed, {failure}")
    return counts, failures
