"""What a user chooses, live by private parameters and for bags by options of the same names."""
from dataclasses import dataclass, field
from typing import Dict

from .class_labels import load_class_table
from .conversion import Converter
from .mapping import load_mapping, mapping_for
from .map_export import MapExporter


@dataclass
class Options:
    """The choices; empty text: not chosen."""

    class_table: str = "classes_semantic_kitti.yaml"
    mapping: str = ""
    only_class: str = ""
    classes: Dict[str, object] = field(default_factory=dict)
    source_frame: str = ""
    target_frame: str = ""
    map_as: str = ""

    def converter(self, message_type, topic, to_target=None):
        """The Converter for a message type on a topic; RelayError if the choices do not fit it."""
        mapping = mapping_for(message_type.name, self.mapping, topic)
        return Converter(mapping, load_class_table(self.class_table), message_type, topic, renamed=self.classes,
                         only_class=self.only_class, source_frame=self.source_frame, to_target=to_target)

    def exporter(self):
        """The MapExporter of `map_as`."""
        return MapExporter(load_mapping(self.map_as), self.classes)

    def check(self):
        """RelayError for what is wrong whatever will arrive."""
        load_class_table(self.class_table)
        if self.mapping:
            load_mapping(self.mapping)
        if self.map_as:
            self.exporter()
