"""Bag in, bag with objects (or with the map as another message) out."""
import os
import tempfile
from collections import Counter

import rosbag

from .errors import RelayError
from .mapping import presets
from .message_types import UnfitMessage, message_type
from . import transforms

MAP_TYPE = "semantic_mht_slam/SemanticMap"


class BagRelay:
    """Relays one bag; `report` has the lines for the user afterwards."""

    def __init__(self, options, path, output, topics, kept):
        """topics: {"in": name or "", "out": name}; kept: topics to copy, empty: all."""
        self._options = options
        self._path = path
        self._output = output
        self._topic_in = topics["in"]
        self._topic_out = topics["out"]
        self._kept = set(kept)
        self._converters = {}
        self._exporter = options.exporter() if options.map_as else None
        self._to_target = None
        self._counts = Counter()
        self.report = []

    def run(self):
        """Writes the output, whole or not at all."""
        if os.path.exists(self._output) and os.path.samefile(self._output, self._path):
            raise RelayError(f"{self._output}: the output is the input; name another file")
        partial = None
        try:
            with rosbag.Bag(self._path) as source:
                self._choose_topic(source)
                if self._options.target_frame:
                    self._to_target = transforms.of_bag(source, self._options.target_frame)
                partial = self._make_partial()
                with rosbag.Bag(partial, "w") as made:
                    self._copy(source, made)
            self._check_result()
            with open(partial, "rb+") as file:
                os.fsync(file.fileno())
            os.replace(partial, self._output)
        except rosbag.ROSBagUnindexedException as error:
            raise RelayError(f"{self._path}: the bag has no index: it is truncated or was not closed (rosbag reindex may"
                             " help)") from error
        except (rosbag.ROSBagException, rosbag.ROSBagFormatException) as error:
            raise RelayError(f"{self._path}: truncated, or no bag at all: {error}") from error
        except OSError as error:
            raise RelayError(f"{error.filename or self._output}: {error.strerror}") from error
        finally:
            if partial is not None and os.path.exists(partial):
                os.remove(partial)
        self._write_report()

    def _make_partial(self):
        """An empty file beside the output, of a name that nobody can guess, with the mode of a new file."""
        folder, name = os.path.split(self._output)
        handle, path = tempfile.mkstemp(prefix=name + ".tmp-", dir=folder or ".")
        os.close(handle)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(path, 0o666 & ~umask)
        return path

    def _choose_topic(self, source):
        """The topic to relay: the one that was named, else the only one of a type that can be read."""
        types = {topic: info.msg_type for topic, info in source.get_type_and_topic_info().topics.items()}
        listed = ", ".join(f"{topic} ({kind})" for topic, kind in sorted(types.items())) or "none"
        if self._topic_in:
            if self._topic_in not in types:
                raise RelayError(f"{self._path}: no topic {self._topic_in} (topics: {listed})")
            return
        wanted = {MAP_TYPE} if self._exporter else {kind for mapping in presets().values() for kind in mapping.types}
        fitting = sorted(topic for topic, kind in types.items() if kind in wanted)
        if len(fitting) != 1:
            problem = "several topics could be relayed" if fitting else "no topic that a preset can read"
            raise RelayError(f"{self._path}: {problem}: name one with --topic, and its mapping with --mapping (topics:"
                             f" {listed})")
        self._topic_in = fitting[0]

    def _copy(self, source, made):
        for topic, raw, stamp, header in source.read_messages(raw=True, return_connection_header=True):
            if topic == self._topic_out:
                raise RelayError(f"{self._path}: topic {topic} is in the bag already: name another one with"
                                 " --output-topic")
            if not self._kept or topic in self._kept:
                made.write(topic, raw, stamp, raw=True, connection_header=header)
            if topic == self._topic_in:
                self._relay(made, raw[1], stamp, header)

    def _relay(self, made, data, stamp, header):
        self._counts["messages"] += 1
        kind, converter = self._converter_of(header)
        if self._exporter:
            written = self._exporter.write(self._map_of(kind, data))
            self._counts["objects"] += len(self._exporter.objects_of(written))
        else:
            written = converter.convert(data, stamp)
            self._counts["objects"] += len(written.objects) if written else 0
        if written:
            self._counts["written"] += 1
            made.write(self._topic_out, written, stamp)

    def _map_of(self, kind, data):
        try:
            return kind.parse(data)
        except UnfitMessage as problem:
            raise RelayError(f"{self._path}, {self._topic_in}: a map is broken ({problem})") from problem

    def _converter_of(self, header):
        """(MessageType, Converter or None) of a connection."""
        fields = {key: value.decode() if isinstance(value, bytes) else value for key, value in header.items()}
        key = (fields["type"], fields["md5sum"])
        if key not in self._converters:
            where = f"{self._path}, {self._topic_in}"
            kind = message_type(fields["type"], fields.get("message_definition", ""), fields["md5sum"], where)
            if self._exporter and kind.name != MAP_TYPE:
                raise RelayError(f"{where} is {kind.name}, --map-as needs {MAP_TYPE}")
            self._converters[key] = (kind, None if self._exporter else
                                     self._options.converter(kind, where, self._to_target))
        return self._converters[key]

    def _drops(self):
        return [line for _, converter in self._converters.values() if converter
                for line in converter.counts.lines(self._topic_in)]

    def _check_result(self):
        if self._counts["objects"] == 0 and self._drops():
            raise RelayError(f"{self._path}: no object could be used: {'; '.join(self._drops())}")

    def _write_report(self):
        kinds = ", ".join(sorted(kind.name for kind, _ in self._converters.values()))
        counts = self._counts
        self.report = [f"{self._output}: {counts['messages']} messages of {self._topic_in} ({kinds}) ->"
                       f" {counts['written']} messages with {counts['objects']}"
                       f" {'landmarks' if self._exporter else 'objects'} on {self._topic_out}"]
        self.report += self._drops()
        for _, converter in self._converters.values():
            if converter:
                self.report += [f"{self._topic_in}: {count} {cause}" for cause, count in converter.counts.quiet.items()]
