#!/usr/bin/python3
"""Runs the tests test_*.py of a folder and writes a JUnit file.

usage: run_python_tests.py FOLDER RESULT.xml
"""
import os
import sys
import unittest

import rosunit


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    folder, result = sys.argv[1:]
    os.makedirs(os.path.dirname(result), exist_ok=True)
    suite = unittest.defaultTestLoader.discover(folder)
    outcome = rosunit.create_xml_runner("semantic_mht_slam", os.path.basename(folder), results_file=result).run(suite)
    return 0 if outcome.wasSuccessful() else 1


sys.exit(main())
