"""scripts/fill_kitti_page.py on a benchmark in which seed N of every method has the figure N, and the package's page."""
import json

import pytest
from conftest import REPOSITORY, run

HEADER = ("sequence,odometry,objects,objects_are,method,seed,status,raw_se3_m,se3_m,running_mean_m,association_local_f1,"
          "hypotheses_mean,closures_accepted,closures_wrong\n")
SEQUENCES = ("00", "05", "06", "07")
PAGE = (REPOSITORY / "docs" / "kitti.md").read_text()


def rows_of(sequence, odometry, objects):
    is_real = sequence == "00" and objects == "best"
    return [f"{sequence},{odometry},{objects},{'real' if is_real else 'semi-real'},{method},{seed},ok,9.125,{seed}.25,8.5,"
            f"{'' if is_real else f'0.7{seed}'},{seed}.0,1000,0\n"
            for method in ("odometry", "ukf", "mhm", "dpmhm", "no_semantics", "single_hypothesis")
            for seed in (range(1, 2) if method == "odometry" else range(1, 6))]


class Filled:
    def __init__(self, folder):
        self.folder = folder
        self.page = folder / "kitti.md"
        self.page.write_text(PAGE)
        references = [{"sequence": sequence, "name": name, "figures": {"se3_m": 6.5}} for sequence in SEQUENCES
                      for name in ("slam_orbslam2_stereo", "slam_suma")]
        (folder / "results.json").write_text(json.dumps({"references": references}))
        self.rows = [row for sequence in SEQUENCES for odometry in ("vo_orb", "lo_simple", "vo_dfvo")
                     for objects in ("best", "noisy") for row in rows_of(sequence, odometry, objects)]

    def fill(self, header=HEADER):
        (self.folder / "results.csv").write_text(header + "".join(self.rows))
        return run(REPOSITORY / "scripts/fill_kitti_page.py", self.folder, "--page", self.page)

    def lines(self, begin):
        """Different lines of the page that begin like this."""
        return {line for line in self.page.read_text().splitlines() if line.startswith(begin)}


@pytest.fixture
def filled(tmp_path):
    return Filled(tmp_path)


def test_cells_are_medians_of_the_seeds(filled):
    assert filled.fill().returncode == 0
    cell = " 9.12 → 3.25 |"
    assert filled.lines("| ORB-SLAM2") == {"| ORB-SLAM2 stereo tracking (`vo_orb`) |" + 4 * cell}
    assert filled.lines("| `mhm`") == {"| `mhm` | 3.25 | 8.50 | 3.25 | 8.50 |"}
    (camera_like,) = filled.lines("| camera-like, `ukf`")
    assert camera_like.startswith("| camera-like, `ukf` | .730 | .730 | .730 | .730 | 3.0 | ")
    assert "None of 624,000 accepted closures of all 624 runs is wrong" in filled.page.read_text()


def test_filling_again_changes_nothing(filled):
    assert filled.fill().returncode == 0
    once = filled.page.read_text()
    assert once != PAGE
    assert filled.fill().returncode == 0
    assert filled.page.read_text() == once


def test_what_is_missing_is_named_and_nothing_changes(filled):
    rows = filled.rows
    filled.rows = [row for row in rows if not row.startswith("05,vo_orb,noisy,semi-real,dpmhm,4")]
    answer = filled.fill()
    assert answer.returncode == 1
    assert "no run 05 vo_orb noisy dpmhm with seed 4" in answer.stdout
    filled.rows = rows
    answer = filled.fill(HEADER.replace(",se3_m", ",rmse_m"))
    assert answer.returncode == 1
    assert "no column 'se3_m'" in answer.stdout
    assert filled.page.read_text() == PAGE


def test_real_objects_have_no_associations_and_semireal_ones_take_their_place(filled):
    assert filled.fill().returncode == 0
    label = "| lidar-like, `dpmhm` | "
    (stays,) = filled.lines(label)
    assert not stays.startswith(label + ".730 ")
    filled.rows += rows_of("00", "vo_orb", "semireal")
    assert filled.fill().returncode == 0
    (line,) = filled.lines(label)
    assert line.startswith(label + ".730 | .730 | .730 | .730 | 3.0 | ")
