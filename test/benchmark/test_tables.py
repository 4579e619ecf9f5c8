"""Figures over seeds and cases, the tables that show them, and what they say."""
import math

import pandas
import pytest
from semantic_mht_slam.benchmark.report import csv_text, rendered
from semantic_mht_slam.benchmark.statements import statements
from semantic_mht_slam.benchmark.tables import (Table, best_rows, number, parts_of, range_table, summarize_cases,
                              summarize_methods)

NAMES = ["se3_m", "running_mean_m", "raw_se3_m", "map_mb_per_km", "closures_accepted", "closures_wrong",
         "association_local_f1", "closures_recall"]


def make_run(sequence, method, seed, se3_m, **more):
    run = {"sequence": sequence, "odometry": "vo", "objects": "best", "objects_are": "real", "method": method,
           "seed": seed, "status": "ok", "se3_m": se3_m, "running_mean_m": 2.0 * se3_m, "raw_se3_m": 2.0,
           "map_mb_per_km": 0.25, "closures_accepted": 3.0, "closures_wrong": 0.0, "association_local_f1": math.nan,
           "closures_recall": math.nan}
    return {**run, **more}


def failed_run(sequence, method, seed):
    return {**make_run(sequence, method, seed, math.nan, status="failed: code 1"), **dict.fromkeys(NAMES, math.nan)}


def cases_of(*runs):
    return summarize_cases(pandas.DataFrame(runs), NAMES)


def statement_on(part, *runs):
    """The statement with `part` in its text."""
    table = pandas.DataFrame(runs)
    found = [statement for statement in statements(table, summarize_cases(table, NAMES)) if part in statement.text]
    assert len(found) == 1, f"{len(found)} statements on {part}"
    return found[0]


def test_cases_hold_the_median_and_the_range_of_the_seeds():
    cases = cases_of(make_run("00", "dpmhm", 1, 1.0), make_run("00", "ukf", 1, 9.0), make_run("00", "dpmhm", 2, 5.0),
                     make_run("00", "dpmhm", 3, 2.0))
    assert cases["method"].tolist() == ["dpmhm", "ukf"]
    first = cases.iloc[0]
    assert first["seeds"] == [1, 2, 3]
    assert [first[f"se3_m {name}"] for name in ("median", "min", "max")] == [2.0, 1.0, 5.0]


def test_failed_runs_are_counted_and_leave_the_figures_alone():
    runs = [make_run("00", "dpmhm", 1, 1.0), failed_run("00", "dpmhm", 2)]
    case = cases_of(*runs).iloc[0]
    assert (case["failed"], case["seeds"], case["se3_m median"]) == (1, [1], 1.0)
    assert not statement_on("1 of 2 runs FAILED", *runs).holds
    table = range_table(cases_of(*runs, failed_run("05", "dpmhm", 1)), "SE3", "se3_m", 2)
    assert table.rows == [["dpmhm", "1.00 (1 failed)", "failed"]]


def test_a_figure_that_is_undefined_in_one_run_is_the_median_of_the_others():
    assert cases_of(make_run("00", "dpmhm", 1, math.nan), make_run("00", "dpmhm", 2, 3.0))["se3_m median"].item() == 3.0


def test_method_means_weigh_every_sequence_alike_whatever_its_seeds():
    runs = pandas.DataFrame([make_run("00", "dpmhm", 1, 1.0), make_run("00", "dpmhm", 2, 1.0),
                             make_run("05", "dpmhm", 1, 4.0, closures_wrong=2.0)])
    method = summarize_methods(runs, summarize_cases(runs, NAMES), NAMES).iloc[0]
    assert (method["cases"], method["se3_m"], method["wrong_closures"]) == (2, 2.5, 2.0)


def test_tables_show_ranges_mark_the_best_and_name_what_is_compared():
    runs = [make_run("00", "ukf", 1, 4.0), make_run("00", "dpmhm", 1, 1.0), make_run("00", "dpmhm", 2, 2.0),
            make_run("05", "dpmhm", 1, 3.0)]
    table = range_table(cases_of(*runs), "SE3", "se3_m", 2)
    assert table.title == "SE3, objects best, odometry vo"
    assert table.header == ["method", "00 (real)", "05 (real)"]
    assert table.rows == [["ukf", "4.00", "-"], ["dpmhm", "1.50 [1.00, 2.00]", "3.00"]]
    assert table.best == {(1, 1), (1, 2)}


def test_parts_are_odometries_within_choices_of_objects():
    runs = [make_run("00", "ukf", 1, 1.0, odometry=odometry, objects=objects)
            for odometry in ("a", "b") for objects in ("best", "noisy")]
    parts = [(part["objects"].iloc[0], part["odometry"].iloc[0]) for part in parts_of(cases_of(*runs))]
    assert parts == [("best", "a"), ("best", "b"), ("noisy", "a"), ("noisy", "b")]


