"""Figures of runs, by the commands of `evaluate` and from the report.json of a run."""
from __future__ import annotations

import functools
import json
import math
from pathlib import Path

from .cells import Cell
from .errors import InputError
from .programs import Programs

TRAJECTORY = ["first_m", "se3_m", "running_mean_m", "running_std_m", "t_rel_percent", "r_rel_deg_per_100m", "revisit_m",
              "end_m"]
CLOSURES = ["closures_checked", "closures_accepted", "closures_wrong", "closures_precision", "closures_recall"]
ASSOCIATIONS = [f"association_{pairs}_{figure}" for pairs in ("local", "all")
                for figure in ("precision", "recall", "f1")] + ["clutter_accepted", "static_rejected"]
MAP = ["hypotheses_mean", "hypotheses_max", "landmarks", "submaps", "map_mb", "map_mb_per_km"]
# Every figure of a run that does not change when it is repeated, in the order of results.csv.
FIGURES = ["frames", "length_m", *TRAJECTORY, *("online_" + name for name in TRAJECTORY),
           *("raw_" + name for name in TRAJECTORY), "reduction_se3_percent", "reduction_running_percent", *CLOSURES,
           *ASSOCIATIONS, *MAP]
# Times and memory, which are measured anew each time: where they stand in report.json.
MEASURED = {"seconds": "seconds", "ms_mean": "ms_per_frame/mean", "ms_p50": "ms_per_frame/p50",
            "ms_p95": "ms_per_frame/p95", "ms_p99": "ms_per_frame/p99", "ms_max": "ms_per_frame/max",
            "mapping_ms_mean": "mapping_ms_per_frame/mean", "mapping_ms_p99": "mapping_ms_per_frame/p99",
            "peak_rss_mb": "peak_rss_mb"}
BYTES_PER_MB = 1e6
M_PER_KM = 1e3


def read_json(path: Path) -> dict:
    """An object. Raises InputError."""
    try:
        content = json.loads(path.read_text())
    except (OSError, ValueError) as problem:
        raise InputError(f"{path}: cannot be read as JSON ({problem})") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: no JSON object")
    return content


def number_at(report: dict, path: str) -> float:
    """A number of a report by its path, as "hypotheses/mean"; NaN if there is none."""
    value: object = report
    for name in path.split("/"):
        value = value.get(name) if isinstance(value, dict) else None
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else math.nan


def report_of(cell: Cell) -> dict:
    return read_json(cell.folder / "report.json")


def measured_of(cell: Cell) -> dict[str, float]:
    report = report_of(cell)
    return {name: number_at(report, path) for name, path in MEASURED.items()}


def frames_with_hypotheses(report: dict) -> dict[int, float]:
    """How many frames had how many hypotheses; empty if the report does not tell."""
    known = report.get("hypotheses")
    counts = known.get("frames_with", {}) if isinstance(known, dict) else {}
    return {int(hypotheses): float(frames) for hypotheses, frames in counts.items()}


def references_of(dataset: Path) -> list[Path]:
    """Trajectories of systems to compare with, by their names."""
    return sorted((dataset / "reference").glob("*.txt"))


def online_file(cell: Cell) -> Path | None:
    """The trajectory as it was known live; None if the run wrote none."""
    path = cell.folder / "trajectory_online.tum"
    return path if path.is_file() and path.stat().st_size > 0 else None


def has_rows(path: Path) -> bool:
    """Whether a CSV file holds more than its header. Raises InputError."""
    try:
        with path.open() as file:
            return sum(1 for _, line in zip(range(2), file) if line.strip()) == 2
    except OSError as problem:
        raise InputError(f"cannot read '{path}': {problem.strerror}") from None


