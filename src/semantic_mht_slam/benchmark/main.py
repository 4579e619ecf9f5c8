"""The command line of the benchmark."""
from __future__ import annotations

import argparse
import os
import signal
import sys
from pathlib import Path

from .cells import FULL_SYSTEM, METHODS, Cell, Request, make_cells, parse_names, parse_seeds
from .errors import InputError
from .hypotheses import hypotheses
from .processes import Processes
from .programs import Programs, find_folder
from .report import Result, write_report
from .runner import Keys, Progress, run_cells
from .scores import Scorer, score_references

MAX_JOBS = 1024
INTERRUPTED = 130  # as a shell says it

DESCRIPTION = """Runs slam_offline on sequences x odometries x objects x methods x seeds, several at once, and compares the
results with the truth, the odometry as it is and other systems. What is complete is not run again.

  DIR/NN/  times.txt, calib.txt, poses.txt, odometry/*.txt, objects, and for comparison reference/*.txt
  objects  best: objects.csv, else objects_semireal.csv; semireal; noisy; or the name of a file in DIR/NN
  output   report.html, results.csv, results.json, results.md, times.csv, config.yaml, runs/

`benchmark hypotheses NAME=report.json ... --output FILE.svg` draws how many hypotheses lived in runs of your own.
"""


class Parser(argparse.ArgumentParser):
    def error(self, message: str):
        raise InputError(f"{message} (see --help)")


def make_parser() -> Parser:
    methods = "".join(f"  {method.name:<18} {method.help}{'' if method.is_default else ' (only if named)'}\n"
                      for method in METHODS)
    parser = Parser(prog="benchmark", description=DESCRIPTION, epilog="methods\n" + methods, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True, metavar="DIR", help="folder with a folder a sequence")
    parser.add_argument("--output", type=Path, required=True, metavar="DIR", help="folder for the report and the runs")
    parser.add_argument("--sequences", metavar="00,05", help="default: every folder that has times.txt and poses.txt")
    parser.add_argument("--odometries", metavar="A,B", help="names of files odometry/NAME.txt; default: all")
    parser.add_argument("--objects", default="best", metavar="best,noisy", help="default: best")
    parser.add_argument("--methods", metavar="A,B", help="default: all but one")
    parser.add_argument("--seeds", default="1-5", metavar="1-5", help="default: 1-5")
    parser.add_argument("--jobs", type=int, default=min(os.cpu_count() or 1, MAX_JOBS), metavar="N",
                        help="runs at once; default: one a core")
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE",
                        help="changes a parameter of every run; may be given several times")
    parser.add_argument("--config", default="kitti.yaml", metavar="FILE",
                        help="parameters, a file or the name of one of the package's: kitti.yaml (default), paper.yaml")
    return parser


def parse(arguments: list[str]) -> Request:
    values = make_parser().parse_args(arguments)
    if not 1 <= values.jobs <= MAX_JOBS:
        raise InputError(f"--jobs {values.jobs}: 1 to {MAX_JOBS} were expected")
    lists = {name: parse_names(f"--{name}", text) for name in ("sequences", "odometries", "objects", "methods")
             for text in [getattr(values, name)] if text is not None}
    return Request(values.data, values.output, values.config, seeds=parse_seeds(values.seeds), settings=values.settings,
                   jobs=values.jobs, **lists)


def score_cells(request: Request, cells: list[Cell], statuses: list[str], scorer: Scorer) -> list[dict[str, float]]:
    """Figures of what ran; a result that cannot be scored is a failure of its cell."""
    def score(place: int) -> dict[str, float] | InputError:
        try:
            return scorer.figures_of(cells[place])
        except InputError as problem:
            return problem

    figures: list[dict[str, float]] = [{} for _ in cells]
    complete = [place for place, status in enumerate(statuses) if status == "ok"]
    progress = Progress("scores", [1.0] * len(complete))
    for i, answer in scorer.programs.processes.each(score, complete, request.jobs):
        place = complete[i]
        progress.add(1.0)
        if isinstance(answer, InputError):
            statuses[place] = f"failed: {answer}"
            progress.tell(f"{cells[place].name} cannot be scored: {answer}")
        else:
            figures[place] = answer
    return figures


def benchmark(request: Request, programs: Programs) -> int:
    cells = make_cells(request)
    keys = Keys(request, programs)
    for cell in cells:
        keys.key_of(cell)  # refuses a configuration before anything is written
    config = programs.effective_config(request.config, [*request.settings, f"method={FULL_SYSTEM}"])
    try:
        request.output.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise InputError(f"cannot make the output folder '{request.output}': {problem.strerror}") from None
    counts, failures = run_cells(request, cells, programs, keys)
    statuses = [f"failed: {failures[cell.folder]}" if cell.folder in failures else "ok" for cell in cells]
    scorer = Scorer(programs)
    figures = score_cells(request, cells, statuses, scorer)
    references = score_references(cells, scorer)
    told = write_report(Result(request, cells, statuses, figures, references, programs, keys.program, config))
    for statement in told:
        print(f"{'yes ' if statement.holds else 'NO  '} {statement.text}")
    failed = len(cells) - statuses.count("ok")
    print(f"{counts.made} runs made, {counts.found} found complete, {failed} failed; report in "
          f"{request.output}/report.html")
    return 1 if failed else 0


def interrupt(*_) -> None:
    raise KeyboardInterrupt


def main(arguments: list[str]) -> int:
    """Exit code: 0, 1 if something failed, 130 if it was interrupted."""
    processes = Processes()
    signal.signal(signal.SIGTERM, interrupt)
    try:
        if arguments[:1] == ["hypotheses"]:
            return hypotheses(Parser(prog="benchmark hypotheses", allow_abbrev=False), arguments[1:])
        return benchmark(parse(arguments), Programs(find_folder(), processes))
    except KeyboardInterrupt:
        print("benchmark: interrupted; the same command goes on with the runs that are missing", file=sys.stderr)
        return INTERRUPTED
    except (InputError, OSError) as problem:
        for line in str(problem).splitlines():
            print(f"benchmark: {line}", file=sys.stderr)
        return 1
    finally:
        processes.stop()
