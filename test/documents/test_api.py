"""The example of docs/api.md is the file of examples, and a package that is built as the page says runs it."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def block(language):
    """The first block of a language on the page."""
    page = (REPOSITORY / "docs" / "api.md").read_text(encoding="utf-8")
    return re.search(rf"```{language}\n(.*?)```", page, re.DOTALL).group(1)


class ApiTest(unittest.TestCase):
    def test_the_page_shows_the_file(self):
        example = (REPOSITORY / "examples" / "embedded_slam.cpp").read_text(encoding="utf-8")
        self.assertEqual(block("cpp"), example)
        self.assertLessEqual(len(example.splitlines()), 40)

    def test_a_package_made_as_the_page_says_maps_without_ros(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        build = os.path.join(folder, "build")
        shutil.copy(REPOSITORY / "examples" / "embedded_slam.cpp", folder)
        Path(folder, "CMakeLists.txt").write_text(block("cmake"), encoding="utf-8")
        Path(folder, "package.xml").write_text(
            "<package format='2'><name>my_package</name><version>1.0.0</version><description>d</description>"
            "<maintainer email='a@b.cd'>m</maintainer><license>BSD</license><buildtool_depend>catkin</buildtool_depend>"
            "<depend>semantic_mht_slam</depend></package>", encoding="utf-8")
        for command in (["cmake", "-S", folder, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                         "-DPYTHON_EXECUTABLE=/usr/bin/python3"], ["cmake", "--build", build]):
            made = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
            self.assertEqual(made.returncode, 0, made.stdout)
        program = next(Path(build).rglob("embedded_slam"))
        while program.is_dir():
            program = next(program.rglob("embedded_slam"))
        environment = {name: value for name, value in os.environ.items() if name != "ROS_MASTER_URI"}
        said = subprocess.run([str(program)], capture_output=True, text=True, check=True, env=environment).stdout.splitlines()
        self.assertEqual(said[-1], "200 poses")
        poles = [tuple(map(float, line.split()[1:])) for line in said[:-1]]
        self.assertTrue(all(line.startswith("pole ") for line in said[:-1]))
        self.assertGreater(len(poles), 20)
        for x_m, y_m, _ in poles:
            self.assertLess(abs(x_m - 8.0 * round(x_m / 8.0)) + abs(y_m - (6.0 if round(x_m / 8.0) % 2 == 0 else -5.0)), 0.5)


if __name__ == "__main__":
    unittest.main()
