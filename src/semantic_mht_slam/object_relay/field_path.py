"""Paths to fields, such as `results[best].pose.covariance`: checked against a message type once, read for each object.

A segment is a field, with `[N]` for the N-th entry of an array, `[best]` for the entry with the largest score, or `[]` for
all entries. `a | b` takes the first of the paths that the type has.
"""
import re

from .errors import RelayError

_SEGMENT = re.compile(r"^(?P<name>[A-Za-z]\w*)(?:\[(?P<index>\d+|best|)\])?$")


class MissingValue(Exception):
    """An array has no entry where the path wants one; the text is the path so far."""


class Step:
    """One segment: the attribute, and None, a number, "best" or "all" for the entry of an array."""

    def __init__(self, text, path):
        match = _SEGMENT.match(text)
        if not match:
            raise RelayError(f"'{path}' is no path to a field (examples: pose.position, results[0].id, boxes[].label)")
        self.name = match.group("name")
        index = match.group("index")
        self.index = {None: None, "": "all", "best": "best"}.get(index, index)
        if self.index not in (None, "all", "best"):
            self.index = int(self.index)


class FieldPath:
    """A path that fits a message type. `field_type` is the type of what it leads to."""

    def __init__(self, text, steps, field_type, best_by):
        self.text = text
        self.steps = steps
        self.field_type = field_type
        self._best_by = best_by

    def read(self, message):
        """The value in this message; a list for a path with `[]`. MissingValue where an array is too short."""
        return self._read(message, 0)

    def _read(self, value, at):
        for number in range(at, len(self.steps)):
            step = self.steps[number]
            value = getattr(value, step.name)
            if step.index == "all":
                return [self._read(entry, number + 1) for entry in value]
            if step.index is not None:
                if not len(value) > (step.index if step.index != "best" else 0):
                    raise MissingValue(".".join(s.name for s in self.steps[:number + 1]))
                value = max(value, key=self._best_by.read) if step.index == "best" else value[step.index]
        return value


def bind(text, message_type, type_name, where, best_by=None):
    """The FieldPath of `text` from a message type on; RelayError with `where` in front if no alternative fits.

    `best_by`: path from an entry to its score, needed for `[best]`.
    """
    problems = []
    for alternative in (part.strip() for part in text.split("|")):
        try:
            return _bind_one(alternative, message_type, type_name, best_by)
        except RelayError as error:
            problems.append(str(error))
    raise RelayError(f"{where}: {'; '.join(problems)}")


def _bind_one(text, message_type, type_name, best_by):
    steps = [Step(segment, text) for segment in text.split(".")]
    current = None
    owner = type_name
    score = None
    for step in steps:
        fields = message_type.fields(owner)
        if fields is None:
            raise RelayError(f"'{text}': {owner} has no field '{step.name}', it is a plain value")
        if step.name not in fields:
            raise RelayError(f"'{text}': {owner} has no field '{step.name}' (it has {', '.join(fields)})")
        current = fields[step.name]
        if step.index is not None:
            if not current.is_array:
                raise RelayError(f"'{text}': '{step.name}' of {owner} is {current}, no array")
            current = current.element()
            if step.index == "best":
                if not best_by:
                    raise RelayError(f"'{text}': [best] needs 'best_by', the score of an entry of '{step.name}'")
                score = bind(best_by, message_type, current.base, "best_by")
        elif current.is_array and step is not steps[-1]:
            raise RelayError(f"'{text}': '{step.name}' of {owner} is an array ({current}): say which entry, as in"
                             f" {step.name}[0] or {step.name}[best]")
        owner = current.base
    return FieldPath(text, steps, current, score)