@pytest.mark.parametrize("losses, best", [([2.0, 1.0, 1.0], [1, 2]), ([1.0, 1.0], []), ([math.nan, 3.0], [1]),
                                          ([math.nan, math.nan], [])])
def test_the_best_is_marked_where_there_is_something_to_compare(losses, best):
    assert best_rows(losses) == best


def test_numbers_have_no_negative_zero_and_undefined_ones_are_a_dash():
    assert [number(-0.001, 2), number(-0.006, 2), number(math.nan, 1)] == ["0.00", "-0.01", "-"]


def test_markdown_keeps_its_columns():
    table = Table("a < b", ["method", "00"], [["x|y", "1.0"]], frozenset({(0, 1)}))
    text = rendered("results.md.jinja", command="c", origin="o", statements=[], tables=[table])
    assert text.endswith("\n**a < b**\n\n| method | 00 |\n|---|---|\n| x/y | **1.0** |\n")


def test_html_is_escaped_the_best_is_bold_and_statements_that_fail_look_different():
    table = Table("a < b", ["method"], [["1.0"]], frozenset({(0, 0)}))
    told = [statement_on("than ukf", make_run("00", "ukf", 1, ukf_m), make_run("00", "dpmhm", 1, 1.0)) for ukf_m in (2.0, 1.0)]
    html = rendered("report.html.jinja", command="<script>", origin="o", config="", statements=told,
                    method_tables=[table], methods=[], parts=[], jobs=1, measured_tables=[])
    for part in ("<caption>a &lt; b</caption>", "<td><b>1.0</b></td>", "&lt;script&gt;", 'class="holds">✓ objects best',
                 'class="fails">✗ objects best'):
        assert part in html
    assert "<script>" not in html


def test_csv_has_six_decimals_and_empty_cells_where_a_figure_is_not_defined():
    table = pandas.DataFrame([{"seed": 1, "why": "a, b", "x": 0.5, "y": math.nan, "z": -1e-9}])
    assert csv_text(table) == 'seed,why,x,y,z\n1,"a, b",0.500000,,0.000000\n'


def test_statements_tell_where_the_full_system_is_not_better():
    better = statement_on("than ukf", make_run("00", "ukf", 1, 4.0), make_run("00", "dpmhm", 1, 1.0),
                          make_run("05", "ukf", 1, 1.0), make_run("05", "dpmhm", 1, 2.0))
    assert better.holds
    assert "better in 1 of them, not in 05 vo" in better.text
    equal = statement_on("than mhm", make_run("00", "mhm", 1, 1.0), make_run("00", "dpmhm", 1, 1.0))
    assert not equal.holds
    assert "NOT better" in equal.text and "why" not in equal.text


@pytest.mark.parametrize("own, other, why", [
    ((0.7, 1.0), (0.8, 1.0), "its association is worse"), ((0.9, 0.5), (0.8, 1.0), "it closes fewer revisits"),
    ((0.9, 1.0), (0.8, 0.5), "the revisits that it closes more do not"), ((0.9, 1.0), (0.8, 1.0), "both close the same")])
def test_where_the_full_system_is_not_better_its_figures_say_why(own, other, why):
    runs = [make_run("05", method, 1, se3_m, association_local_f1=f1, closures_recall=recall)
            for method, se3_m, (f1, recall) in (("dpmhm", 1.0, own), ("mhm", 0.5, other))]
    text = statement_on("than mhm", *runs).text
    assert f"; why: association F1 {own[0]:.3f} against {other[0]:.3f}, revisits closed" in text
    assert text.rsplit(": ", 1)[1].startswith(why)


def test_only_cases_that_both_methods_have_are_compared():
    assert statement_on("than ukf", make_run("00", "ukf", 1, 4.0), make_run("00", "dpmhm", 1, 1.0),
                        make_run("05", "dpmhm", 1, 100.0)).holds


def test_a_run_worse_than_its_odometry_by_more_than_two_percent_is_named():
    assert statement_on("worse than its odometry", make_run("00", "dpmhm", 1, 2.03)).holds
    worse = statement_on("WORSE", make_run("00", "dpmhm", 1, 1.0), make_run("00", "dpmhm", 7, 2.05))
    assert not worse.holds
    assert "seed 7 (2.5 %)" in worse.text


def test_a_wrong_loop_closure_of_any_method_is_named():
    right = [make_run("00", "dpmhm", 1, 1.0), make_run("00", "mhm", 4, 1.0)]
    assert statement_on("6 loop closures accepted", *right).holds
    wrong = statement_on("WRONG", right[0], {**right[1], "closures_wrong": 1.0})
    assert not wrong.holds
    assert "mhm seed 4" in wrong.text


def test_large_maps_are_told():
    assert statement_on("largest map", make_run("00", "dpmhm", 1, 1.0)).holds
    assert not statement_on("largest map", make_run("00", "dpmhm", 1, 1.0, map_mb_per_km=1.5)).holds
