#!/usr/bin/python3
"""Files of more than 300 lines, which want to be split. Exits with code 1 if there is any."""
import sys
from pathlib import Path

LIMIT = 300
long_files = [(path, len(path.read_text().splitlines())) for folder in ("include", "src", "scripts", "test")
              for path in sorted(Path(folder).rglob("*")) if path.suffix in (".h", ".cpp", ".py", ".sh")]
long_files = [(path, lines) for path, lines in long_files if lines > LIMIT]
for path, lines in long_files:
    print(f"{path}: {lines} lines, at most {LIMIT} are allowed")
sys.exit(1 if long_files else 0)
