"""What the benchmark runs."""
import pytest
from semantic_mht_slam.benchmark.cells import Request, kind_of, make_cells, parse_names, parse_seeds
from semantic_mht_slam.benchmark.errors import InputError


@pytest.fixture
def data(tmp_path):
    """Two sequences with an odometry each; 00 has real objects."""
    for name in ("00", "05"):
        for file in ("times.txt", "calib.txt", "poses.txt", "odometry/vo.txt", "objects_semireal.csv"):
            path = tmp_path / name / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    (tmp_path / "00/objects.csv").touch()
    (tmp_path / "notes").mkdir()
    return tmp_path


def cells_of(data, **more):
    return make_cells(Request(data=data, output=data / "out", config="c.yaml", **more))


@pytest.mark.parametrize("text, seeds", [("1-3", [1, 2, 3]), ("7", [7]), ("5,1-2", [1, 2, 5])])
def test_seeds_are_ranges_and_numbers(text, seeds):
    assert parse_seeds(text) == seeds


@pytest.mark.parametrize("text", ["", "x", "1-", "-1", "3-1", "1-2-3", "1,1", "0-999999999999", "²"])
def test_other_seeds_are_refused(text):
    with pytest.raises(InputError, match="--seeds"):
        parse_seeds(text)


def test_names_must_differ():
    assert parse_names("--objects", "a,b") == ["a", "b"]
    with pytest.raises(InputError, match="'a' stands twice"):
        parse_names("--objects", "a,b,a")


def test_cells_go_over_seeds_fastest_and_odometry_has_one(data):
    cells = cells_of(data, methods=["dpmhm", "odometry"], seeds=[4, 5])
    assert [cell.name for cell in cells[:3]] == ["00 vo objects odometry seed 4", "00 vo objects dpmhm seed 4",
                                                 "00 vo objects dpmhm seed 5"]
    assert [cell.sequence for cell in cells] == ["00"] * 3 + ["05"] * 3


def test_best_objects_are_real_ones_where_there_are_any(data):
    kinds = {cell.sequence: (cell.objects_file, cell.objects_are) for cell in cells_of(data)}
    assert kinds == {"00": ("objects.csv", "real"), "05": ("objects_semireal.csv", "semi-real")}
    (data / "00/objects_landmark.csv").touch()
    assert kind_of(data / "00", "objects.csv") == "simulated"


def test_cells_with_the_same_files_share_a_folder(data):
    best, semireal = cells_of(data, sequences=["05"], methods=["ukf"], seeds=[1], objects=["best", "semireal"])
    assert best.folder == semireal.folder


def test_settings_of_a_method_come_after_those_of_the_command_line(data):
    request = Request(data, data, "c.yaml", settings=["max_hypotheses=9"], methods=["single_hypothesis"], seeds=[1])
    assert make_cells(request)[0].settings(request) == ["max_hypotheses=9", "max_hypotheses=1"]


def test_what_is_missing_is_named(data):
    with pytest.raises(InputError, match="objects_noisy.csv"):
        cells_of(data, objects=["noisy"])
    with pytest.raises(InputError, match="no folder in it has times.txt"):
        make_cells(Request(data / "notes", data, "c.yaml"))
