"""The scripts and programs of a checkout that README, CONTRIBUTING and docs name, run. Where everything is built already, as
they are written; those that test or build for minutes in a small checkout, with one small target."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from documented import PACKAGE, REPOSITORY, commands, needs_checkout
from small_checkout import make_small_checkout

LIMIT_S = 600
MAKE_S_OWN = ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")  # variables of the make that runs the tests
# command: what it says at its end
AS_WRITTEN = {
    "scripts/setup.sh --tests": r"^setup: (everything is built|building)",
    "scripts/setup.sh --benchmark": r"setup: everything is built",
    "scripts/demo.sh": r"error before .*\n.*\nreport +\S+/build/demo/result/report\.json",
    "scripts/count.sh": r"lines of C\+\+ outside test +\d+\n.*words of docs",
    "build/workspace/devel/lib/semantic_mht_slam/mapping_test --gtest_filter='FusionTest.*'": r"\[  PASSED  \] [1-9]\d* test",
    'source "$(cat build/location)/devel/setup.bash"': r"",
}
# command: what is run in its place in the small checkout, and what that says at its end
SMALL = {
    "scripts/test.sh": ("scripts/test.sh", r"2 passed, 0 failed, 0 skipped"),
    "scripts/test.sh mapping_test": ("scripts/test.sh mapping_test", r"2 passed, 0 failed, 0 skipped"),
}
INSTRUMENTED = {
    "scripts/fuzz.sh 60": ("scripts/fuzz.sh 1 trajectory", r"fuzz: trajectory executed [1-9]\d* inputs"),
    "scripts/sanitize.sh address": ("scripts/sanitize.sh address common", r"sanitize: common is clean"),
    "scripts/coverage.sh": ("scripts/coverage.sh 90 common", r"coverage: 100\.0 % of \d+ lines in 1 files"),
}


class ScriptsTest(unittest.TestCase):
    def check(self, command, folder, expected):
        """Runs it in the folder."""
        environment = {name: value for name, value in os.environ.items() if name not in MAKE_S_OWN}
        run = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, check=False, timeout=LIMIT_S)
        self.assertEqual(run.returncode, 0, f"{command}\n{run.stdout}")
        self.assertRegex(run.stdout, re.compile(expected, re.DOTALL), command)

    def small_checkout(self):
        folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        make_small_checkout(folder / "checkout")
        return folder / "checkout"

    def test_every_documented_one_is_run_here(self):
        documented = {command for _, command in commands() if needs_checkout(command)}
        self.assertEqual(documented, {*AS_WRITTEN, *SMALL, *INSTRUMENTED})

    @unittest.skipUnless((REPOSITORY / "build" / "location").exists(), "built by catkin_make, not by scripts/setup.sh")
    def test_what_works_on_a_built_checkout_does(self):
        for command, expected in AS_WRITTEN.items():
            with self.subTest(command=command):
                self.check(f"{command} && rospack find {PACKAGE}" if "source" in command else command, REPOSITORY, expected)

    @unittest.skipUnless(shutil.which("dpkg-query"), "scripts/setup.sh is for Debian")
    def test_tests_are_run_all_or_by_name(self):
        checkout = self.small_checkout()
        for command, expected in SMALL.values():
            with self.subTest(command=command):
                self.check(command, checkout, expected)
        self.check("! scripts/test.sh nothing_test", checkout, "no test of the name 'nothing_test'; there are:\nmapping_test")

    @unittest.skipUnless(shutil.which("clang++") and shutil.which("llvm-profdata"), "no clang or llvm here")
    def test_the_instrumented_build_fuzzes_sanitizes_and_counts(self):
        checkout = self.small_checkout()
        for command, expected in INSTRUMENTED.values():
            with self.subTest(command=command):
                self.check(command, checkout, expected)


if __name__ == "__main__":
    unittest.main()
