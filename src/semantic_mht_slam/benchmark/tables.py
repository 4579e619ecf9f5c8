"""Figures over the seeds and over the cases, and the tables of the report."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable

import pandas

CASE = ["sequence", "odometry", "objects"]
NO_FIGURE = "-"

# What `tables_of_part` and the statements work on: a row a case and method in the order of their first appearance, with
# the columns CASE, objects_are, method, seeds (with figures), failed (runs without), and for each figure its median, min
# and max over the seeds where it is defined.
Cases = pandas.DataFrame
Text = Callable[[pandas.Series], str]


@dataclass(frozen=True)
class Table:
    title: str
    header: list[str]
    rows: list[list[str]]
    best: frozenset[tuple[int, int]] = frozenset()  # row and column of the best cells


def summarize_cases(runs: pandas.DataFrame, figures: list[str]) -> Cases:
    """The runs (columns CASE, objects_are, method, seed, status and the figures; NaN: not defined), by everything but
    their seed.
    """
    is_ok = runs["status"] == "ok"
    groups = runs.assign(failed=~is_ok, ok_seed=runs["seed"].where(is_ok)).groupby([*CASE, "method"], sort=False)
    summary = groups[figures].agg(["median", "min", "max"])
    summary.columns = [f"{figure} {name}" for figure, name in summary.columns]
    seeds = groups["ok_seed"].apply(lambda seeds: [int(seed) for seed in seeds.dropna()])
    return pandas.concat([groups["objects_are"].first(), seeds.rename("seeds"), groups["failed"].sum(), summary],
                         axis=1).reset_index()


def summarize_methods(runs: pandas.DataFrame, cases: Cases, figures: list[str]) -> pandas.DataFrame:
    """A row an objects and method: objects, method, cases (with figures), wrong_closures (of all runs), and for each figure
    the mean of the cases' medians, where it is defined.
    """
    complete = cases[cases["seeds"].map(len) > 0]
    wrong = runs.groupby(["objects", "method"])["closures_wrong"].sum()
    rows = []
    for objects, method in dict.fromkeys(zip(cases["objects"], cases["method"])):
        own = complete[(complete["objects"] == objects) & (complete["method"] == method)]
        rows.append({"objects": objects, "method": method, "cases": len(own), "wrong_closures": wrong[objects, method],
                     **{figure: own[f"{figure} median"].mean() for figure in figures}})
    return pandas.DataFrame(rows)


def number(value: float, decimals: int) -> str:
    if not math.isfinite(value):
        return NO_FIGURE
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def median_text(case: pandas.Series, figure: str, decimals: int) -> str:
    return number(case[f"{figure} median"], decimals)


def range_text(case: pandas.Series, figure: str, decimals: int) -> str:
    """Median of the seeds, with the smallest and the largest if they differ."""
    middle, low, high = (number(case[f"{figure} {name}"], decimals) for name in ("median", "min", "max"))
    return middle if low == high else f"{middle} [{low}, {high}]"


def case_text(case: pandas.Series, text: Text) -> str:
    if not case["seeds"]:
        return "failed"
    return text(case) + (f" ({case['failed']} failed)" if case["failed"] else "")


def best_rows(losses: list[float]) -> list[int]:
    """Places of the smallest one; none if there is nothing to compare."""
    comparable = [loss if math.isfinite(loss) else math.inf for loss in losses]
    best = min(comparable)
    return [] if math.isinf(best) or best == max(comparable) else [i for i, loss in enumerate(comparable) if loss == best]


def part_table(part: Cases, title: str, text: Text, figure: str = "", sign: float = 1.0, has_mean: bool = False) -> Table:
    """A table of the cases of one odometry and choice of objects: rows are methods, columns sequences. The smallest
    `sign` * `figure` of a column is the best; a last column has the mean of `figure` if that is wanted.
    """
    first = part.iloc[0]
    header, best = ["method"], set()
    methods = list(dict.fromkeys(part["method"]))
    rows = [[method] for method in methods]
    for column, sequence in enumerate(dict.fromkeys(part["sequence"]), 1):
        of_sequence = part[part["sequence"] == sequence].set_index("method")
        header.append(f"{sequence} ({of_sequence['objects_are'].iloc[-1]})")
        losses = []
        for row, method in zip(rows, methods):
            is_there = method in of_sequence.index
            row.append(case_text(of_sequence.loc[method], text) if is_there else NO_FIGURE)
            losses.append(sign * of_sequence.loc[method, f"{figure} median"] if is_there and figure else math.nan)
        best.update((row, column) for row in best_rows(losses))
    if has_mean:
        header.append("mean")
        for row in rows:
            row.append(number(part.loc[part["method"] == row[0], f"{figure} median"].mean(), 1))
    return Table(f"{title}, objects {first['objects']}, odometry {first['odometry']}", header, rows, frozenset(best))


def range_table(part: Cases, title: str, figure: str, decimals: int, sign: float = 1.0, has_mean: bool = False) -> Table:
    return part_table(part, title, lambda case: range_text(case, figure, decimals), figure, sign, has_mean)


def with_references(table: Table, part: Cases, references: list[dict], text: Callable[[dict], str]) -> Table:
    """The table with a row for each system to compare with."""
    known = {(reference["name"], reference["sequence"]): reference["figures"] for reference in references}
    rows = [[f"{name} (to compare)", *(text(known[name, sequence]) if (name, sequence) in known else NO_FIGURE
                                       for sequence in dict.fromkeys(part["sequence"]))]
            for name in dict.fromkeys(reference["name"] for reference in references)]
    return Table(table.title, table.header, table.rows + rows, table.best)


def error_tables(part: Cases, references: list[dict]) -> list[Table]:
    running = part_table(part, "Running RMSE, mean ± std, unaligned [m]", lambda case: " ± ".join(
        median_text(case, figure, 2) for figure in ("running_mean_m", "running_std_m")), "running_mean_m")
    tables = [with_references(running, part, references, lambda figures: " ± ".join(
        number(figures[figure], 2) for figure in ("running_mean_m", "running_std_m")))]
    for title, figure in (("SE3-aligned RMSE [m]", "se3_m"), ("t_rel [%]", "t_rel_percent")):
        tables.append(with_references(range_table(part, title, figure, 2), part, references,
                                      lambda figures, figure=figure: number(figures[figure], 2)))
    return tables


def reduction_tables(part: Cases) -> list[Table]:
    return [range_table(part, f"Reduction of the {name} against the odometry [%]", figure, 1, -1.0, has_mean=True)
            for name, figure in (("SE3-aligned RMSE", "reduction_se3_percent"),
                                 ("running mean", "reduction_running_percent"))]


def closures_text(case: pandas.Series) -> str:
    accepted, checked = (median_text(case, f"closures_{name}", 0) for name in ("accepted", "checked"))
    return (f"{accepted} of {checked}, wrong {number(case['closures_wrong max'], 0)}, "
            f"recall {median_text(case, 'closures_recall', 2)}")


def map_text(case: pandas.Series) -> str:
    landmarks, mb_per_km, mean, largest = (median_text(case, *figure) for figure in (
        ("landmarks", 0), ("map_mb_per_km", 2), ("hypotheses_mean", 1), ("hypotheses_max", 0)))
    return f"{landmarks}, {mb_per_km}, {mean} / {largest}"


def cause_tables(part: Cases) -> list[Table]:
    """What the errors come from: live estimate, loop closures, associations, maps. Left out where no run has them."""
    tables = []
    if (part["online_se3_m max"] > 0.0).any():
        tables += [range_table(part, "Live estimate, SE3-aligned RMSE [m]", "online_se3_m", 2),
                   range_table(part, "Live estimate, running mean [m]", "online_running_mean_m", 2)]
    if (part["closures_checked max"] > 0.0).any():
        tables.append(part_table(part, "Loop closures accepted of checked, wrong (worst seed), recall of revisits",
                                 closures_text))
    if (part["association_local_f1 max"] > 0.0).any():
        tables += [range_table(part, "Association F1 within 300 frames", "association_local_f1", 3, -1.0),
                   range_table(part, "Association F1, all pairs", "association_all_f1", 3, -1.0)]
    return tables + [part_table(part, "Landmarks, map MB/km, hypotheses mean / max", map_text)]


def parts_of(cases: Cases) -> list[Cases]:
    """The cases of each choice of objects and odometry: what one set of tables and plots is about."""
    return [part for objects in dict.fromkeys(cases["objects"])
            for _, part in cases[cases["objects"] == objects].groupby("odometry", sort=False)]


def tables_of_part(part: Cases, references: list[dict]) -> list[list[Table]]:
    """In groups that belong side by side."""
    return [error_tables(part, references), reduction_tables(part), cause_tables(part)]


METHOD_COLUMNS = [("SE3 RMSE [m]", "se3_m", 3), ("reduction [%]", "reduction_se3_percent", 1),
                  ("running mean [m]", "running_mean_m", 3), ("reduction [%]", "reduction_running_percent", 1),
                  ("t_rel [%]", "t_rel_percent", 3), ("live SE3 RMSE [m]", "online_se3_m", 3),
                  ("association F1 (local)", "association_local_f1", 3), ("hypotheses", "hypotheses_mean", 2)]


def method_tables(methods: pandas.DataFrame) -> list[Table]:
    """A row a method: means over sequences and odometries; a table a choice of objects."""
    header = ["method", "cases", *(title for title, _, _ in METHOD_COLUMNS), "wrong closures"]
    return [Table(f"Means over sequences and odometries, objects {objects}", header,
                  [[row["method"], str(row["cases"]), *(number(row[figure], decimals)
                                                        for _, figure, decimals in METHOD_COLUMNS),
                    number(row["wrong_closures"], 0)] for _, row in of_objects.iterrows()])
            for objects, of_objects in methods.groupby("objects", sort=False)]


MEASURED_COLUMNS = [("seconds", "seconds", 2), ("ms a frame", "ms_mean", 3), ("99 % of the frames, ms", "ms_p99", 2),
                    ("slowest frame, ms", "ms_max", 1), ("mapping, ms a frame", "mapping_ms_mean", 3),
                    ("99 % of the frames, ms", "mapping_ms_p99", 2), ("peak memory, MB", "peak_rss_mb", 0)]


def measured_tables(times: pandas.DataFrame) -> list[Table]:
    """Times and memory: a row a method, a table a sequence."""
    tables = []
    complete = times[times["status"] == "ok"]
    for sequence, of_sequence in complete.groupby("sequence", sort=False):
        rows = []
        for method, of_method in of_sequence.groupby("method", sort=False):
            rows.append([method, *(f"{number(of_method[figure].quantile(0.5, 'higher'), decimals)} / "
                                   f"{number(of_method[figure].max(), decimals)}"
                                   for _, figure, decimals in MEASURED_COLUMNS)])
        tables.append(Table(f"Sequence {sequence}, all odometries and objects: median / largest of the runs",
                            ["method", *(title for title, _, _ in MEASURED_COLUMNS)], rows))
    return tables
