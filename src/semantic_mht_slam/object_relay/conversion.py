"""One message of a detector to one semantic_mht_slam/SemanticObjectArray; what is left out is counted by its cause."""
from collections import Counter

from semantic_mht_slam.msg import SemanticObject, SemanticObjectArray

from . import field_path, geometry
from .class_labels import ClassLabels, IgnoredLabel, UnknownLabel
from .errors import RelayError
from .message_types import UnfitMessage
from .object_reader import ObjectReader, is_finite

_MOST_CAUSES = 200  # texts hold what others send: bounded memory
_OTHER_CAUSES = "objects dropped for other causes"
UNKNOWN_SCORE = -1.0


class DropCounts:
    """How much was dropped or mended, by the text that says why. `quiet` causes are wanted and not warned about."""

    def __init__(self):
        self.by_cause = Counter()
        self.quiet = Counter()

    def add(self, cause):
        """One more of a cause."""
        if cause not in self.by_cause and len(self.by_cause) >= _MOST_CAUSES:
            cause = _OTHER_CAUSES
        self.by_cause[cause] += 1

    def lines(self, topic):
        """A line for each cause: the warnings that are due."""
        return [f"{topic}: {count} {cause}" for cause, count in self.by_cause.items()]


class Converter:
    """Converts the messages of one type on one topic.

    `only_class`: label of all objects, for messages without classes. `source_frame`: frame of messages that name none.
    `to_target`: function (frame, stamp) -> (target frame, rotation, translation) or None, where objects are wanted in
    another frame than their message's.
    """

    def __init__(self, mapping, table, message_type, topic, *, renamed=None, only_class="", source_frame="",
                 to_target=None):
        where = f"{topic} ({message_type.name}), mapping '{mapping.name}'"
        self._type = message_type
        self._labels = ClassLabels(table, mapping.classes, renamed or {}, topic)
        self._table = table
        self._source_frame = source_frame.lstrip("/")
        self._to_target = to_target
        header = mapping.header or ("header" if "header" in message_type.fields(message_type.name) else None)
        self._header = header and field_path.bind(header, message_type, message_type.name, f"{where}, key 'header'")
        self._groups = self._bound_groups(mapping, message_type, where)
        self._only_class = only_class
        if only_class and table.id_of(only_class) is None:
            raise RelayError(f"{topic}: class '{only_class}' is not in {table.origin} ({table.described()})")
        if not only_class and not mapping.class_path and any(label is None for _, _, label in self._groups):
            raise RelayError(f"{where}: {message_type.name} says no class: name the one of all objects, as in"
                             f" class:=pole (classes: {table.described()})")
        self.counts = DropCounts()

    @staticmethod
    def _bound_groups(mapping, message_type, where):
        """[(path to an array of objects, their reader, their label or None)]."""
        arrays = mapping.objects if isinstance(mapping.objects, dict) else {mapping.objects: None}
        groups = []
        for text, label in arrays.items():
            path = field_path.bind(text, message_type, message_type.name, f"{where}, key 'objects'")
            if not path.field_type.is_array or message_type.fields(path.field_type.base) is None:
                raise RelayError(f"{where}, key 'objects': '{text}' is {path.field_type}, no array of messages")
            groups.append((path, ObjectReader(mapping, message_type, path.field_type.base, where), label))
        return groups

    def convert(self, data, received):
        """The objects of a serialized message; None if it cannot be used at all, which is counted.

        received: when the message arrived, the stamp of messages that have none.
        """
        try:
            return self._objects_of(self._type.parse(data), received)
        except UnfitMessage as problem:
            self.counts.add(f"messages dropped: the bytes do not fit the definition that came with them ({problem}); rebuild"
                            " publisher and recorder with one version of the message")
        except field_path.MissingValue as missing:
            self.counts.add(f"messages dropped: field '{missing}' is empty")
        return None

    def _objects_of(self, message, received):
        found = []
        for path, reader, label in self._groups:
            for entry in path.read(message):
                read = self._usable(reader, entry)
                if read is not None:
                    read.label = label if label is not None else read.label
                    found.append(read)
        frame, stamp = self._frame_and_stamp(message, found, received)
        if not frame:
            self.counts.add("messages dropped: no frame_id, neither in the message nor given (source_frame:=FRAME)")
            return None
        transform = None
        if self._to_target:
            transform = self._to_target(frame, stamp)
            if transform is None:
                self.counts.add(f"messages dropped: no transform from '{frame}' at their time to target_frame")
                return None
        array = SemanticObjectArray()
        array.header.stamp = stamp
        array.header.frame_id = transform[0] if transform else frame
        for read in found:
            if read.frame and read.frame.lstrip("/") != frame:
                self.counts.add(f"objects dropped: in frame '{read.frame}', their message in '{frame}'")
                continue
            converted = self._converted(read, transform)
            if converted is not None:
                array.objects.append(converted)
        return array

    def _usable(self, reader, entry):
        """The ReadObject of an entry, or None where it is left out."""
        try:
            if not reader.is_kept(entry):
                self.counts.quiet["objects that do not fit 'keep'"] += 1
                return None
            read = reader.read(entry)
        except field_path.MissingValue as missing:
            self.counts.add(f"objects dropped: field '{missing}' is empty or has another length")
            return None
        if not is_finite(read.position_m):
            self.counts.add("objects dropped: the position is not finite")
            return None
        return read

    def _frame_and_stamp(self, message, found, received):
        """From the message's header, else from the first object's, else what the user gave and the time of arrival."""
        header = self._header.read(message) if self._header else None
        frame = (header.frame_id if header else "") or next((read.frame for read in found if read.frame), "")
        stamps = ([header.stamp] if header else []) + [read.stamp for read in found if read.stamp is not None]
        stamp = next((stamp for stamp in stamps if stamp.to_nsec() > 0), received)
        return frame.lstrip("/") or self._source_frame, stamp

    def _converted(self, read, transform):
        class_id = self._class_id(read.label)
        if class_id is None:
            return None
        made = SemanticObject()
        made.class_id = class_id
        made.is_moving = read.is_moving
        position_m, size_m, cov_m2 = read.position_m, read.size_m, read.cov_m2
        if transform:
            _, R, translation_m = transform
            position_m = tuple(a + b for a, b in zip(geometry.rotated(R, position_m), translation_m))
            size_m = size_m and geometry.extents(R, size_m)
            cov_m2 = cov_m2 and geometry.rotated_covariance(R, cov_m2)
        made.position.x, made.position.y, made.position.z = position_m
        if cov_m2:
            made.covariance = [value for row in cov_m2 for value in row]
            if not is_finite(made.covariance) or any(cov_m2[i][i] <= 0.0 for i in range(3)):
                self.counts.add("objects dropped: the covariance is not finite or has a variance that is not above 0")
                return None
        if size_m and is_finite(size_m) and all(extent >= 0.0 for extent in size_m):
            made.size.x, made.size.y, made.size.z = size_m
        elif size_m:
            self.counts.add("sizes left out: not finite, or below 0")
        made.score = self._score(read.score)
        return made

    def _class_id(self, label):
        try:
            return self._labels.id_of(self._only_class or label)
        except IgnoredLabel as ignored:
            self.counts.quiet[f"objects of the class '{ignored}', to be left out"] += 1
        except UnknownLabel as unknown:
            self.counts.add(f"objects dropped: class {unknown} is not in the class table ({self._table.origin}); rename it"
                            " under 'classes', or to null to leave it out")
        return None

    def _score(self, score):
        if score is None:
            return UNKNOWN_SCORE
        if 0.0 <= score <= 1.0:
            return score
        self.counts.add("scores taken as unknown: not in [0, 1] (key 'score_max' is what stands for 1)")
        return UNKNOWN_SCORE
