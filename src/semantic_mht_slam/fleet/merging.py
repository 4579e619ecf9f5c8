"""The maps of the drives that are complete, joined."""
from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

from .drive_list import Drive
from .drive_run import (LOG, MAP, is_complete, last_line, new_folder, reason_of_failure, result_folder, run_program, sole_run,
                        write_surely)
from .errors import FleetError

SUMMARY = "drives.json"
MERGED = "merged"


def merge_arguments(drives: list[Drive]) -> list[str]:
    first = drives[0].merge_arguments()
    for drive in drives[1:]:
        if drive.merge_arguments() != first:
            raise FleetError(f"the drives '{drives[0].name}' and '{drive.name}' have other parameters (--config, --set, "
                             "--method): maps are joined only if they were made with the same")
    return first


def known_summary(merged: Path) -> dict:
    try:
        return json.loads((merged / SUMMARY).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def merge_drives(program: str, drives: list[Drive], list_folder: Path, output: Path) -> str:
    """Joins the maps of all complete drives in output/merged, if this was not done yet; returns what to say."""
    complete = [drive for drive in drives if is_complete(output, drive, list_folder)]
    missing = {drive.name: reason_of_failure(output, drive) for drive in drives if drive not in complete}
    text = "".join(f"missing: {name}: {reason}\n" for name, reason in missing.items())
    if len(complete) < 2:
        raise FleetError(f"{text}{len(complete)} of {len(drives)} drives are complete: nothing to join")
    maps = [result_folder(output, drive) / MAP for drive in complete]
    summary = {"merged": {drive.name: path.stat().st_mtime_ns for drive, path in zip(complete, maps)}, "missing": missing}
    merged = output / MERGED
    with sole_run(output, f".{MERGED}") as lock:
        if known_summary(merged).get("merged") == summary["merged"]:
            write_surely(merged / SUMMARY, json.dumps(summary, indent=2) + "\n")
            return f"{text}{merged}: is complete"
        unfinished = new_folder(output, MERGED)
        command = [program, *map(str, maps), *merge_arguments(complete), "--output", str(unfinished / "all.bag")]
        code = run_program(command, list_folder, unfinished / LOG, lock)
        said = last_line(unfinished / LOG)
        if code != 0:
            shutil.rmtree(unfinished)
            raise FleetError(f"{text}merge_maps failed: {said}")
        write_surely(unfinished / SUMMARY, json.dumps(summary, indent=2) + "\n")
        if merged.exists():
            os.rename(merged, unfinished / "before")
        os.rename(unfinished, merged)
        shutil.rmtree(merged / "before", ignore_errors=True)
    return f"{text}{said}\n{merged / 'all.bag'}: {len(complete)} of {len(drives)} drives"
