"""The figures of a part of the report: errors over the frames, hypotheses, ablations and maps."""
from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy
import pandas

from .cells import COLORS, FULL_SYSTEM, METHODS, Cell
from .plots import Drawing, Line, Members, bar_plot, line_plot, violin_plot
from .programs import Programs
from .scores import frames_with_hypotheses, online_file, references_of, report_of
from .tables import CASE, Cases

TRUTH_COLOR = "#333333"
CHECKED_COLOR = "#e69f00"  # orange, as in the paper
ACCEPTED_COLOR = "#009e73"  # green, as in the paper
REFUSED_COLOR = "#bbbbbb"
REFERENCE_COLORS = ["#000000", "#8c564b", "#7f7f00"]
PERCENT_DECIMALS = 3  # smaller differences are noise of the last digits
GAP = numpy.full((1, 2), math.nan)  # interrupts a line


class PartFigures:
    """Figures of one choice of objects and odometry. `cells` and `runs` (their figures) are those of the whole benchmark,
    row by row the same.
    """

    def __init__(self, part: Cases, cells: list[Cell], runs: pandas.DataFrame, programs: Programs) -> None:
        self.part = part[part["seeds"].map(len) > 0]
        self.odometry = part["odometry"].iloc[0]
        self.sequences = list(dict.fromkeys(part["sequence"]))
        self.cells = cells
        self.runs = runs
        self.programs = programs

    def case(self, sequence: str, method: str) -> pandas.Series | None:
        """None without figures."""
        found = self.part[(self.part["sequence"] == sequence) & (self.part["method"] == method)]
        return None if found.empty else found.iloc[0]

    def complete_runs(self, case: pandas.Series) -> pandas.DataFrame:
        is_member = self.runs["status"] == "ok"
        for key in [*CASE, "method"]:
            is_member &= self.runs[key] == case[key]
        return self.runs[is_member]

    def typical_cell(self, sequence: str, method: str) -> Cell | None:
        """The run whose aligned error is nearest to the median of the seeds, the first one of several."""
        case = self.case(sequence, method)
        if case is None:
            return None
        distances_m = (self.complete_runs(case)["se3_m"] - case["se3_m median"]).abs()
        return self.cells[distances_m.idxmin()]

    def all(self) -> list[Drawing]:
        """Errors over the frames of every sequence, then the maps of the full system."""
        errors, maps = [], []
        for sequence in self.sequences:
            typical = {method.name: self.typical_cell(sequence, method.name) for method in METHODS}
            typical = {name: cell for name, cell in typical.items() if cell is not None}
            if not typical:
                continue
            with tempfile.TemporaryDirectory() as folder:
                sequence_figures = SequenceFigures(typical, self.programs, Path(folder))
            errors.append(sequence_figures.errors())
            if FULL_SYSTEM in typical:
                maps.append(sequence_figures.map())
        return [*errors, *self.summary(), *maps]

    def summary(self) -> list[Drawing]:
        return [figure for figure in (self.hypotheses(), self.ablation()) if figure is not None]

    def hypotheses(self) -> Drawing | None:
        violins = []
        for method in ("mhm", FULL_SYSTEM):
            counts = [self.hypotheses_of(sequence, method) for sequence in self.sequences]
            if any(counts):
                violins.append(Members(method, COLORS[method], counts))
        return violin_plot(f"Hypotheses that live, over the frames: {self.odometry}", "hypotheses", self.sequences,
                             violins) if violins else None

    def hypotheses_of(self, sequence: str, method: str) -> dict[int, float]:
        """Frames by number of hypotheses, over the seeds."""
        case = self.case(sequence, method)
        frames: dict[int, float] = {}
        for row in [] if case is None else self.complete_runs(case).index:
            for hypotheses, count in frames_with_hypotheses(report_of(self.cells[row])).items():
                frames[hypotheses] = frames.get(hypotheses, 0.0) + count
        return frames

    def ablation(self) -> Drawing | None:
        """What classes and several hypotheses are worth; None without anything to compare."""
        bars = []
        for method in METHODS:
            cases = [self.case(sequence, method.name) for sequence in self.sequences]
            percents = [math.nan if case is None else round(case["reduction_se3_percent median"], PERCENT_DECIMALS)
                        for case in cases]
            if method.method == "dpmhm" and not numpy.isnan(percents).all():
                bars.append(Members(method.name, method.color, [*percents, float(numpy.nanmean(percents))]))
        return bar_plot(f"What classes and several hypotheses are worth: {self.odometry}",
                          "reduction of the SE3-aligned RMSE [%]", [*self.sequences, "mean"],
                          bars) if len(bars) > 1 else None


