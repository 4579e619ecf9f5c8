"""The output files of the benchmark: results.csv, results.json, results.md, times.csv, config.yaml, report.html."""
from __future__ import annotations

import base64
import json
import math
from dataclasses import dataclass
from pathlib import Path

import jinja2
import pandas

from .cells import METHODS, Cell, Request
from .figures import PartFigures
from .files import write_file
from .programs import Programs
from .scores import FIGURES, MEASURED, TRAJECTORY, measured_of
from .statements import Statement, statements
from .tables import Cases, measured_tables, method_tables, parts_of, summarize_cases, summarize_methods, tables_of_part


@dataclass
class Result:
    """Everything that the report tells."""

    request: Request
    cells: list[Cell]
    statuses: list[str]  # of the cells: "ok" or why there are no figures
    figures: list[dict[str, float]]  # of the cells; empty for a failed one
    references: list[dict]  # systems to compare with: sequence, name, figures
    programs: Programs
    program: str  # hash of the program that made the runs
    config: str  # effective parameters of the full system, YAML


def table_of_runs(result: Result, figures: list[dict[str, float]], names: list[str]) -> pandas.DataFrame:
    """A row a cell: what it was, its status and its figures; NaN where one is not defined."""
    rows = [{"sequence": cell.sequence, "odometry": cell.odometry, "objects": cell.objects,
             "objects_are": cell.objects_are, "method": cell.method.name, "seed": cell.seed, "status": status,
             **{name: float(values.get(name, math.nan)) for name in names}}
            for cell, status, values in zip(result.cells, result.statuses, figures)]
    return pandas.DataFrame(rows)


def times_of(result: Result) -> pandas.DataFrame:
    measured = [measured_of(cell) if status == "ok" else {} for cell, status in zip(result.cells, result.statuses)]
    return table_of_runs(result, measured, list(MEASURED))


def csv_text(table: pandas.DataFrame) -> str:
    """Six decimals, without a minus before zero; empty cells where a figure is not defined."""
    figures = table.select_dtypes("float")
    return table.assign(**(figures.round(6) + 0.0)).to_csv(index=False, float_format="%.6f")


def defined(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def results_json(result: Result, origin: dict, told: list[Statement], methods: pandas.DataFrame, cases: Cases) -> str:
    content = {
        **origin,
        "statements": [{"holds": statement.holds, "text": statement.text} for statement in told],
        "methods": [{"objects": row["objects"], "method": row["method"], "cases": int(row["cases"]),
                     "wrong_closures": float(row["wrong_closures"]),
                     "means": {name: defined(row[name]) for name in FIGURES}} for _, row in methods.iterrows()],
        "cases": [{"sequence": case["sequence"], "odometry": case["odometry"], "objects": case["objects"],
                   "objects_are": case["objects_are"], "method": case["method"], "seeds": case["seeds"],
                   "failed": int(case["failed"]),
                   "figures": {name: {kind: defined(case[f"{name} {kind}"]) for kind in ("median", "min", "max")}
                               for name in FIGURES}} for _, case in cases.iterrows()],
        "references": [{**reference, "figures": {name: defined(reference["figures"][name]) for name in TRAJECTORY}}
                       for reference in result.references]}
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def data_uri(svg: str) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()


def rendered(template: str, **values: object) -> str:
    """A template of this folder, in HTML with everything escaped."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(Path(__file__).parent)), undefined=jinja2.StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True, autoescape=template.endswith(".html.jinja"))
    environment.filters["data_uri"] = data_uri
    return environment.get_template(template).render(values)


def write_report(result: Result) -> list[Statement]:
    """Writes the files to the output folder. Only times.csv, and in report.html what stands between the comments "measured
    begin" and "measured end", differ between two benchmarks of the same program with the same input. Returns what they
    show. Raises OSError and InputError.
    """
    runs = table_of_runs(result, result.figures, FIGURES)
    times = times_of(result)
    cases = summarize_cases(runs, FIGURES)
    methods = summarize_methods(runs, cases, FIGURES)
    told = statements(runs, cases)
    origin = {"git_revision": result.programs.revision(), "program": result.program, "command": result.request.command()}
    parts = [{"objects": part["objects"].iloc[0], "odometry": part["odometry"].iloc[0],
              "tables": tables_of_part(part, result.references),
              "figures": PartFigures(part, result.cells, runs, result.programs).all()} for part in parts_of(cases)]
    shared = {"origin": f"git revision {origin['git_revision']}, program {result.program}", "command": origin["command"],
              "statements": told}
    tables = method_tables(methods) + [table for part in parts for group in part["tables"] for table in group]
    contents = {
        "results.csv": csv_text(runs), "times.csv": csv_text(times), "config.yaml": result.config,
        "results.json": results_json(result, origin, told, methods, cases),
        "results.md": rendered("results.md.jinja", **shared, tables=tables),
        "report.html": rendered("report.html.jinja", **shared, config=result.config, methods=METHODS, parts=parts,
                                method_tables=method_tables(methods), jobs=result.request.jobs,
                                measured_tables=measured_tables(times))}
    for name, content in contents.items():
        write_file(result.request.output / name, content)
    return told