class Scorer:
    """Scores results and keeps what several runs share."""

    def __init__(self, programs: Programs) -> None:
        self.programs = programs
        self.trajectory_error = functools.lru_cache(maxsize=None)(self._trajectory_error)  # odometries are asked for often

    def _trajectory_error(self, dataset: Path, estimate: Path) -> dict[str, float]:
        return self.trajectory_errors(dataset, [estimate])[0]

    def trajectory_errors(self, dataset: Path, estimates: list[Path]) -> list[dict[str, float]]:
        """Figures of trajectories of camera 0 against the poses of a data set; beside the names of TRAJECTORY: frames,
        length_m (of the true path).
        """
        options: list[object] = ["--truth", dataset / "poses.txt"]
        for estimate in estimates:
            options += ["--estimate", estimate]
        errors = self.programs.evaluate("trajectory", options)
        return [errors[str(estimate)] for estimate in estimates]

    def figures_of(self, cell: Cell) -> dict[str, float]:
        """Every one of FIGURES. Raises InputError if a file of the result is missing or broken."""
        raw = self.trajectory_error(cell.dataset, cell.dataset / cell.odometry_file)
        online_path = online_file(cell)
        error, *online = self.trajectory_errors(
            cell.dataset, [cell.folder / "trajectory.txt", *([online_path] if online_path else [])])
        report = report_of(cell)
        figures = {"frames": number_at(report, "frames"), "length_m": error["length_m"]}
        for prefix, errors in (("", error), ("online_", online[0] if online else {}), ("raw_", raw)):
            figures.update({prefix + name: errors.get(name, math.nan) for name in TRAJECTORY})
        for name, figure in (("se3", "se3_m"), ("running", "running_mean_m")):
            ratio = error[figure] / raw[figure] if raw[figure] else math.nan
            figures[f"reduction_{name}_percent"] = 100.0 * (1.0 - ratio)
        figures.update(self.closures_of(cell))
        figures.update(self.associations_of(cell))
        figures.update(map_size(report, error["length_m"]))
        return figures

    def closures_of(self, cell: Cell) -> dict[str, float]:
        score = self.programs.evaluate("loops", ["--poses", cell.dataset / "poses.txt",
                                                 "--closures", cell.folder / "loop_closures.csv"])
        return {"closures_checked": score["checked"], "closures_accepted": score["accepted"],
                "closures_wrong": score["wrong"],
                "closures_precision": score["precision"] if score["accepted"] else math.nan,
                "closures_recall": score["recall"] if score["revisited_blocks"] else math.nan}

    def associations_of(self, cell: Cell) -> dict[str, float]:
        """The truth of the objects is beside them: objects.csv, objects_landmark.csv. NaN where there is none, and for a
        method without a map.
        """
        objects = cell.dataset / cell.objects_file
        truth = objects.with_name(f"{objects.stem}_landmark{objects.suffix}")
        associations = cell.folder / "associations.csv"
        if not truth.is_file() or not has_rows(associations):
            return dict.fromkeys(ASSOCIATIONS, math.nan)
        score = self.programs.evaluate("association", ["--truth", truth, "--associations", associations])
        figures = {f"association_{pairs}_{name}": score[pairs][name] for pairs in ("local", "all")
                   for name in ("precision", "recall", "f1")}
        return {**figures, "clutter_accepted": score["clutter_accepted"], "static_rejected": score["static_rejected"]}


def map_size(report: dict, length_m: float) -> dict[str, float]:
    map_mb = number_at(report, "map_bytes") / BYTES_PER_MB
    return {"hypotheses_mean": number_at(report, "hypotheses/mean"),
            "hypotheses_max": number_at(report, "hypotheses/max"), "landmarks": number_at(report, "landmarks"),
            "submaps": number_at(report, "submaps"), "map_mb": map_mb,
            "map_mb_per_km": map_mb / (length_m / M_PER_KM) if length_m > 0.0 else math.nan}


def score_references(cells: list[Cell], scorer: Scorer) -> list[dict]:
    """Systems to compare with: sequence, name, and the figures of TRAJECTORY."""
    references = []
    for sequence, dataset in dict.fromkeys((cell.sequence, cell.dataset) for cell in cells):
        paths = references_of(dataset)
        errors = scorer.trajectory_errors(dataset, paths) if paths else []
        references += [{"sequence": sequence, "name": path.stem, "figures": {name: error[name] for name in TRAJECTORY}}
                       for path, error in zip(paths, errors)]
    return references
