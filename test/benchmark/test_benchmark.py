"""The program `benchmark` on a short simulated drive."""
import base64
import re
import shutil
import xml.etree.ElementTree as ElementTree

import pandas
import pytest
from semantic_mht_slam.benchmark.main import main
from conftest import program_folder, results, run, run_folder, unmeasured

ODOMETRY = ("--odometries", "odometry")
CLOSURES = "query_frame,match_frame,accepted,score,inliers,tx,ty,tz,qx,qy,qz,qw,submap\n"


def copy_of(small, name):
    copy = small.folder / name
    shutil.copytree(small.output, copy)
    return copy


def test_every_run_is_one_row_and_the_objects_are_called_what_they_are(small):
    runs = results(small.output)
    assert list(zip(runs["method"], runs["seed"])) == [("ukf", 1), ("ukf", 2), ("dpmhm", 1), ("dpmhm", 2)]
    assert set(runs["status"]) == {"ok"}
    assert set(runs["objects_are"]) == {"simulated"}
    assert (runs["se3_m"] > 0.0).all()
    assert runs["association_local_f1"].iloc[3] > 0.8
    assert len(pandas.read_csv(small.output / "times.csv")) == 4


def test_figures_are_those_of_evaluate(small):
    runs = results(small.output)
    folder = run_folder(small.output, "dpmhm", 2)
    answer = run(program_folder() / "evaluate", "trajectory", "--truth", small.data / "town/poses.txt", "--estimate",
                 folder / "trajectory.txt", "--json")
    told = float(re.search('"se3_m": ([0-9.e-]+)', answer.stdout).group(1))
    assert runs["se3_m"].iloc[3] == pytest.approx(told, abs=1e-6)
    reduction = 100.0 * (1.0 - runs["se3_m"] / runs["raw_se3_m"])
    assert runs["reduction_se3_percent"].to_numpy() == pytest.approx(reduction.to_numpy(), abs=1e-3)


def test_a_trajectory_with_stamps_is_scored_where_it_has_poses(small, tmp_path):
    lines = (run_folder(small.output, "dpmhm", 1) / "trajectory.tum").read_text().splitlines(True)
    (tmp_path / "half.tum").write_text("".join(lines[::2]))
    (tmp_path / "other.tum").write_text("1e6 0 0 0 0 0 0 1\n")
    arguments = ("trajectory", "--truth", small.data / "town/poses.txt", "--json", "--estimate")
    answer = run(program_folder() / "evaluate", *arguments, tmp_path / "half.tum", "--output", tmp_path)
    assert f'"frames": {len(lines[::2])}' in answer.stdout
    errors = pandas.read_csv(tmp_path / "trajectory_errors.csv")
    assert errors["half_aligned_x_m"].isna().tolist() == [bool(i % 2) for i in range(len(lines))]
    refused = run(program_folder() / "evaluate", *arguments, tmp_path / "other.tum")
    assert refused.returncode == 1 and "none of its stamps" in refused.stdout


def test_the_report_is_one_file_and_well_formed(small):
    html = (small.output / "report.html").read_text()
    for part in ("href=", "url(", "@import", "<script"):
        assert part not in html
    images = re.findall('src="([^"]*)"', html)
    assert len(images) == 3  # errors over the frames, hypotheses, a map; nothing to compare in an ablation
    prefix = "data:image/svg+xml;base64,"
    for image in images:
        assert image.startswith(prefix)
        svg = base64.b64decode(image[len(prefix):]).decode()
        ElementTree.fromstring(svg)
        assert not re.search(r'(href="(?!#)|url\((?!#))', svg)
    for text in ("RMSE over the frames: town", "Hypotheses that live", "dpmhm is ", "max_hypotheses: "):
        assert text in html
    ElementTree.fromstring(html)


def test_another_benchmark_with_another_number_of_jobs_writes_the_same_bytes(small):
    again = small.folder / "again"
    assert small.run(again, *ODOMETRY, "--jobs", "1").returncode == 0
    for name in ("results.csv", "results.json", "results.md", "config.yaml"):
        assert (small.output / name).read_bytes() == (again / name).read_bytes(), name
    assert unmeasured(small.output) == unmeasured(again)


def test_only_runs_that_are_missing_or_of_another_configuration_are_made(small):
    copy = copy_of(small, "resumed")
    assert "0 runs made, 4 found complete" in small.run(copy, *ODOMETRY).stdout
    (run_folder(copy, "dpmhm", 2) / "report.json").unlink()
    assert "1 runs made, 3 found complete" in small.run(copy, *ODOMETRY).stdout
    assert (copy / "results.json").read_bytes() == (small.output / "results.json").read_bytes()
    changed = small.run(copy, *ODOMETRY, "--set", "max_hypotheses=7")
    assert "4 runs made, 0 found complete" in changed.stdout
    assert "max_hypotheses: 7" in (copy / "config.yaml").read_text()


