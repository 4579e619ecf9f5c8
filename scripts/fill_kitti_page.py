#!/usr/bin/python3
"""Fills the tables of docs/kitti.md that stand between "<!-- results: NAME -->" and "<!-- /results -->" from benchmarks.
    scripts/fill_kitti_page.py BENCHMARK [SEMIREAL] [--page FILE]
BENCHMARK is the output folder of `benchmark --objects best,noisy --seeds 1-5` on 00, 05, 06 and 07 (results.csv,
and results.json for the systems to compare with). SEMIREAL is that of one with `--sequences 00 --odometries vo_orb --objects
semireal`: the associations of 00 with lidar-like objects, whose cells stay as they are without it. Times stay, too: those of
a benchmark are of several runs at once. Needs no ROS; the same results give the same page. Ends with code 1, and changes
nothing, if a run or a column is missing.
"""
import argparse
import csv
import json
import math
import re
import statistics
import sys
from pathlib import Path

SEQUENCES = ["00", "05", "06", "07"]
ODOMETRIES = {"vo_orb": "ORB-SLAM2 stereo tracking (`vo_orb`)", "lo_simple": "SiMpLE lidar odometry (`lo_simple`)",
              "vo_dfvo": "DF-VO stereo (`vo_dfvo`)"}
METHODS = {"odometry": "the odometry as it is", "ukf": "`ukf`", "mhm": "`mhm`", "dpmhm": "**`dpmhm`**",
           "no_semantics": "`dpmhm` without classes", "single_hypothesis": "`dpmhm` with one hypothesis"}
REFERENCES = ["slam_orbslam2_stereo", "slam_suma"]
SEEDS = {"1", "2", "3", "4", "5"}
CASE = ["sequence", "odometry", "objects", "method"]


class Missing(Exception):
    """A run, a column or a place in the page."""


def number(text, where):
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise Missing(f"{where}: '{text}' is no figure")
    return value


class Results:
    """The runs of the benchmarks."""

    def __init__(self, folders):
        self.runs = []
        self.cases = {}
        self.names = ", ".join(str(folder / "results.csv") for folder in folders)
        for folder in folders:
            self.add(folder / "results.csv")
        self.references_path = folders[0] / "results.json"
        references = json.loads(self.references_path.read_text())["references"]
        self.references = {(entry["sequence"], entry["name"]): entry["figures"] for entry in references}

    def add(self, path):
        with open(path, newline="") as file:
            reader = csv.DictReader(file)
            for column in CASE + ["seed", "status", "objects_are"]:
                if column not in (reader.fieldnames or []):
                    raise Missing(f"{path}: no column '{column}'")
            for row in reader:
                self.runs.append(row)
                case = self.cases.setdefault(tuple(row[key] for key in CASE), {})
                if row["seed"] in case:
                    raise Missing(f"{path}, line {reader.line_num}: this run stands there twice")
                case[row["seed"]] = row

    def figure(self, run, column):
        where = f"{self.names}: {' '.join(run[key] for key in CASE)} seed {run['seed']}"
        if run["status"] != "ok":
            raise Missing(f"{where}: {run['status']}")
        if column not in run:
            raise Missing(f"{self.names}: no column '{column}'")
        return number(run[column], f"{where}, {column}")

    def median(self, column, *case):
        """Of the seeds, all of which must be there."""
        runs = self.cases.get(case, {})
        missing = ({"1"} if case[-1] == "odometry" else SEEDS) - set(runs)
        if missing:
            raise Missing(f"{self.names}: no run {' '.join(case)} with seed {', '.join(sorted(missing))}")
        return statistics.median(self.figure(run, column) for run in runs.values())

    def are(self, sequence, objects):
        return {run["objects_are"] for run in self.runs if (run["sequence"], run["objects"]) == (sequence, objects)}

    def reference(self, sequence, name):
        figures = self.references.get((sequence, name), {})
        return number(figures.get("se3_m"), f"{self.references_path}: SE3-aligned RMSE of {name} on {sequence}")


def table(head, rows):
    lines = [" | ".join(cells) for cells in [head, *rows]]
    return "\n".join([f"| {lines[0].lstrip()} |", "|---" * len(head) + "|", *(f"| {line} |" for line in lines[1:])])


