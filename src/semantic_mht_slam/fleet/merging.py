"""The maps of the drives that are complete, joined."""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from .drive_list import Drive
from .drive_run import is_complete, reason_of_failure, result_folder
from .errors import FleetError

SUMMARY = "drives.json"


def merge_arguments(drives: list[Drive]) -> list[str]:
    first = drives[0].merge_arguments()
    for drive in drives[1:]:
        if drive.merge_arguments() != first:
            raise FleetError(f"the drives '{drives[0].name}' and '{drive.name}' have other parameters (--config, --set, "
                             "--method): maps are joined only if they were made with the same")
    return first


def merge_drives(program: str, drives: list[Drive], list_folder: Path, output: Path) -> str:
    """Joins the maps of all complete drives in output/merged, if this was not done yet; returns what to say."""
    complete = [drive for drive in drives if is_complete(output, drive)]
    missing = {drive.name: reason_of_failure(output, drive) for drive in drives if drive not in complete}
    text = "".join(f"missing: {name}: {reason}\n" for name, reason in missing.items())
    if len(complete) < 2:
        raise FleetError(f"{text}{len(complete)} of {len(drives)} drives are complete: nothing to join")
    maps = [result_folder(output, drive) / "map.bag" for drive in complete]
    summary = {"merged": {drive.name: path.stat().st_mtime_ns for drive, path in zip(complete, maps)}, "missing": missing}
    merged = output / "merged"
    if (merged / SUMMARY).exists() and json.loads((merged / SUMMARY).read_text(encoding="utf-8")) == summary:
        return f"{text}{merged}: is complete"
    unfinished = Path(tempfile.mkdtemp(prefix=".merged.tmp-", dir=output))
    unfinished.chmod(0o755)
    try:
        command = [program, *map(str, maps), *merge_arguments(complete), "--output", str(unfinished / "all.bag")]
        run = subprocess.run(command, cwd=list_folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=False)
        if run.returncode != 0:
            raise FleetError(f"{text}merge_maps failed, see above")
        (unfinished / SUMMARY).write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        if merged.exists():
            os.rename(merged, unfinished / "before")
        os.rename(unfinished, merged)
        shutil.rmtree(merged / "before", ignore_errors=True)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return f"{text}{run.stdout}{merged / 'all.bag'}: {len(complete)} of {len(drives)} drives"
