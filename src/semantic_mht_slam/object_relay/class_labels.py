"""From the labels of a detector to the ids of a class table."""
import os

from .errors import RelayError
from .mapping import package_config, read_yaml


class IgnoredLabel(Exception):
    """A label that the user wants left out."""


class UnknownLabel(Exception):
    """A label that stands neither in the mapping nor in the class table."""


def normalized(label):
    """Labels differ in case, blanks and hyphens only by habit: 'Traffic Light' is 'traffic_light'."""
    return "_".join(str(label).strip().lower().replace("-", " ").replace("_", " ").split())


class ClassTable:
    """Ids and names of classes. `origin` names where they come from in errors."""

    def __init__(self, names, origin):
        """names: {id: name}."""
        self.origin = origin
        self._names = dict(names)
        self._ids = {normalized(name): class_id for class_id, name in self._names.items()}

    def id_of(self, label):
        """The id of a name or an id (a number, or text that is one); None if the table has neither."""
        if not isinstance(label, bool) and isinstance(label, int):
            return label if label in self._names else None
        name = normalized(label)
        if name in self._ids:
            return self._ids[name]
        return int(name) if name.isdecimal() and int(name) in self._names else None

    def name_of(self, class_id):
        """The name of an id of the table."""
        return self._names[class_id]

    def described(self):
        """The classes in one line, for messages."""
        return ", ".join(f"{class_id} {name}" for class_id, name in self._names.items())


def load_class_table(path):
    """The ClassTable of a file; RelayError that names it."""
    path = path if os.path.isabs(path) or os.path.exists(path) else package_config(path)
    content = read_yaml(path)
    rows = content.get("classes") if isinstance(content, dict) else None
    if not isinstance(rows, list) or not rows:
        raise RelayError(f"{path}: no class table: it has no list 'classes'")
    names = {}
    for row in rows:
        if not isinstance(row, dict) or not isinstance(row.get("id"), int) or not isinstance(row.get("name"), str):
            raise RelayError(f"{path}: a class needs an integer 'id' and a 'name': {row}")
        if not 0 <= row["id"] <= 65535:
            raise RelayError(f"{path}: id {row['id']} of class '{row['name']}' is not in [0, 65535]")
        names[row["id"]] = row["name"]
    return ClassTable(names, path)


class ClassLabels:
    """Looks the labels of one kind of message up, in this order: what the user renamed, the numbers that the message
    type defines (`classes` of the mapping), the class table, the names that the mapping renames."""

    def __init__(self, table, of_mapping, of_user, where):
        """of_mapping, of_user: {label: name or id of the table, or None for labels to leave out}. A target of the user
        that the table lacks is a RelayError; one of the mapping is an unknown label once an object has it, for a mapping
        is written for more classes than one table has."""
        self._table = table
        self._user = {normalized(label): target for label, target in of_user.items()}
        self._mapping = {normalized(label): target for label, target in of_mapping.items()}
        for label, target in of_user.items():
            if target is not None and table.id_of(target) is None:
                raise RelayError(f"{where}: classes: '{label}' is to be '{target}', which is not in {table.origin}"
                                 f" ({table.described()})")

    def id_of(self, label):
        """The class id of a detector's label (text or number); raises IgnoredLabel or UnknownLabel."""
        key = normalized(label)
        if key in self._user:
            return self._target(label, self._user[key])
        if key in self._mapping and key.isdecimal():
            return self._target(label, self._mapping[key])
        class_id = self._table.id_of(label)
        if class_id is not None:
            return class_id
        if key in self._mapping:
            return self._target(label, self._mapping[key])
        raise UnknownLabel(f"'{label}'")

    def _target(self, label, target):
        if target is None:
            raise IgnoredLabel(str(label))
        class_id = self._table.id_of(target)
        if class_id is None:
            raise UnknownLabel(f"'{label}' ({target})")
        return class_id

    def label_of(self, class_id, is_number):
        """The detector's label of a class id, a number or a name: the first that is renamed to it, else the table's."""
        for renamed in (self._user, self._mapping):
            for label, target in renamed.items():
                if target is not None and label.isdecimal() == is_number and self._table.id_of(target) == class_id:
                    return int(label) if is_number else label
        return class_id if is_number else self._table.name_of(class_id)
