#!/usr/bin/python3
"""Prints those of ThreadSanitizer's reports in which every access is made by this package's own code.

    scripts/tsan_reports.py LOG...

roscpp and other libraries are not built with the sanitizer, so that their locks are not seen: what one thread of theirs
frees, another wrote under a lock. Whose an access is, its innermost frame says that is neither of the sanitizer, nor of the
standard library. Ends with code 1 if a report is of this package, with 2 if there is no log."""
import re
import sys
from pathlib import Path

BESIDE = re.compile(r"libsanitizer|/usr/include/c\+\+/|/usr/include/eigen3/| std::|/usr/include/x86_64-linux-gnu/c\+\+/")
OWN = re.compile(r"/(src|include)/(semantic_mht_slam/)?(app|common|evaluation|graph|io|map|mapping|merging|models|nodelets|"
                 r"perception|place|programs|registration|ros|simulation|slam)/[a-z_0-9]+\.(cpp|h):\d+")
ACCESS = re.compile(r"^ *(WARNING|Read|Write|Previous|Atomic|Mutex M\d+ acquired)", re.MULTILINE)


def accesses(report):
    """The frames of each access, the innermost first; where they were not kept, those of who made what was accessed."""
    parts = [(part.strip(), re.findall(r"#\d+ (.*)", part)) for part in report.split("\n\n")]
    made = [frames for part, frames in parts if part.startswith("Location is heap block")]
    for part, frames in parts:
        if ACCESS.match(part) and (frames or made):
            yield frames or made[0]


def is_own(frames):
    for frame in frames:
        if not BESIDE.search(" " + frame):
            return "/usr/include/" not in frame and OWN.search(frame) is not None
    return False


def main(logs):
    if not logs:
        print("tsan: there is no log")
        return 2
    reports = [report for log in logs for report in Path(log).read_text(encoding="utf-8", errors="replace").split("=" * 18)
               if "WARNING: ThreadSanitizer" in report]
    own = [report for report in reports if all(is_own(frames) for frames in accesses(report))]
    print("\n".join(own))
    print(f"tsan: {len(reports)} reports, {len(own)} of them of this package")
    return 1 if own else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
