"""The list of drives: a name and the arguments of slam_offline a line."""
from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from .errors import FleetError

NAME = r"[A-Za-z0-9][A-Za-z0-9._-]*"
SHARED_WITH_MERGING = ("--config", "--set", "--method")


@dataclass(frozen=True)
class Drive:
    """A line of the list."""

    name: str
    arguments: tuple[str, ...]  # of slam_offline, without --output

    def merge_arguments(self) -> list[str]:
        """Those that merge_maps must have as well to read the map of this drive."""
        result: list[str] = []
        words = iter(self.arguments)
        for word in words:
            option, _, value = word.partition("=")
            if option not in SHARED_WITH_MERGING:
                continue
            value = value or next(words, "")
            result += ["--set", f"method={value}"] if option == "--method" else [option, value]
        return result


def words_of(line: str) -> list[str]:
    """As a shell splits a line; a word that begins with # begins a remark. Raises ValueError."""
    if "\0" in line:
        raise ValueError("a zero byte")
    lexer = shlex.shlex(line, posix=True)
    lexer.whitespace_split = True
    lexer.commenters = ""
    words = list(lexer)
    remark = next((i for i, word in enumerate(words) if word.startswith("#")), len(words))
    return words[:remark]


def read_drives(path: Path) -> list[Drive]:
    """The drives of a list, in its order. Raises FleetError, with the line, for one that cannot be run."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as problem:
        raise FleetError(f"the list '{path}' cannot be read: {getattr(problem, 'strerror', None) or problem}") from None
    drives: list[Drive] = []
    for number, line in enumerate(lines, start=1):
        where = f"{path}:{number}"
        try:
            words = words_of(line)
        except ValueError as problem:
            raise FleetError(f"{where}: {problem}") from None
        if not words:
            continue
        name, *arguments = words
        if not re.fullmatch(NAME, name):
            raise FleetError(f"{where}: '{name}' is no name of a drive: letters, digits, '.', '_' and '-' only, a letter or "
                             "digit first")
        if any(drive.name == name for drive in drives):
            raise FleetError(f"{where}: a second drive '{name}'; names must differ")
        if not arguments:
            raise FleetError(f"{where}: no arguments of slam_offline behind the name, as in `{name} --bag {name}.bag`")
        if any(word.split("=")[0] == "--output" for word in arguments):
            raise FleetError(f"{where}: --output is set by run_drive")
        drives.append(Drive(name, tuple(arguments)))
    if not drives:
        raise FleetError(f"the list '{path}' names no drive: a line is `NAME --bag FILE` or NAME and other arguments of "
                         "slam_offline")
    return drives
