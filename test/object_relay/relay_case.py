"""What the tests of the relay share: a folder of their own, a class table, bags, and the program."""
import contextlib
import functools
import io
import os
import runpy
import shutil
import sys
import tempfile
import unittest
from unittest import mock

import genpy
import rosbag
import roslib.packages
from samples import CLASS_TABLE


@functools.lru_cache(maxsize=None)
def installed_program():
    """The path of the program."""
    return roslib.packages.find_node("semantic_mht_slam", "object_relay")[0]


class RelayCase(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.table = self.write("classes.yaml", CLASS_TABLE)

    def path(self, name):
        """A path in the folder."""
        return os.path.join(self.folder, name)

    def write(self, name, text):
        """Writes a text file and gives its path."""
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def bag_of(self, messages, topic="/detections", name="in.bag"):
        """A bag with these messages at 1 s, 2 s, ... of receipt."""
        with rosbag.Bag(self.path(name), "w") as bag:
            for number, message in enumerate(messages):
                bag.write(topic, message, genpy.Time(number + 1))
        return self.path(name)

    def messages(self, bag, topic):
        """[(message, time of receipt)] of a topic."""
        with rosbag.Bag(bag) as opened:
            return [(message, stamp) for _, message, stamp in opened.read_messages(topics=[topic])]

    def relay(self, bag, *arguments, table=None):
        """Runs the program on a bag: (exit code, what it said), the output in out.bag."""
        return self.run_program("--bag", bag, "--output", self.path("out.bag"), "--class-table", table or self.table,
                                *arguments)

    def run_program(self, *arguments):
        """(exit code, what it said) of the program, run in this process: its imports take longer than its work."""
        said = io.StringIO()
        with mock.patch.object(sys, "argv", [installed_program(), *arguments]), contextlib.redirect_stdout(said), \
                contextlib.redirect_stderr(said):
            try:
                runpy.run_path(installed_program(), run_name="__main__")
            except SystemExit as end:
                if isinstance(end.code, str):
                    return 1, said.getvalue() + end.code
                return end.code or 0, said.getvalue()
        return 0, said.getvalue()

    def refused(self, bag, *arguments, table=None):
        """What the program says when it refuses: one line, exit code 1, and no output."""
        code, said = self.relay(bag, *arguments, table=table)
        self.assertEqual(code, 1, said)
        self.assertFalse(os.path.exists(self.path("out.bag")))
        self.assertEqual(len(said.strip().splitlines()), 1, said)
        self.assertEqual([name for name in os.listdir(self.folder) if ".tmp" in name], [])
        return said
