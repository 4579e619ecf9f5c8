"""What the benchmark runs: the cells sequence x odometry x objects x method x seed, and the files that each needs."""
from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path

from .errors import InputError

MAX_SEEDS = 10000
REAL_OBJECTS = "objects.csv"
SEMIREAL_OBJECTS = "objects_semireal.csv"
NOISY_OBJECTS = "objects_noisy.csv"
FULL_SYSTEM = "dpmhm"


@dataclass(frozen=True)
class Method:
    """A column of the benchmark: a method of slam_offline, possibly with a part switched off."""

    name: str
    method: str  # value of the key `method`
    help: str
    color: str  # the same in every plot; colour-blind readers can tell them apart
    settings: tuple[str, ...] = ()  # KEY=VALUE
    is_default: bool = True  # runs unless methods are named
    uses_seed: bool = True  # False: one run with the first seed


METHODS = [
    Method("odometry", "odometry", "the odometry as it is", "#777777", uses_seed=False),
    Method("ukf", "ukf", "one hypothesis, nearest neighbours (baseline of the paper)", "#e69f00"),
    Method("mhm", "mhm", "maximum likelihood multiple hypotheses (baseline of the paper)", "#cc79a7"),
    Method(FULL_SYSTEM, "dpmhm", "the full system", "#0072b2"),
    Method("no_semantics", "dpmhm", "dpmhm, all classes count as one", "#009e73", ("semantics=false",)),
    Method("single_hypothesis", "dpmhm", "dpmhm, one hypothesis", "#d55e00", ("max_hypotheses=1",)),
    Method("neither", "dpmhm", "dpmhm without classes and with one hypothesis", "#56b4e9",
           ("semantics=false", "max_hypotheses=1"), is_default=False),
]
COLORS = {method.name: method.color for method in METHODS}


@dataclass
class Request:
    """The command line."""

    data: Path
    output: Path
    config: str  # as slam_offline takes it
    sequences: list[str] = field(default_factory=list)  # empty: every folder of `data` with times.txt and poses.txt
    odometries: list[str] = field(default_factory=list)  # empty: every file of the folder odometry of a sequence
    objects: list[str] = field(default_factory=lambda: ["best"])
    methods: list[str] = field(default_factory=list)  # empty: the default ones
    seeds: list[int] = field(default_factory=lambda: [1, 2, 3, 4, 5])
    settings: list[str] = field(default_factory=list)  # KEY=VALUE, for every run
    jobs: int = 1

    def command(self) -> str:
        """The command that makes these results, without what does not shape them."""
        parts = ["benchmark --data DATA --output RESULT", "--objects " + ",".join(self.objects),
                 "--seeds " + ",".join(map(str, self.seeds))]
        for option, names in (("--sequences ", self.sequences), ("--odometries ", self.odometries),
                              ("--methods ", self.methods)):
            if names:
                parts.append(option + ",".join(names))
        return " ".join(parts + ["--set " + setting for setting in self.settings])


@dataclass(frozen=True)
class Cell:
    """One run of the benchmark: what it is, and the files it needs."""

    sequence: str
    odometry: str
    objects: str  # how the objects were chosen, as "best"
    objects_are: str  # "real", "semi-real", ...
    method: Method
    seed: int
    dataset: Path  # folder of the sequence
    objects_file: str  # in `dataset`
    folder: Path  # of its results; cells that are the same run share it

    @property
    def name(self) -> str:
        return f"{self.sequence} {self.odometry} {folder_name(self.objects_file)} {self.method.name} seed {self.seed}"

    @property
    def odometry_file(self) -> str:
        """In `dataset`."""
        return odometry_file(self.odometry)

    @property
    def input_files(self) -> list[str]:
        """Files in `dataset` that the run reads."""
        return ["times.txt", "calib.txt", "poses.txt", self.objects_file, self.odometry_file]

    def settings(self, request: Request) -> list[str]:
        """KEY=VALUE, those of the method last, so that they hold."""
        return request.settings + list(self.method.settings)


def odometry_file(odometry: str) -> str:
    return f"odometry/{odometry}.txt"


def folder_name(file: str) -> str:
    """The name of a file as one part of a path."""
    return str(Path(file).with_suffix("")).replace("/", "_")


