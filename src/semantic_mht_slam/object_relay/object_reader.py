"""One object of a message, read by a mapping: the mapping is checked against the message type once."""
import math
from dataclasses import dataclass
from typing import Optional, Tuple

from . import field_path, geometry
from .errors import RelayError
from .message_types import INTEGERS, NUMBERS, STRINGS

_XYZ = ("x", "y", "z")


@dataclass
class ReadObject:
    """What a message says of one object. Lengths in metres, in the axes of the frame of the message."""

    position_m: Tuple[float, float, float]
    label: object = None  # text or number; None: the mapping reads no class
    size_m: Optional[Tuple[float, float, float]] = None  # along the axes of the frame; None: not said
    cov_m2: Optional[tuple] = None  # 3x3; None: not said
    score: Optional[float] = None
    is_moving: bool = False
    frame: str = ""  # of the object's own header; empty: it has none
    stamp: object = None


class ObjectReader:
    """Reads objects of one type."""

    def __init__(self, mapping, message_type, object_type, where):
        best_by = mapping.best_by

        def bound(text, key, kinds=None):
            path = text and field_path.bind(text, message_type, object_type, f"{where}, key '{key}'", best_by)
            if path and kinds and (path.field_type.is_array or path.field_type.base not in kinds):
                raise RelayError(f"{where}, key '{key}': '{path.text}' is {path.field_type}, wanted is "
                                 + " or ".join(sorted(kinds)))
            return path

        self._message_type = message_type
        self._label = bound(mapping.class_path, "class", INTEGERS | STRINGS)
        self._header = bound(mapping.object_header, "object_header", {"std_msgs/Header"})
        self._score = bound(mapping.score, "score", NUMBERS)
        self._score_max = mapping.score_max
        self._covariance = bound(mapping.covariance, "covariance")
        self._orientation = bound(mapping.orientation, "orientation", {"geometry_msgs/Quaternion"})
        self._axes = geometry.axes_matrix(mapping.axes)
        self._keep = self._conditions(mapping.keep, "keep", bound)
        self._moving = self._conditions(mapping.moving, "moving", bound)
        box = mapping.position if isinstance(mapping.position, dict) else None
        self._position = None if box else self._vector(mapping.position, "position", bound, where)
        self._box = box and [self._vector(box[key], "position", bound, where) for key in ("min", "max")]
        self._points = isinstance(mapping.size, dict) and bound(mapping.size["points"], "size")
        self._size = None
        if mapping.size and not self._points:
            self._size = self._vector(mapping.size, "size", bound, where)

    @staticmethod
    def _conditions(table, key, bound):
        return [(bound(path, key), values if isinstance(values, list) else [values]) for path, values in table.items()]

    def _vector(self, spec, key, bound, where):
        """A function from an object to three numbers."""
        if isinstance(spec, list):
            paths = [bound(text, key) for text in spec]
            return lambda entry: tuple(float(path.read(entry)) for path in paths)
        path = bound(spec, key)
        if path.field_type.is_array and path.field_type.base in NUMBERS and path.field_type.length in (None, 3):
            return lambda entry: _three(path.read(entry), path)
        fields = self._message_type.fields(path.field_type.base) or {}
        if path.field_type.is_array or any(name not in fields for name in _XYZ):
            raise RelayError(f"{where}, key '{key}': '{path.text}' is {path.field_type}, which is no vector: it must have"
                             " x, y and z or be an array of three numbers")
        return lambda entry: _xyz(path.read(entry))

    def is_kept(self, entry):
        """Whether the mapping's conditions hold for an object."""
        return all(path.read(entry) in values for path, values in self._keep)

    def read(self, entry):
        """The ReadObject of an entry; MissingValue where it lacks what the mapping reads."""
        header = self._header and self._header.read(entry)
        size_m = None
        if self._box:
            low, high = (read(entry) for read in self._box)
            position_m = tuple((a + b) / 2 for a, b in zip(low, high))
            size_m = tuple(b - a for a, b in zip(low, high))
        else:
            position_m = self._position(entry)
        if self._points or self._size:
            size_m = self._read_size(entry)
        return ReadObject(
            position_m=geometry.rotated(self._axes, position_m),
            label=self._label and self._label.read(entry),
            size_m=size_m and geometry.extents(self._axes, size_m),
            cov_m2=self._covariance and self._read_covariance(entry),
            score=None if not self._score else self._score.read(entry) / self._score_max,
            is_moving=bool(self._moving) and all(path.read(entry) in values for path, values in self._moving),
            frame=header.frame_id if header else "",
            stamp=header.stamp if header else None)

    def _read_size(self, entry):
        """Extents along the frame's axes; None where the object has none, or an orientation that is no rotation."""
        if self._points:
            points = [tuple(p) if isinstance(p, (list, tuple)) else _xyz(p) for p in self._points.read(entry)]
            return tuple(max(p[i] for p in points) - min(p[i] for p in points) for i in range(3)) if points else None
        try:
            size_m = self._size(entry)
        except field_path.MissingValue:
            return None
        if not self._orientation:
            return size_m
        q = self._orientation.read(entry)
        R = geometry.rotation(q.x, q.y, q.z, q.w)
        return R and geometry.extents(R, size_m)

    def _read_covariance(self, entry):
        value = self._covariance.read(entry)
        covariance = covariance_of(_xyz(value) if all(hasattr(value, name) for name in _XYZ) else list(value))
        if covariance is None:
            raise field_path.MissingValue(f"{self._covariance.text} ({len(value)} numbers)")
        return geometry.rotated_covariance(self._axes, covariance) if any(map(any, covariance)) else None


def covariance_of(numbers):
    """3x3 covariance of what messages hold, None if the count fits nothing: 36 (of a pose, row-major), 9 (row-major), 6
    (upper triangle), 4 (planar; the height gets the mean of both variances) or 3 numbers (variances)."""
    n = numbers
    if len(n) == 36:
        return (tuple(n[0:3]), tuple(n[6:9]), tuple(n[12:15]))
    if len(n) == 9:
        return (tuple(n[0:3]), tuple(n[3:6]), tuple(n[6:9]))
    if len(n) == 6:
        return ((n[0], n[1], n[2]), (n[1], n[3], n[4]), (n[2], n[4], n[5]))
    if len(n) == 4:
        return ((n[0], n[1], 0.0), (n[2], n[3], 0.0), (0.0, 0.0, (n[0] + n[3]) / 2))
    if len(n) == 3:
        return ((n[0], 0.0, 0.0), (0.0, n[1], 0.0), (0.0, 0.0, n[2]))
    return None


def is_finite(vector):
    """Whether all numbers of a vector are finite."""
    return all(math.isfinite(value) for value in vector)


def _xyz(value):
    return (value.x, value.y, value.z)


def _three(values, path):
    if len(values) < 3:
        raise field_path.MissingValue(f"{path.text} ({len(values)} numbers)")
    return tuple(float(value) for value in values[:3])
