"""The programs that the benchmark calls, slam_offline and evaluate, and what they answer."""
from __future__ import annotations

import hashlib
import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Sequence

import rospkg

from .errors import InputError
from .processes import Processes

PACKAGE = "semantic_mht_slam"


def package_config_file(name: str) -> Path:
    """A file of the package's configuration folder. Raises InputError if ROS does not know the package."""
    try:
        return Path(rospkg.RosPack().get_path(PACKAGE)) / "config" / name
    except rospkg.ResourceNotFound:
        raise InputError(f"ROS does not know the package {PACKAGE}: source devel/setup.bash first") from None


def hash_of(*paths: Path) -> str:
    """Hash of the content of files. Raises InputError."""
    digest = hashlib.sha256()
    for path in paths:
        try:
            digest.update(path.read_bytes())
        except OSError as problem:
            raise InputError(f"cannot read '{path}': {problem.strerror}") from None
    return digest.hexdigest()[:16]


def find_folder() -> Path:
    """Where the programs stand: beside this one. Raises InputError."""
    folder = Path(os.path.abspath(sys.argv[0])).parent
    for name in ("slam_offline", "evaluate"):
        if not (folder / name).is_file():
            raise InputError(f"no program '{folder / name}'; start this one by `rosrun semantic_mht_slam benchmark`")
    return folder


class Programs:
    """slam_offline and evaluate in one folder."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        self.folder = folder
        self.processes = processes

    @property
    def slam_offline(self) -> str:
        return str(self.folder / "slam_offline")

    def answer(self, name: str, arguments: Sequence[str]) -> str:
        """What a program prints. Raises InputError with what it says if it ends with another code than 0."""
        run = self.processes.run([str(self.folder / name), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 encoding="utf-8", errors="replace")
        if run.returncode != 0:
            raise InputError(run.stderr.strip() or f"{name} ended with code {run.returncode}")
        return run.stdout

    def evaluate(self, command: str, options: Sequence[object]) -> dict:
        """Figures of a command of `evaluate`, NaN where one is not defined. Raises InputError."""
        text = self.answer("evaluate", [command, "--json", *map(str, options)])
        return json.loads(text, object_hook=lambda figures: {
            name: math.nan if value is None else value for name, value in figures.items()})

    def revision(self) -> str:
        """Git revision of the source that the programs were made from, "unknown" if it was no checkout."""
        return self.answer("evaluate", ["--revision"]).strip()

    def hash(self) -> str:
        """Hash of slam_offline and the libraries that shape what it computes: a name for the program that is true
        whatever the state of the source tree. The scores are made anew every time: another way of scoring does not make
        a run another one.
        """
        libraries = [path for path in self.folder.parent.glob("libsemantic_mht_slam_*")
                     if path.is_file() and "_evaluation." not in path.name]
        return hash_of(self.folder / "slam_offline", *sorted(libraries))

    def effective_config(self, config: str, settings: Sequence[str]) -> str:
        """The parameters of a file or of one of the package's, changed by KEY=VALUE, as YAML. Raises InputError for what slam_offline refuses."""
        options = ["--config", config, "--print-config"]
        for setting in settings:
            options += ["--set", setting]
        return self.answer("slam_offline", options)
