"""Figures of the report, as SVG text; the same numbers give the same text."""
from __future__ import annotations

import io
import math
from dataclasses import dataclass
from typing import Callable

import matplotlib
import numpy
from matplotlib.axes import Axes
from matplotlib.figure import Figure

STYLE = {"svg.hashsalt": "benchmark", "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 9.0,
         "path.simplify_threshold": 0.5, "axes.grid": True, "axes.axisbelow": True, "grid.color": "#dddddd",
         "lines.linewidth": 1.2, "figure.figsize": (9.0, 5.6), "figure.dpi": 72.0}
SMOOTHING = 0.35  # standard deviation of the kernel: counts that differ by one become one shape
REACH = 3.0  # of a violin beyond its outermost counts, in standard deviations
MEMBERS_WIDTH = 0.8  # of what stands side by side in a category, of the distance between categories
MEAN_COLOR = "#000000"


@dataclass(frozen=True)
class Drawing:
    title: str
    svg: str


@dataclass(frozen=True)
class Line:
    """A curve; values that are not finite interrupt it."""

    label: str  # "" is not in the legend
    x: numpy.ndarray
    y: numpy.ndarray
    color: str
    style: str = "-"  # as matplotlib has it; "o": dots


@dataclass(frozen=True)
class Members:
    """What belongs together in a figure by categories: for each category a number (NaN: none), or how often each number
    occurred (empty: none).
    """

    label: str
    color: str
    values: list


def drawn(title: str, draw: Callable[[Axes], None], x_label: str, y_label: str,
          categories: list[str] | None = None) -> Drawing:
    """What `draw` draws into axes, with a legend to their right; categories stand in place of numbers below."""
    with matplotlib.rc_context(STYLE):
        figure = Figure()
        axes = figure.subplots()
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        draw(axes)
        if categories is not None:
            axes.set_xticks(range(len(categories)))
            axes.set_xticklabels(categories)
            axes.grid(False, axis="x")
        if axes.get_legend_handles_labels()[1]:
            axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
        content = io.StringIO()
        figure.savefig(content, format="svg", bbox_inches="tight", metadata={"Date": None})
    return Drawing(title, content.getvalue())


def line_plot(title: str, x_label: str, y_label: str, lines: list[Line], is_map: bool = False) -> Drawing:
    """Curves over numbers from 0 on; in a map both axes have one scale."""
    return drawn(title, lambda axes: draw_lines(axes, lines, is_map), x_label, y_label)


def draw_lines(axes: Axes, lines: list[Line], is_map: bool) -> None:
    for line in lines:
        style = {"linestyle": "", "marker": "o", "markersize": 2.5} if line.style == "o" else {"linestyle": line.style}
        axes.plot(line.x, line.y, color=line.color, label=line.label or None, **style)
    if is_map:
        axes.set_aspect("equal", adjustable="datalim")
    else:
        axes.set_ylim(bottom=0.0)


def places(member: int, members: int, categories: int) -> tuple[numpy.ndarray, float]:
    """Where a member stands in each category, and the width that it has there."""
    share = MEMBERS_WIDTH / members
    return numpy.arange(categories) + (member + 0.5) * share - 0.5 * MEMBERS_WIDTH, 0.9 * share


def bar_plot(title: str, y_label: str, categories: list[str], bars: list[Members]) -> Drawing:
    """Bars from 0, side by side in each category."""
    return drawn(title, lambda axes: draw_bars(axes, bars), "", y_label, categories)


def draw_bars(axes: Axes, bars: list[Members]) -> None:
    for i, bar in enumerate(bars):
        values = numpy.array(bar.values)
        middles, width = places(i, len(bars), len(values))
        is_there = numpy.isfinite(values)
        axes.bar(middles[is_there], values[is_there], width, color=bar.color, alpha=0.8, label=bar.label)
    axes.axhline(0.0, color="#333333", linewidth=0.8)


def violin_shape(counts: dict[int, float]) -> dict:
    """The smoothed histogram as matplotlib's `violin` takes it."""
    numbers = numpy.array(sorted(counts), dtype=float)
    frames = numpy.array([counts[int(value)] for value in numbers])
    low, high = numbers[0] - REACH * SMOOTHING, numbers[-1] + REACH * SMOOTHING
    coordinates = numpy.linspace(low, high, 1 + math.ceil(10.0 * (high - low)))
    kernel = numpy.exp(-0.5 * ((coordinates[:, None] - numbers) / SMOOTHING) ** 2)
    return {"coords": coordinates, "vals": kernel @ frames, "mean": float(numbers @ frames / frames.sum()),
            "median": math.nan, "min": numbers[0], "max": numbers[-1]}


def violin_plot(title: str, y_label: str, categories: list[str], violins: list[Members]) -> Drawing:
    """Distributions side by side in each category, as wide for each at its most frequent number, with a line at the mean,
    as Bernreiter et al. (RA-L 2019) show numbers of hypotheses.
    """
    return drawn(title, lambda axes: draw_violins(axes, violins), "", y_label, categories)


def draw_violins(axes: Axes, violins: list[Members]) -> None:
    for i, violin in enumerate(violins):
        middles, width = places(i, len(violins), len(violin.values))
        shapes = [(middle, violin_shape(counts)) for middle, counts in zip(middles, violin.values) if counts]
        parts = axes.violin([shape for _, shape in shapes], [middle for middle, _ in shapes], widths=width,
                            showmeans=True, showextrema=False)
        for body in parts["bodies"]:
            body.set(facecolor=violin.color, edgecolor=violin.color, alpha=0.7)
        parts["cmeans"].set(color=MEAN_COLOR, linewidth=1.0)
        axes.plot([], [], color=violin.color, alpha=0.7, linewidth=6.0, label=violin.label)  # for the legend
    axes.plot([], [], color=MEAN_COLOR, linewidth=1.0, label="mean")
    axes.set_ylim(bottom=0.0)