def cells_of(present):
    """Cells of the table as it stands, by its first column."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in present.strip().splitlines()]
    return {row[0]: row for row in rows}


def associated_objects(results, sequence, objects):
    """Those of which the landmarks are known; None if there is no run with such ones."""
    if "real" not in results.are(sequence, objects):
        return objects
    return "semireal" if results.are(sequence, "semireal") else None


def association(results, present):
    head = ["", *SEQUENCES, "mean hypotheses (00)", "ms a frame on one core, mean / p99 (00)"]
    before = cells_of(present)
    rows = []
    for objects, name in (("best", "lidar-like"), ("noisy", "camera-like")):
        for method in ("dpmhm", "mhm", "ukf"):
            row = before.get(f"{name}, `{method}`", [])
            if len(row) != len(head):
                raise Missing(f"kitti.md: no row '{name}, `{method}`' with {len(head)} cells, of which the time stays")
            for i, sequence in enumerate(SEQUENCES, 1):
                known = associated_objects(results, sequence, objects)
                if known is None:
                    print(f"fill_kitti_page: {sequence} of '{row[0]}' stays: no run with the objects 'semireal'")
                    continue
                case = (sequence, "vo_orb", known, method)
                row[i] = f"{results.median('association_local_f1', *case):.3f}".lstrip("0")
                if sequence == "00":
                    row[-2] = f"{results.median('hypotheses_mean', *case):.1f}"
            rows.append(row)
    return table(head, rows)


def trajectory(results, _):
    rows = []
    for objects in ("best", "noisy"):
        for odometry, name in ODOMETRIES.items():
            pairs = [[results.median(column, sequence, odometry, objects, "dpmhm") for column in ("raw_se3_m", "se3_m")]
                     for sequence in SEQUENCES]
            label = name if objects == "best" else f"`{odometry}`, camera-like objects"
            rows.append([label, *(f"{before:.2f} → {after:.2f}" for before, after in pairs)])
    rows.append(["for comparison: ORB-SLAM2 with loop closing / SuMa"] +
                [" / ".join(f"{results.reference(sequence, name):.2f}" for name in REFERENCES) for sequence in SEQUENCES])
    return table(["odometry", *SEQUENCES], rows)


def means(results, _):
    columns = [(objects, column) for objects in ("best", "noisy") for column in ("se3_m", "running_mean_m")]
    rows = []
    for method, name in METHODS.items():
        cells = [statistics.fmean(results.median(column, sequence, odometry, objects, method)
                                  for sequence in SEQUENCES for odometry in ODOMETRIES) for objects, column in columns]
        rows.append([name, *(f"{cell:.2f}" for cell in cells)])
    return table(["means of the twelve cases [m]", "real and lidar-like: SE3-aligned", "running, unaligned",
                  "camera-like: SE3-aligned", "running, unaligned"], rows)


def closures(results, _):
    """A part of a sentence."""
    runs = [run for run in results.runs if run["objects"] in ("best", "noisy")]
    accepted, wrong = (int(sum(results.figure(run, column) for run in runs))
                       for column in ("closures_accepted", "closures_wrong"))
    return f"{wrong or 'None'} of {accepted:,} accepted closures of all {len(runs)} runs {'are' if wrong > 1 else 'is'} wrong"


BLOCKS = {"association": association, "trajectory": trajectory, "means": means, "closures": closures}


def filled(text, results):
    for name, make in BLOCKS.items():
        block = re.compile(rf"(<!-- results: {name} -->)(.*?)(<!-- /results -->)", re.DOTALL)
        found = block.findall(text)
        if len(found) != 1:
            raise Missing(f"kitti.md: {len(found)} places between '<!-- results: {name} -->' and '<!-- /results -->', not 1")
        content = make(results, found[0][1])
        if "\n" in content:
            content = f"\n\n{content}\n\n"
        text = block.sub(lambda match, content=content: match.group(1) + content + match.group(3), text)
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmarks", nargs="+", type=Path, metavar="FOLDER", help="BENCHMARK, then SEMIREAL if wanted")
    parser.add_argument("--page", type=Path, default=Path(__file__).resolve().parent.parent / "docs" / "kitti.md")
    arguments = parser.parse_args()
    try:
        before = arguments.page.read_text()
        after = filled(before, Results(arguments.benchmarks))
    except (Missing, OSError, KeyError, json.JSONDecodeError) as problem:
        print(f"fill_kitti_page: {problem}", file=sys.stderr)
        return 1
    arguments.page.write_text(after)
    print(f"fill_kitti_page: {arguments.page} {'is as it was' if after == before else 'is filled'}")
    return 0


sys.exit(main())
