"""docs/object_relay.md and the presets say the same."""
import os
import re
import unittest

import yaml

from semantic_mht_slam.object_relay.mapping import mapping_of, presets

DOCUMENT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "docs", "object_relay.md")


class DocumentsTest(unittest.TestCase):
    def setUp(self):
        with open(DOCUMENT, encoding="utf-8") as file:
            self.text = file.read()

    def test_every_preset_is_in_the_table_with_its_types(self):
        for name, mapping in presets().items():
            row = re.search(rf"^\|.*`{name}`.*\|$", self.text, re.MULTILINE)
            self.assertIsNotNone(row, name)
            for kind in mapping.types:
                self.assertIn(kind.split("/")[1], row.group(0))

    def test_the_example_has_every_key_and_is_a_mapping(self):
        example = yaml.safe_load(re.search(r"```yaml\n(.*?)```", self.text, re.DOTALL).group(1))
        mapping = mapping_of(example, "my.yaml")
        unset = [name for name, value in vars(mapping).items() if not value]
        self.assertEqual(unset, ["definition"], "every key is shown")


if __name__ == "__main__":
    unittest.main()
