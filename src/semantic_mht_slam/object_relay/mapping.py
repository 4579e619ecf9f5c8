"""Mappings: YAML files that say which field of a message holds what (docs/object_relay.md has every key)."""
import os
from dataclasses import dataclass, field, fields
from typing import Dict, List, Optional, Union

import rospkg
import yaml

from .errors import RelayError

PACKAGE = "semantic_mht_slam"
Vector = Union[str, List[str], Dict[str, object]]  # a path, three paths, {min:, max:} or {points:}


@dataclass(frozen=True)
class Mapping:
    """One mapping. Paths of `header` and `objects` begin at the message, all others at one object."""

    name: str
    types: List[str]
    position: Vector
    objects: Union[str, Dict[str, object]]
    header: Optional[str] = None  # the field "header" if there is one
    object_header: Optional[str] = None
    best_by: Optional[str] = None
    class_path: Optional[str] = None
    classes: Dict[str, object] = field(default_factory=dict)
    keep: Dict[str, object] = field(default_factory=dict)
    moving: Dict[str, object] = field(default_factory=dict)
    axes: List[str] = field(default_factory=lambda: ["x", "y", "z"])
    orientation: Optional[str] = None
    size: Optional[Vector] = None
    covariance: Optional[str] = None
    score: Optional[str] = None
    score_max: float = 1.0
    definition: Optional[str] = None


_KEYS = {"types": "type", "class_path": "class"}  # names in the file where they differ
_REQUIRED = ("type", "objects", "position")
_PATHS = ("header", "object_header", "best_by", "class", "orientation", "covariance", "score", "definition")
_TABLES = ("classes", "keep", "moving")


def package_config(*names):
    """Absolute path of a file in the package's config folder."""
    try:
        return os.path.join(rospkg.RosPack().get_path(PACKAGE), "config", *names)
    except rospkg.ResourceNotFound as error:
        raise RelayError(f"package {PACKAGE} is not in ROS_PACKAGE_PATH: source the setup.bash of the workspace") from error


def read_yaml(path):
    """The content of a YAML file; RelayError that names the file."""
    try:
        with open(path, encoding="utf-8") as file:
            return yaml.safe_load(file)
    except OSError as error:
        raise RelayError(f"{path}: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise RelayError(f"{path}: no YAML: {' '.join(str(error).split())}") from error


def mapping_of(content, path):
    """The Mapping of a file's content; RelayError that names file and key."""
    if not isinstance(content, dict):
        raise RelayError(f"{path}: a mapping is a YAML table of keys, this is {type(content).__name__}")
    known = [_KEYS.get(item.name, item.name) for item in fields(Mapping) if item.name != "name"]
    for key in content:
        if key not in known:
            raise RelayError(f"{path}: unknown key '{key}' (keys: {', '.join(known)})")
    for key in _REQUIRED:
        if not content.get(key):
            raise RelayError(f"{path}: key '{key}' is missing")
    for key in _PATHS:
        if content.get(key) is not None and not isinstance(content[key], str):
            raise RelayError(f"{path}: key '{key}' must be text")
    for key in _TABLES:
        if content.get(key) is not None and not isinstance(content[key], dict):
            raise RelayError(f"{path}: key '{key}' must be a table")
    _check_axes(content.get("axes"), path)
    _check_vectors(content, path)
    if not isinstance(content["objects"], (str, dict)):
        raise RelayError(f"{path}: key 'objects' must be a field or a table field: class")
    score_max = content.get("score_max", 1.0)
    if isinstance(score_max, bool) or not isinstance(score_max, (int, float)) or not score_max > 0:
        raise RelayError(f"{path}: key 'score_max' must be a number above 0")
    types = content["type"] if isinstance(content["type"], list) else [content["type"]]
    values = {name: content[key] for name in (item.name for item in fields(Mapping))
              if (key := _KEYS.get(name, name)) in content and content[key] is not None}
    return Mapping(**dict(values, name=os.path.splitext(os.path.basename(path))[0], types=[str(t) for t in types]))


def _check_axes(axes, path):
    if axes is None:
        return
    if not isinstance(axes, list) or sorted(str(axis).lstrip("-") for axis in axes) != ["x", "y", "z"]:
        raise RelayError(f"{path}: key 'axes' must name x, y and z once each, as in [x, -y, z]")


def _check_vectors(content, path):
    for key, tables in (("position", {("max", "min")}), ("size", {("points",)})):
        value = content.get(key)
        fits = (value is None or isinstance(value, str) or
                (isinstance(value, list) and len(value) == 3 and all(isinstance(v, str) for v in value)) or
                (isinstance(value, dict) and tuple(sorted(value)) in tables))
        if not fits:
            shapes = "{min: ..., max: ...}" if key == "position" else "{points: path}"
            raise RelayError(f"{path}: key '{key}' must be a path, three paths or {shapes}")


def presets():
    """{name: Mapping} of the mappings that come with the package."""
    folder = package_config("relay")
    return {os.path.splitext(name)[0]: load_mapping(os.path.join(folder, name))
            for name in sorted(os.listdir(folder)) if name.endswith(".yaml")}


def load_mapping(name):
    """A preset by its name, or a mapping by the path of its file."""
    path = name
    if os.sep not in name and not name.endswith((".yaml", ".yml")):
        path = package_config("relay", name + ".yaml")
        if not os.path.exists(path):
            raise RelayError(f"no preset '{name}' (presets: {', '.join(presets())}); the path of a file of your own ends"
                             " with .yaml")
    return mapping_of(read_yaml(path), path)


def mapping_for(type_name, name, where):
    """The mapping called `name`, or the preset for a message type where `name` is empty; RelayError if there is none."""
    if name:
        mapping = load_mapping(name)
        if type_name not in mapping.types:
            raise RelayError(f"{where} is {type_name}, mapping '{mapping.name}' is for {', '.join(mapping.types)}: choose"
                             " another mapping, or add the type to its key 'type'")
        return mapping
    available = presets()
    for mapping in available.values():
        if type_name in mapping.types:
            return mapping
    known = ", ".join(sorted(kind for mapping in available.values() for kind in mapping.types))
    raise RelayError(f"{where} is {type_name}, for which there is no preset (there are: {known}); write a mapping, see"
                     " docs/object_relay.md, and name it: mapping:=/path/to/my.yaml")