def parse_names(option: str, text: str) -> list[str]:
    """Parts of a list "a,b,c". Raises InputError for an empty part and for one that stands twice."""
    names = text.split(",")
    for name in names:
        if not name:
            raise InputError(f"{option} {text}: an empty name")
        if names.count(name) > 1:
            raise InputError(f"{option} {text}: '{name}' stands twice")
    return names


def parse_seeds(text: str) -> list[int]:
    """Seeds of a list "1-5,9", sorted. Raises InputError."""
    seeds: set[int] = set()
    for part in parse_names("--seeds", text):
        ends = part.split("-")
        if len(ends) > 2 or not all(end.isascii() and end.isdigit() for end in ends):
            raise InputError(f"--seeds {text}: '{part}' is no seed and no range as 1-5")
        first, last = int(ends[0]), int(ends[-1])
        if not first <= last < first + MAX_SEEDS:
            raise InputError(f"--seeds {text}: '{part}' is no range of at most {MAX_SEEDS} seeds as 1-5")
        seeds.update(range(first, last + 1))
    return sorted(seeds)


def names_in(folder: Path, test) -> list[str]:
    """Names of the entries of a folder that pass the test, sorted."""
    try:
        return sorted(entry.name for entry in folder.iterdir() if test(entry))
    except OSError as problem:
        raise InputError(f"cannot read folder '{folder}': {problem.strerror}") from None


def sequences_of(request: Request) -> list[str]:
    if request.sequences:
        return request.sequences
    names = names_in(request.data, lambda entry: all((entry / name).is_file() for name in ("times.txt", "poses.txt")))
    if not names:
        raise InputError(f"{request.data}: no folder in it has times.txt and poses.txt")
    return names


def odometries_of(request: Request, dataset: Path) -> list[str]:
    if request.odometries:
        return request.odometries
    names = names_in(dataset / "odometry", lambda entry: entry.suffix == ".txt")
    if not names:
        raise InputError(f"{dataset}/odometry: no .txt file in it")
    return [Path(name).stem for name in names]


def methods_of(request: Request) -> list[Method]:
    """In the order of the report."""
    known = [method.name for method in METHODS]
    for name in request.methods:
        if name not in known:
            raise InputError(f"--methods {name}: no such method, known are {', '.join(known)}")
    return [method for method in METHODS
            if method.name in request.methods or (not request.methods and method.is_default)]


def objects_file(dataset: Path, choice: str) -> str:
    if choice == "best":
        return REAL_OBJECTS if (dataset / REAL_OBJECTS).is_file() else SEMIREAL_OBJECTS
    return {"semireal": SEMIREAL_OBJECTS, "noisy": NOISY_OBJECTS}.get(choice, choice)


def kind_of(dataset: Path, file: str) -> str:
    """What the objects of a file are. The landmark of each detection is known of objects that a simulator made, so that
    a file of that kind beside objects.csv says that they are not real.
    """
    if file == REAL_OBJECTS:
        return "simulated" if (dataset / "objects_landmark.csv").is_file() else "real"
    return {SEMIREAL_OBJECTS: "semi-real", NOISY_OBJECTS: "semi-real, noisy"}.get(file, file)


def make_cells(request: Request) -> list[Cell]:
    """Every cell: sequences, odometries, objects, methods, seeds, the last one fastest.
    Raises InputError for names that do not exist and files that are missing.
    """
    cells = []
    for sequence in sequences_of(request):
        dataset = request.data / sequence
        if not dataset.is_dir():
            raise InputError(f"no data-set folder '{dataset}'")
        for odometry in odometries_of(request, dataset):
            for objects in request.objects:
                file = objects_file(dataset, objects)
                folder = request.output / "runs" / sequence / odometry / folder_name(file)
                first = Cell(sequence, odometry, objects, kind_of(dataset, file), METHODS[0], 0, dataset, file, folder)
                cells += cells_of_case(request, first)
    return cells


def cells_of_case(request: Request, case: Cell) -> list[Cell]:
    """The cells of every method and seed of a case."""
    for name in case.input_files:
        if not (case.dataset / name).is_file():
            raise InputError(f"no file '{case.dataset / name}'")
    return [dataclasses.replace(case, method=method, seed=seed, folder=case.folder / method.name / f"seed_{seed}")
            for method in methods_of(request)
            for seed in (request.seeds if method.uses_seed else request.seeds[:1])]
