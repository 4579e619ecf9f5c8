"""The command line of run_drive."""
from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from .drive_list import read_drives
from .drive_run import run_drive
from .errors import FleetError
from .merging import merge_drives

DESCRIPTION = """Runs one drive of a list, or joins the maps of those that are complete. Safe to call again: it does only what
is missing.

  run_drive 3 --drives LIST --output DIR        runs the third drive
  run_drive --merge --drives LIST --output DIR  joins the maps
  run_drive --count --drives LIST               prints how many there are

  LIST  a line a drive: NAME and the arguments of slam_offline; # begins a comment; paths begin at the list's folder
  DIR   drives/NAME (complete), failed/NAME (with run.log), merged/all.bag

`fleet_slurm LIST DIR` and `fleet_parallel LIST DIR` run all of them.
"""


class Parser(argparse.ArgumentParser):
    def error(self, message: str):
        raise FleetError(f"{message} (see --help)")


def make_parser() -> Parser:
    parser = Parser(prog="run_drive", description=DESCRIPTION, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    task = parser.add_mutually_exclusive_group(required=True)
    task.add_argument("index", nargs="?", type=int, metavar="N", help="which drive of the list, from 1")
    task.add_argument("--merge", action="store_true", help="joins the maps of the drives that are complete")
    task.add_argument("--count", action="store_true", help="prints how many drives the list names")
    parser.add_argument("--drives", type=Path, required=True, metavar="LIST", help="the list of drives")
    parser.add_argument("--output", type=Path, metavar="DIR", help="folder for all results; made if missing")
    return parser


def find_program(name: str) -> str:
    """Path of a program of this package. Raises FleetError if it was not built."""
    from roslib.packages import find_node  # takes a while
    found = find_node("semantic_mht_slam", name)
    if not found:
        raise FleetError(f"the program {name} is missing: build the package and source its setup.bash")
    return found[0]


def do(arguments: list[str]) -> str:
    values = make_parser().parse_args(arguments)
    drives = read_drives(values.drives)
    if values.count:
        return str(len(drives))
    if values.output is None:
        raise FleetError("--output is needed (see --help)")
    output, list_folder = values.output.absolute(), values.drives.absolute().parent
    try:
        output.mkdir(parents=True, exist_ok=True)
        if values.merge:
            return merge_drives(find_program("merge_maps"), drives, list_folder, output)
        if not 1 <= values.index <= len(drives):
            raise FleetError(f"there is no drive {values.index}: the list '{values.drives}' names {len(drives)}")
        return run_drive(find_program("slam_offline"), drives[values.index - 1], list_folder, output)
    except OSError as problem:
        raise FleetError(f"'{problem.filename}': {os.strerror(problem.errno or 0)}") from None


def main(arguments: list[str]) -> int:
    try:
        print(do(arguments))
    except FleetError as problem:
        print(f"run_drive: {problem}", file=sys.stderr)
        return 1
    return 0
