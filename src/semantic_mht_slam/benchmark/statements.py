"""What the benchmark is to show, and whether it does."""
from __future__ import annotations

import math
from dataclasses import dataclass

import pandas

from .cells import FULL_SYSTEM
from .tables import Cases

ALLOWED_LOSS = 0.02
MAP_MB_PER_KM = 1.0
NAMED_CASES = 12
SAME_RECALL = 0.005


@dataclass(frozen=True)
class Statement:
    holds: bool
    text: str


def first_of(names: list[str]) -> str:
    """ "a, b, c and 4 more"."""
    more = f" and {len(names) - NAMED_CASES} more" if len(names) > NAMED_CASES else ""
    return ", ".join(names[:NAMED_CASES]) + more


def run_name(run: pandas.Series) -> str:
    return f"{run['sequence']} {run['odometry']} {run['objects']} {run['method']} seed {run['seed']}"


def reason(pairs: pandas.DataFrame) -> str:
    """Where a better trajectory was lost: in the association, in the closures, or behind both."""
    figures = {name: pairs[[f"{name} median", f"{name} median other"]].dropna().mean()
               for name in ("association_local_f1", "closures_recall")}
    told = [f" {title} {own:.3f} against {other:.3f}" for title, (own, other) in zip(
        ("association F1", "revisits closed"), figures.values()) if math.isfinite(own)]
    if not told:
        return ""
    f1, recall = (0.0 if math.isnan(own) else own - other for own, other in figures.values())
    if f1 < 0.0:
        why = "its association is worse"
    elif recall < -SAME_RECALL:
        why = "it closes fewer revisits"
    elif recall > SAME_RECALL:
        why = "the revisits that it closes more do not lower the error"
    else:
        why = ("both close the same revisits by the same back end, whose robust loss and merged landmarks make up for what "
               "the other associates wrong")
    return f"; why:{','.join(told)}: {why}"


def compared(cases: Cases, objects: str, method: str) -> Statement | None:
    """The full system against another method, over the cases where both have figures; None without such cases."""
    complete = cases[(cases["objects"] == objects) & (cases["seeds"].map(len) > 0)]
    pairs = complete[complete["method"] == FULL_SYSTEM].merge(
        complete[complete["method"] == method], on=["sequence", "odometry"], suffixes=("", " other"))
    if pairs.empty:
        return None
    own, other = pairs["se3_m median"], pairs["se3_m median other"]
    holds = bool(own.mean() < other.mean())
    not_better = pairs[~(own < other)]
    text = (f"objects {objects}: {FULL_SYSTEM} is {'better than' if holds else 'NOT better than'} {method} in the mean of "
            f"{len(pairs)} sequences and odometries: SE3-aligned RMSE {own.mean():.3f} m against {other.mean():.3f} m "
            f"(running mean {pairs['running_mean_m median'].mean():.3f} m against "
            f"{pairs['running_mean_m median other'].mean():.3f} m); better in {len(pairs) - len(not_better)} of them")
    if not not_better.empty:
        text += ", not in " + first_of([f"{case['sequence']} {case['odometry']}" for _, case in not_better.iterrows()])
    return Statement(holds, text if holds else text + reason(pairs))


def never_worse_than_odometry(runs: pandas.DataFrame) -> Statement:
    own = runs[runs["method"] == FULL_SYSTEM]
    own = own.assign(loss=own["se3_m"] / own["raw_se3_m"] - 1.0).dropna(subset=["loss"])
    worse = own[own["loss"] > ALLOWED_LOSS]
    all_runs = f"{len(own)} runs of {FULL_SYSTEM}"
    if worse.empty:
        worst = 100.0 * own["loss"].max() if len(own) else math.nan
        return Statement(True, f"none of {all_runs} is worse than its odometry by more than 2 % (SE3-aligned RMSE; worst "
                               f"change {worst:.1f} %)")
    names = [f"{run['sequence']} {run['odometry']} {run['objects']} seed {run['seed']} ({100.0 * run['loss']:.1f} %)"
             for _, run in worse.iterrows()]
    return Statement(False, f"{len(worse)} of {all_runs} are WORSE than their odometry by more than 2 % (SE3-aligned RMSE): "
                            + first_of(names))


def small_maps(runs: pandas.DataFrame) -> Statement | None:
    """None if no map has a size."""
    own = runs[(runs["method"] == FULL_SYSTEM) & (runs["map_mb_per_km"] > 0.0)]
    if own.empty:
        return None
    largest = own.loc[own["map_mb_per_km"].idxmax()]
    holds = bool(largest["map_mb_per_km"] < MAP_MB_PER_KM)
    return Statement(holds, f"the largest map of {FULL_SYSTEM} takes {largest['map_mb_per_km']:.2f} MB per km of driving "
                            f"({largest['sequence']} {largest['odometry']} {largest['objects']}), "
                            + ("less than 1" if holds else "MORE than 1"))


def no_wrong_closure(runs: pandas.DataFrame) -> Statement:
    accepted = runs["closures_accepted"].sum()
    with_wrong = runs[runs["closures_wrong"] > 0.0]
    if accepted == 0.0:
        return Statement(True, "no loop closure was accepted in any run")
    text = f"{accepted:.0f} loop closures accepted in all runs, "
    if with_wrong.empty:
        return Statement(True, text + "none of them wrong")
    names = [run_name(run) for _, run in with_wrong.iterrows()]
    return Statement(False, f"{text}{with_wrong['closures_wrong'].sum():.0f} of them WRONG: {first_of(names)}")


def statements(runs: pandas.DataFrame, cases: Cases) -> list[Statement]:
    """Whether the full system is better than each other method in the mean over sequences and odometries (SE3-aligned RMSE,
    median of the seeds), whether it is ever worse than its odometry by more than 2 %, how large its maps are, whether a
    loop closure was wrong and whether a run failed. Statements about methods that were not run are left out.
    """
    result = [compared(cases, objects, method) for objects, method in dict.fromkeys(zip(cases["objects"], cases["method"]))
              if method != FULL_SYSTEM]
    if (runs["method"] == FULL_SYSTEM).any():
        result += [never_worse_than_odometry(runs), small_maps(runs)]
    result.append(no_wrong_closure(runs))
    failed = int((runs["status"] != "ok").sum())
    if failed:
        result.append(Statement(False, f"{failed} of {len(runs)} runs FAILED"))
    return [statement for statement in result if statement is not None]
