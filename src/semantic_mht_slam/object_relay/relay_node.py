"""The relay live: an untyped subscriber in, objects (and the map as another message) out, counts in /diagnostics."""
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from semantic_mht_slam.msg import SemanticMap, SemanticObjectArray

from . import transforms
from .errors import RelayError
from .message_types import message_type
from .options import Options

_WARNING_PERIOD_S = 5.0
_MOST_WARNINGS = 1000  # texts hold what others send: bounded memory
_QUEUE = 10


def options_of_parameters():
    """The Options of the private parameters; RelayError for one that is none."""
    known = {"class_table": str, "mapping": str, "class": str, "classes": dict, "source_frame": str,
             "target_frame": str, "map_as": str, "tf_timeout": (int, float)}
    given = rospy.get_param("~", {}) or {}
    for name, value in given.items():
        if name not in known:
            raise RelayError(f"unknown parameter '~{name}' (parameters: {', '.join(known)})")
        if not isinstance(value, known[name]) and not (name == "class" and isinstance(value, int)):
            raise RelayError(f"parameter '~{name}' has the wrong type: {value!r}")
    wait_s = given.pop("tf_timeout", 0.2)
    if "class" in given:
        given["only_class"] = str(given.pop("class"))
    return Options(**given), float(wait_s)


class ThrottledWarnings:
    """Each text, numbers aside, at most every five seconds of wall time."""

    def __init__(self):
        self._last_s = {}

    def warn(self, text, log=rospy.logwarn):
        """Logs a text unless it was logged just now."""
        kind = "".join(character for character in text if not character.isdigit())
        now_s = time.monotonic()
        if len(self._last_s) >= _MOST_WARNINGS:
            self._last_s.clear()
        if kind not in self._last_s or now_s - self._last_s[kind] >= _WARNING_PERIOD_S:
            self._last_s[kind] = now_s
            log(text)


class RelayNode:
    """Relays the topic `objects_in` to `objects`; with `map_as` also `map` to `map_out`."""

    def __init__(self):
        self._options, wait_s = options_of_parameters()
        self._options.check()
        self._lock = threading.Lock()
        self._converters = {}  # (type, md5sum) -> Converter, or the RelayError that came of it
        self._warnings = ThrottledWarnings()
        self._messages = self._published = self._objects = 0
        self._unreadable = 0  # messages of a type that cannot be relayed
        self._drops_told = 0
        self._to_target = self._listener = None
        if self._options.target_frame:
            self._to_target, self._listener = transforms.live(self._options.target_frame, wait_s)
        self._topic = rospy.resolve_name("objects_in")
        self._publisher = rospy.Publisher("objects", SemanticObjectArray, queue_size=_QUEUE)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
        self._exporter = self._options.exporter() if self._options.map_as else None
        if self._exporter:
            self._map_publisher = rospy.Publisher("map_out", self._exporter.message_class, queue_size=1, latch=True)
            rospy.Subscriber("map", SemanticMap, self._relay_map, queue_size=1)
        rospy.Subscriber("objects_in", rospy.AnyMsg, self._relay, queue_size=_QUEUE)
        self._timer = threading.Thread(target=self._report_forever, daemon=True)
        self._timer.start()

    def _relay(self, message):
        """Runs in the subscriber's thread."""
        received = rospy.Time.now()
        with self._lock:
            self._messages += 1
            try:
                converter = self._converter_of(message._connection_header)
                array = converter.convert(message._buff, received)
            except RelayError as error:
                self._unreadable += 1
                self._warnings.warn(str(error), rospy.logerr)
                return
            for line in converter.counts.lines(self._topic):
                self._warnings.warn(line)
            if array is not None:
                self._published += 1
                self._objects += len(array.objects)
        if array is not None:
            self._publisher.publish(array)

    def _converter_of(self, header):
        key = (header["type"], header["md5sum"])
        if key not in self._converters:
            try:
                kind = message_type(header["type"], header.get("message_definition", ""), header["md5sum"], self._topic)
                self._converters[key] = self._options.converter(kind, self._topic, self._to_target)
            except RelayError as error:
                self._converters[key] = error
        found = self._converters[key]
        if isinstance(found, RelayError):
            raise found
        return found

    def _relay_map(self, semantic_map):
        try:
            self._map_publisher.publish(self._exporter.write(semantic_map))
        except RelayError as error:
            self._warnings.warn(str(error), rospy.logerr)

    def _report_forever(self):
        """Diagnostics every second of wall time, whatever the clock of the bag does."""
        while not rospy.is_shutdown():
            time.sleep(1.0)
            array = DiagnosticArray(status=[self._status()])
            array.header.stamp = rospy.Time.now()
            try:
                self._diagnostics.publish(array)
            except rospy.ROSException:  # shutting down
                return

    def _status(self):
        with self._lock:
            errors = [str(found) for found in self._converters.values() if isinstance(found, RelayError)]
            converters = [found for found in self._converters.values() if not isinstance(found, RelayError)]
            drops = {cause: count for c in converters for cause, count in c.counts.by_cause.items()}
            quiet = {cause: count for c in converters for cause, count in c.counts.quiet.items()}
            values = {"messages": self._messages, "messages published": self._published, "objects": self._objects,
                      "messages of a type that cannot be relayed": self._unreadable}
        status = DiagnosticStatus(name=f"{rospy.get_name().lstrip('/')}: {self._topic}", hardware_id="none",
                                  level=DiagnosticStatus.OK, message="relaying")
        dropped = sum(drops.values())
        if errors:
            status.level, status.message = DiagnosticStatus.ERROR, errors[0]
        elif not values["messages"]:
            status.level, status.message = DiagnosticStatus.WARN, f"no message on {self._topic} yet"
        elif dropped > self._drops_told:
            status.level, status.message = DiagnosticStatus.WARN, max(drops, key=drops.get)
        self._drops_told = dropped
        status.values = [KeyValue(str(key), str(value)) for key, value in {**values, **drops, **quiet}.items()]
        return status


def run():
    """The node until it is shut down."""
    rospy.init_node("object_relay")
    node = RelayNode()  # noqa: F841: its subscribers live as long as it
    rospy.spin()
    del node
