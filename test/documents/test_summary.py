"""The last line of a test run: what failed is said, also by a result file that names no test case for it."""
import subprocess
import tempfile
import unittest
from pathlib import Path

SUMMARIZE = Path(__file__).resolve().parents[2] / "scripts" / "summarize_tests.py"
CASE = '<testcase classname="A" name="one"/>'
SKIPPED = '<testcase classname="A" name="two"><skipped/></testcase>'
FAILED = '<testcase classname="A" name="three"><failure message="no"/></testcase>'


class SummaryTest(unittest.TestCase):
    def summary(self, *files):
        """(exit code, last line) for result files of these contents."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "results").mkdir()
            (Path(folder) / ".ci" / "checks").mkdir(parents=True)
            for i, text in enumerate(files):
                (Path(folder) / "results" / f"{i}.xml").write_text(text, encoding="utf-8")
            run = subprocess.run([str(SUMMARIZE), folder + "/results", folder], stdout=subprocess.PIPE, text=True, check=False)
        return run.returncode, run.stdout.splitlines()[-1]

    def test_cases_are_counted(self):
        suite = f'<testsuite failures="0" errors="0">{CASE}{SKIPPED}</testsuite>'
        self.assertEqual(self.summary(suite, suite), (0, "2 passed, 0 failed, 2 skipped"))
        self.assertEqual(self.summary(f'<testsuites failures="1"><testsuite failures="1">{FAILED}</testsuite></testsuites>'),
                         (1, "0 passed, 1 failed, 0 skipped"))

    def test_failures_without_a_case_fail(self):
        self.assertEqual(self.summary(f'<testsuite failures="7" errors="0">{CASE}</testsuite>'),
                         (1, "1 passed, 1 failed, 0 skipped"))

    def test_nothing_and_half_a_file_fail(self):
        self.assertEqual(self.summary(), (1, "0 passed, 1 failed, 0 skipped"))
        self.assertEqual(self.summary("<testsuite"), (1, "0 passed, 1 failed, 0 skipped"))


if __name__ == "__main__":
    unittest.main()
