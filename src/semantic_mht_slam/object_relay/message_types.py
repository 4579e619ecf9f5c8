"""Message types from the definitions that connections and bags carry."""
import re

import genpy.dynamic
from genmsg import InvalidMsgSpec

from .errors import RelayError

_SLOT_TYPE = re.compile(r"^(?P<base>[^\[\]]+)(?P<array>\[(?P<length>\d*)\])?$")
STRINGS = {"string"}
INTEGERS = {"bool", "byte", "char"} | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
NUMBERS = INTEGERS | {"float32", "float64"}


class UnfitMessage(Exception):
    """Bytes that are no message of a type."""


class FieldType:
    """The type of a field: its name, whether it is an array, and the fixed length of the array or None."""

    def __init__(self, text):
        match = _SLOT_TYPE.match(text)
        self.base = match.group("base")
        self.is_array = match.group("array") is not None
        self.length = int(match.group("length")) if match.group("length") else None

    def element(self):
        """The type of one entry of this array."""
        return FieldType(self.base)

    def __str__(self):
        return self.base + (f"[{self.length or ''}]" if self.is_array else "")


class MessageType:
    """A message class together with the classes of everything in it."""

    def __init__(self, name, classes):
        self.name = name
        self.root = classes[name]
        self._classes = classes

    def fields(self, type_name):
        """{field: FieldType} of a message type; None for a primitive one."""
        message_class = self._classes.get(type_name)
        if message_class is None:
            return None
        return {name: FieldType(text) for name, text in zip(message_class.__slots__, message_class._slot_types)}

    def make(self, type_name):
        """An empty message of a type that occurs in this one."""
        return self._classes[type_name]()

    def parse(self, data):
        """The message of its serialized bytes."""
        try:
            return self.root().deserialize(data)
        except Exception as error:  # by what is broken: genpy's, struct's, of decoding, of memory
            raise UnfitMessage(type(error).__name__) from error


def message_type(name, definition, md5sum, where):
    """The MessageType of a definition as connection headers carry it.

    `where` names the topic in errors. `md5sum`: what the definition must give; "*" or empty: whatever it gives.
    """
    if not definition.strip():
        raise RelayError(f"{where}: the publisher of {name} sends no message definition along (rosserial and some bridges"
                         " do not): record the topic with rosbag on a machine that has the package and relay the bag")
    try:
        classes = genpy.dynamic.generate_dynamic(name, definition)
    except (InvalidMsgSpec, genpy.dynamic.MsgGenerationException, KeyError, ValueError, SyntaxError) as error:
        raise RelayError(f"{where}: the message definition of {name} that came with it is broken: {error}") from error
    built = classes[name]._md5sum
    if md5sum not in ("", "*", built):
        raise RelayError(f"{where}: the message definition of {name} has md5sum {built}, its connection says {md5sum}:"
                         " publisher and definition are of different versions of the message; rebuild the publisher")
    return MessageType(name, classes)
