#!/usr/bin/python3
"""Runs the source checks, reads the JUnit files of a test run and prints every failure and the closing line.

usage: summarize_tests.py RESULTS_FOLDER REPOSITORY
Ends with "N passed, N failed, N skipped" and exit code 1 if anything failed or no test ran.
"""
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def source_checks(repository):
    """Yields (name, problem or None) for each script in .ci/checks."""
    for script in sorted((Path(repository) / ".ci" / "checks").iterdir()):
        run = subprocess.run([str(script)], cwd=repository, capture_output=True, text=True, check=False)
        yield f"check {script.stem}", None if run.returncode == 0 else run.stdout + run.stderr


def junit_cases(results):
    """Yields (name, "passed" | "failed" | "skipped", message) for each test case below a folder."""
    for path in sorted(Path(results).rglob("*.xml")):
        try:
            root = ElementTree.parse(path).getroot()
        except ElementTree.ParseError as error:
            yield path.name, "failed", f"unreadable result file: {error}"
            continue
        counted = sum(int(suite.get(kind) or 0) for suite in root.iter("testsuite") for kind in ("failures", "errors"))
        named = sum(1 for kind in ("failure", "error") for _ in root.iter(kind))
        if counted > named:
            yield path.name, "failed", f"{counted} failures, of which {named} have a test case"
        for case in root.iter("testcase"):
            name = f"{case.get('classname')}.{case.get('name')}"
            problem = case.find("failure") if case.find("failure") is not None else case.find("error")
            if problem is not None:
                yield name, "failed", (problem.get("message") or "") + (problem.text or "")
            elif case.find("skipped") is not None or case.get("result") == "skipped" or case.get("status") == "notrun":
                yield name, "skipped", ""
            else:
                yield name, "passed", ""


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    cases = list(junit_cases(sys.argv[1]))
    if not cases:
        print("no test ran")
        counts["failed"] += 1
    for name, problem in source_checks(sys.argv[2]):
        cases.append((name, "passed" if problem is None else "failed", problem))
    for name, outcome, message in cases:
        counts[outcome] += 1
        if outcome == "failed":
            print(f"FAILED {name}\n{message}")
    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return 1 if counts["failed"] else 0


sys.exit(main())