def test_a_run_on_other_input_is_made_again(small):
    copy = copy_of(small, "other_input")
    objects = small.data / "town/objects.csv"
    content = objects.read_text()
    objects.write_text("\n".join(content.splitlines()[:-1]) + "\n")
    try:
        assert "4 runs made, 0 found complete" in small.run(copy, *ODOMETRY).stdout
    finally:
        objects.write_text(content)


def test_a_run_that_fails_is_told_and_does_not_stop_the_others(small):
    broken = small.data / "town/odometry/broken.txt"
    broken.write_text("".join((small.data / "town/odometry/odometry.txt").read_text().splitlines(True)[1:]))
    output = small.folder / "failing"
    try:
        result = small.run(output)
    finally:
        broken.unlink()
    assert result.returncode == 1
    assert "town broken objects dpmhm seed 2 failed, code 1: slam_offline: " in result.stdout
    assert "8 runs made, 0 found complete, 4 failed" in result.stdout
    runs = results(output)
    assert runs["status"].iloc[0].startswith("failed: code 1: slam_offline: ")
    assert runs["se3_m"].isna().tolist() == [True] * 4 + [False] * 4
    assert runs["status"].tolist()[4:] == ["ok"] * 4
    assert "4 of 8 runs FAILED" in (output / "report.html").read_text()


def test_live_estimate_and_loop_closures_are_scored(small):
    copy = copy_of(small, "scored")
    folder = run_folder(copy, "dpmhm", 2)
    shutil.copy(folder / "trajectory.tum", folder / "trajectory_online.tum")
    (folder / "loop_closures.csv").write_text(
        CLOSURES + "300,300,1,0.5,9,0,0,0,0,0,0,1,3\n300,300,1,0.5,9,5,0,0,0,0,0,1,3\n300,20,0,0.1,0,,,,,,,,1\n")
    result = small.run(copy, *ODOMETRY)
    assert "4 found complete, 0 failed" in result.stdout
    assert "1 of them WRONG: town odometry best dpmhm seed 2" in result.stdout
    last = results(copy).iloc[3]
    for name in ("se3_m", "running_mean_m"):
        assert last[f"online_{name}"] == pytest.approx(last[name], abs=1e-4)
    assert (last["closures_checked"], last["closures_accepted"], last["closures_precision"]) == (3.0, 2.0, 0.5)


def test_a_result_that_cannot_be_scored_is_a_failure_of_its_run_only(small):
    copy = copy_of(small, "unscorable")
    (run_folder(copy, "ukf", 1) / "loop_closures.csv").write_text(
        "query_frame,match_frame,accepted,tx,ty,tz\n300,-1,0,,,\n")
    result = small.run(copy, *ODOMETRY)
    assert result.returncode == 1
    assert "ukf seed 1 cannot be scored: " in result.stdout
    assert "4 found complete, 1 failed" in result.stdout
    assert results(copy)["status"].iloc[1] == "ok"


@pytest.mark.parametrize("option, part", [
    ("--sequences none", "none"), ("--odometries none", "none.txt"), ("--objects noisy", "objects_noisy.csv"),
    ("--objects best,best", "twice"), ("--jobs 0", "--jobs 0"), ("--jobs many", "--jobs"), ("--set no.such=1", "no.such"),
    ("--config /no/such.yaml", "no/such"), ("--methods magic", "--methods magic"), ("--seeds 5-1", "--seeds 5-1"),
    ("--seeds x", "--seeds x"), ("--seeds 1,,2", "--seeds 1,,2"), ("--job 1", "--job")])
def test_bad_options_are_refused_before_anything_runs(small, option, part, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", [str(program_folder() / "benchmark")])
    monkeypatch.setattr("signal.signal", lambda *_: None)
    nothing = small.folder / "nothing"
    assert main(["--data", str(small.data), "--output", str(nothing), *option.split(" ")]) == 1
    told = capsys.readouterr().err
    assert all(line.startswith("benchmark: ") for line in told.splitlines()), told
    assert part in told
    assert not nothing.exists()


def test_help_names_every_method_and_evaluate_names_the_program():
    answer = run(program_folder() / "benchmark", "--help")
    assert answer.returncode == 0
    for method in ("odometry", "ukf", "mhm", "dpmhm", "no_semantics", "single_hypothesis", "neither"):
        assert f"  {method} " in answer.stdout
    refused = run(program_folder() / "evaluate", "benchmark", "--data", "x")
    assert refused.returncode == 1
    assert "rosrun semantic_mht_slam benchmark" in refused.stdout


def test_hypotheses_of_single_runs_are_drawn(small):
    figure = small.folder / "violins.svg"
    report = run_folder(small.output, "ukf", 1) / "report.json"
    answer = run(program_folder() / "benchmark", "hypotheses", f"one={report}", "--output", figure)
    assert answer.stdout == "one 1.00\n"
    assert ">one</text>" in figure.read_text()
    refused = run(program_folder() / "benchmark", "hypotheses", f"one={figure}", "--output", figure)
    assert refused.returncode == 1 and str(figure) in refused.stdout
