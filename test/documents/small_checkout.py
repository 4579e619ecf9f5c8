"""A checkout of the scripts as they are, in which a test and an instrumented module take seconds: the package has one test,
and of the sources that the instrumented build of one target takes there is one file."""
import shutil
import subprocess

from documented import PACKAGE, REPOSITORY

CMAKE = f"""cmake_minimum_required(VERSION 3.16)
project({PACKAGE} CXX)
find_package(catkin REQUIRED)
catkin_package()
set(results ${{CATKIN_TEST_RESULTS_DIR}}/{PACKAGE})
catkin_run_tests_target("gtest" mapping_test gtest-mapping_test.xml
  COMMAND "cmake -E make_directory ${{results}}"
  "cp ${{CMAKE_CURRENT_SOURCE_DIR}}/result.xml ${{results}}/gtest-mapping_test.xml")
add_custom_target({PACKAGE}_generate_messages_cpp)
add_custom_target({PACKAGE}_gencfg)
"""
RESULT = '<testsuite failures="0" errors="0"><testcase classname="Mapping" name="maps"/></testsuite>'
SOURCE = """namespace semantic_mht_slam {
int doubled(int value) { return value * 2; }
}
"""
TEST = """#include <gtest/gtest.h>
namespace semantic_mht_slam { int doubled(int value); }
TEST(DoubledTest, isTwice) { EXPECT_EQ(semantic_mht_slam::doubled(2), 4); }
"""
FUZZER = """#include "fuzz/fuzz_target.h"
namespace semantic_mht_slam {
Rng::Rng(std::uint64_t seed) : seed_(seed) {}
double Rng::uniform() { return 0.0; }
int doubled(int value);
FuzzTarget trajectoryTarget() {
  return {"trajectory", [](const std::string& bytes) { return doubled(static_cast<int>(bytes.size())) > 0; }, {"seed"}};
}
}
"""


def make_small_checkout(folder):
    """Makes it in the folder, which is not there yet."""
    for name in ("cmake", "scripts", "src", "include", "test", "package.xml"):
        copy = shutil.copytree if (REPOSITORY / name).is_dir() else shutil.copy
        folder.mkdir(exist_ok=True)
        copy(REPOSITORY / name, folder / name)
    for emptied in ("src/common", "src/models", "src/io", "test/common"):
        shutil.rmtree(folder / emptied)
        (folder / emptied).mkdir()
    (folder / ".ci" / "checks").mkdir(parents=True)
    shutil.copy(REPOSITORY / ".ci" / "checks" / "sizes.py", folder / ".ci" / "checks")
    for name, text in {"CMakeLists.txt": CMAKE, "result.xml": RESULT, "src/common/doubled.cpp": SOURCE,
                       "test/common/doubled_test.cpp": TEST, "test/fuzz/trajectory_fuzz.cpp": FUZZER}.items():
        (folder / name).write_text(text, encoding="utf-8")
    subprocess.run(["git", "init", "--quiet", str(folder)], check=True)
