"""Output files: each is whole or the old one."""
from __future__ import annotations

import os
from pathlib import Path


def write_file(path: Path, content: str) -> None:
    """Writes beside the file's name, syncs and renames. Raises OSError."""
    staged = path.with_name(f".{path.name}.{os.getpid()}")
    with staged.open("w", encoding="utf-8", newline="\n") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    os.replace(staged, path)