class SequenceFigures:
    """Figures of the typical runs of a sequence, by method; what they show is asked of `evaluate` at once."""

    def __init__(self, typical: dict[str, Cell], programs: Programs, folder: Path) -> None:
        self.typical = typical
        self.first = next(iter(typical.values()))
        self.dataset = self.first.dataset
        paths = {name: cell.folder / "trajectory.txt" for name, cell in typical.items()}
        online = online_file(typical[FULL_SYSTEM]) if FULL_SYSTEM in typical else None
        if online is not None:
            paths[f"{FULL_SYSTEM} live"] = online
        self.references = [path.stem for path in references_of(self.dataset)]
        paths.update({f"reference {path.stem}": path for path in references_of(self.dataset)})
        paths["the odometry"] = self.dataset / self.first.odometry_file
        self.frames = frame_errors(self.dataset / "poses.txt", paths, programs, folder)

    @property
    def title(self) -> str:
        return f"{self.first.sequence}, {self.first.odometry}, {self.first.objects_are} objects"

    def line(self, label: str, name: str, color: str, style: str = "-") -> Line:
        frames = self.frames[name].dropna()
        return Line(label, frames.index.to_numpy(), frames["running_rmse_m"].to_numpy(), color, style)

    def errors(self) -> Drawing:
        lines = []
        for name in self.typical:
            lines.append(self.line(name, name, COLORS[name]))
            if name == FULL_SYSTEM and f"{name} live" in self.frames:
                lines.append(self.line(f"{name} live", f"{name} live", COLORS[name], "--"))
        lines += [self.line(name, f"reference {name}", REFERENCE_COLORS[i % len(REFERENCE_COLORS)], "--")
                  for i, name in enumerate(self.references)]
        return line_plot(f"RMSE over the frames: {self.title}", "frame", "RMSE up to the frame, unaligned [m]", lines)

    def map(self) -> Drawing:
        """The full system's run from above, after a rigid alignment, with its loop closures."""
        cell = self.typical[FULL_SYSTEM]
        truth_m = numpy.loadtxt(self.dataset / "poses.txt", ndmin=2)[:, [3, 11]]
        odometry_m, estimate_m = (self.frames[name][["aligned_x_m", "aligned_z_m"]].to_numpy()
                                  for name in ("the odometry", FULL_SYSTEM))
        refused, accepted, closed = closure_lines(cell, estimate_m)
        lines = [path_line("refused", refused, REFUSED_COLOR), path_line("truth", truth_m, TRUTH_COLOR),
                 path_line("odometry", odometry_m, COLORS["odometry"], "--"),
                 path_line(FULL_SYSTEM, estimate_m, COLORS[FULL_SYSTEM]),
                 path_line("checked submap", checked_stretches(cell, estimate_m), CHECKED_COLOR),
                 path_line("loop closure", accepted, ACCEPTED_COLOR), path_line("", closed, ACCEPTED_COLOR, "o")]
        return line_plot(f"{self.title}, seed {cell.seed} (aligned)", "x [m]", "z [m]",
                           [line for line in lines if len(line.x)], is_map=True)


def path_line(label: str, points_m: numpy.ndarray, color: str, style: str = "-") -> Line:
    return Line(label, points_m[:, 0], points_m[:, 1], color, style)


def frame_errors(truth: Path, paths: dict[str, Path], programs: Programs, folder: Path) -> dict[str, pandas.DataFrame]:
    """Columns of trajectory_errors.csv of `evaluate trajectory`, without the names of the estimates, by the names of the
    paths; a row a frame, NaN where a trajectory has no pose.
    """
    options: list[object] = ["--truth", truth, "--output", folder]
    for path in paths.values():
        options += ["--estimate", path]
    programs.evaluate("trajectory", options)
    table = pandas.read_csv(folder / "trajectory_errors.csv", index_col="frame")
    width = len(table.columns) // len(paths)
    names = ["unaligned_m", "aligned_m", "running_rmse_m", "aligned_x_m", "aligned_y_m", "aligned_z_m"]
    return {name: table.iloc[:, i * width:(i + 1) * width].set_axis(names, axis=1) for i, name in enumerate(paths)}


def closure_lines(cell: Cell, positions_m: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """Refused and accepted loop closures as lines between their frames, and the ends of the accepted ones."""
    closures = pandas.read_csv(cell.folder / "loop_closures.csv")
    is_accepted = closures["accepted"].astype(str).str.lower().isin(["1", "true"]).to_numpy(dtype=bool)
    ends_m = positions_m[closures[["query_frame", "match_frame"]].to_numpy(dtype=int)]  # closures x 2 ends x 2 axes
    with_gaps_m = numpy.concatenate([ends_m, numpy.broadcast_to(GAP, (len(ends_m), 1, 2))], axis=1)
    return (with_gaps_m[~is_accepted].reshape(-1, 2), with_gaps_m[is_accepted].reshape(-1, 2),
            ends_m[is_accepted].reshape(-1, 2))


def checked_stretches(cell: Cell, positions_m: numpy.ndarray) -> numpy.ndarray:
    """The way through the submaps that were searched for loop closures."""
    submaps = pandas.read_csv(cell.folder / "submaps.csv")
    is_checked = submaps["checked"].astype(str).str.lower().isin(["1", "true"])
    ends = [*submaps["first_frame"].iloc[1:], len(positions_m)]
    stretches = [part for first, end, checked in zip(submaps["first_frame"], ends, is_checked) if checked
                 for part in (positions_m[first:end], GAP)]
    return numpy.concatenate(stretches) if stretches else numpy.empty((0, 2))
