"""A semantic_mht_slam/SemanticMap as a message of another type, by the mapping that reads that type, in reverse."""
import roslib.message

from . import field_path
from .class_labels import ClassLabels, ClassTable
from .errors import RelayError
from .message_types import INTEGERS, MessageType, NUMBERS, message_type


def exported_type(mapping):
    """The MessageType that a mapping writes: of its `definition`, else of the installed package."""
    name = mapping.types[0]
    where = f"mapping '{mapping.name}'"
    if mapping.definition:
        return message_type(name, mapping.definition, "", where)
    installed = roslib.message.get_message_class(name)
    if installed is None:
        raise RelayError(f"{where}: {name} is not installed and the mapping has no 'definition' of it: install its package,"
                         " or choose vision_msgs")
    return message_type(name, installed._full_text, installed._md5sum, where)


class MapExporter:
    """Writes maps as messages of one type. `message_class` is what a publisher or a bag needs to know of it."""

    def __init__(self, mapping, renamed=None):
        self._where = f"mapping '{mapping.name}', in reverse"
        self._type: MessageType = exported_type(mapping)
        self.message_class = self._type.root
        self._renamed = (mapping.classes, renamed or {})
        if not isinstance(mapping.objects, str) or not isinstance(mapping.position, str) or not mapping.class_path:
            raise RelayError(f"{self._where}: 'objects', 'position' and 'class' must each be one path to write a map")
        self._objects = self._bound(mapping.objects, self._type.name, "objects", None)
        object_type = self._objects.field_type.base
        best_by = mapping.best_by
        self._position = self._bound(mapping.position, object_type, "position", best_by)
        self._class = self._bound(mapping.class_path, object_type, "class", best_by)
        self._score = mapping.score and self._bound(mapping.score, object_type, "score", best_by)
        self._covariance = mapping.covariance and self._bound(mapping.covariance, object_type, "covariance", best_by)
        self._orientation = mapping.orientation and self._bound(mapping.orientation, object_type, "orientation", best_by)
        self._object_header = mapping.object_header and self._bound(mapping.object_header, object_type, "object_header",
                                                                    best_by)
        self._score_max = mapping.score_max
        has_xyz = {"x", "y", "z"} <= set(self._type.fields(self._position.field_type.base) or {})
        if not has_xyz or [str(axis) for axis in mapping.axes] != ["x", "y", "z"]:
            raise RelayError(f"{self._where}: 'position' must lead to a point with x, y and z, without 'axes'")

    def _bound(self, text, type_name, key, best_by):
        return field_path.bind(text, self._type, type_name, f"{self._where}, key '{key}'", best_by)

    def write(self, semantic_map):
        """The message of a map; RelayError for a landmark of a class that the map's own table lacks."""
        table = ClassTable({info.id: info.name for info in semantic_map.classes}, "the class table of the map")
        labels = ClassLabels(table, *self._renamed, self._where)
        message = self._type.root()
        if hasattr(message, "header"):
            message.header = semantic_map.header
        objects = self._objects.read(message)
        for landmark in semantic_map.landmarks:
            entry = self._type.make(self._objects.field_type.base)
            if self._object_header:
                self._set(entry, self._object_header, semantic_map.header)
            self._set(entry, self._class, self._label(labels, table, landmark.class_id))
            position = self._container(entry, self._position)
            for axis in "xyz":
                setattr(position, axis, getattr(landmark.position, axis))
            if self._orientation:
                self._container(entry, self._orientation).w = 1.0
            if self._score:
                self._set(entry, self._score, landmark.existence_prob * self._score_max)
            if self._covariance:
                self._set(entry, self._covariance, covariance_numbers(landmark.covariance, self._covariance))
            objects.append(entry)
        return message

    def objects_of(self, message):
        """The entries of a message that was written."""
        return self._objects.read(message)

    def _label(self, labels, table, class_id):
        if table.id_of(class_id) is None:
            raise RelayError(f"{self._where}: the map has a landmark of class {class_id}, which its class table lacks"
                             f" ({table.described()})")
        return labels.label_of(class_id, self._class.field_type.base in INTEGERS)

    def _container(self, entry, path):
        """The message that a path leads to, with one entry made in every array on the way."""
        return self._walk(entry, path, path.steps)

    def _set(self, entry, path, value):
        owner = self._walk(entry, path, path.steps[:-1])
        setattr(owner, path.steps[-1].name, value)

    def _walk(self, value, path, steps):
        type_name = self._objects.field_type.base
        for step in steps:
            field_type = self._type.fields(type_name)[step.name]
            value = getattr(value, step.name)
            type_name = field_type.base
            if step.index is not None:
                if step.index not in ("best", 0) or field_type.length is not None:
                    raise RelayError(f"{self._where}: '{path.text}' cannot be written, only [best] or [0] of a list can")
                if not value:
                    value.append(self._type.make(type_name))
                value = value[0]
        return value


def covariance_numbers(covariance, path):
    """Nine numbers, row-major, as the array that a covariance field holds: 9 or 36 (of a pose; rotations unknown: 0)."""
    length = path.field_type.length
    if path.field_type.base not in NUMBERS or length not in (9, 36):
        raise RelayError(f"'{path.text}' is {path.field_type}: a covariance of 9 or 36 numbers can be written")
    if length == 9:
        return list(covariance)
    numbers = [0.0] * 36
    for row in range(3):
        numbers[6 * row:6 * row + 3] = covariance[3 * row:3 * row + 3]
    return numbers
