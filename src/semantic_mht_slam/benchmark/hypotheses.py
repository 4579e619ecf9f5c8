"""The command `benchmark hypotheses`: how many hypotheses lived in each frame, of runs by their report.json."""
from __future__ import annotations

import argparse
from pathlib import Path

from .cells import COLORS, FULL_SYSTEM
from .errors import InputError
from .files import write_file
from .plots import Members, violin_plot
from .scores import frames_with_hypotheses, read_json


def named_counts(argument: str) -> tuple[str, dict[int, float]]:
    """Name and frames by number of hypotheses of NAME=FILE. Raises InputError."""
    name, equals, path = argument.partition("=")
    if not equals:
        raise InputError(f"{argument}: NAME=FILE was expected")
    counts = frames_with_hypotheses(read_json(Path(path)))
    if not counts:
        raise InputError(f"{path}: no report of a run with hypotheses")
    return name, counts


def hypotheses(parser: argparse.ArgumentParser, arguments: list[str]) -> int:
    """Prints a mean a run and draws a violin a run."""
    parser.add_argument("reports", nargs="+", metavar="NAME=FILE", help="name and report.json of a run")
    parser.add_argument("--output", type=Path, required=True, metavar="FILE", help="SVG file with a violin a run")
    values = parser.parse_args(arguments)
    runs = [named_counts(argument) for argument in values.reports]
    for name, counts in runs:
        print(f"{name} {sum(number * frames for number, frames in counts.items()) / sum(counts.values()):.2f}")
    figure = violin_plot("", "hypotheses", [name for name, _ in runs],
                           [Members("frames", COLORS[FULL_SYSTEM], [counts for _, counts in runs])])
    write_file(values.output, figure.svg)
    return 0
