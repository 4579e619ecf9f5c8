#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/g2o_file.h"
#include "semantic_mht_slam/io/text_file.h"

#include "support/run_program.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

/// A square of four sides of 1 m that is closed once rightly, between 0 and 3, and once wrongly, between 0 and 2.
const char* const kSquare =
    "EDGE_SE2 0 1 1.02 0 1.5707963 100 0 0 100 0 400\n"
    "EDGE_SE2 1 2 0.99 0.01 1.5707963 100 0 0 100 0 400\n"
    "EDGE_SE2 2 3 1 0 1.5707963 100 0 0 100 0 400\n"
    "EDGE_SE2 3 4 1 -0.01 1.5707963 100 0 0 100 0 400\n"
    "EDGE_SE2 4 0 0 0 0 100 0 0 100 0 400\n"
    "EDGE_SE2 3 0 1 0 1.5707963 100 0 0 100 0 400\n"
    "EDGE_SE2 2 0 40 3 1 100 0 0 100 0 400\n";

class OptimizeG2oTest : public ::testing::Test {
 protected:
  OptimizeG2oTest() { writeFileAtomically(input_, kSquare); }

  std::string files() const { return "'" + input_ + "' --output '" + output_ + "' --report '" + report_ + "' "; }

  ProgramResult run(const std::string& arguments) const { return runProgramOfPackage("optimize_g2o", arguments); }

  /// Expects exit code 1, one line that begins with the program's name and holds `part`, and no output file.
  void expectRefused(const std::string& arguments, const std::string& part) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments << "\n" << result.output;
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
    EXPECT_EQ(result.output.rfind("optimize_g2o: ", 0), 0U) << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << result.output << "lacks: " << part;
    EXPECT_FALSE(std::filesystem::exists(output_)) << arguments << ": something was written";
  }

  /// Text of a number or word of the report, up to the comma or the end of the line.
  std::string field(const std::string& name) const {
    const std::string text = readFile(report_);
    const std::size_t begin = text.find("\"" + name + "\": ");
    if (begin == std::string::npos) return "no such field";
    const std::size_t value = begin + name.size() + 4;
    return text.substr(value, text.find_first_of(",\n", value) - value);
  }

  const TemporaryFolder folder_;
  const std::string input_ = folder_ / "a graph.g2o";
  const std::string output_ = folder_ / "optimised.g2o";
  const std::string report_ = folder_ / "report.json";
};

TEST_F(OptimizeG2oTest, HelpNamesEveryOptionAndEndsWithCode0) {
  const ProgramResult result = run("--help");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* option :
       {"--output", "--report", "--robust", "--keep-all-loops", "--max-iterations", "--project-information"}) {
    EXPECT_NE(result.output.find(option), std::string::npos) << option;
  }
}

TEST_F(OptimizeG2oTest, BadCommandLinesAreRefused) {
  expectRefused("", "no input file");
  expectRefused("'" + input_ + "'", "--output is missing");
  expectRefused(files() + "--robust huber", "'huber'");
  expectRefused(files() + "--max-iterations -1", "--max-iterations");
  expectRefused(files() + "--max-iterations x", "max-iterations");
  expectRefused(files() + "--outptu x", "outptu");
  expectRefused(files() + "'" + input_ + "'", "positional");
  expectRefused("'" + input_ + "' --outp '" + output_ + "'", "outp");
}

TEST_F(OptimizeG2oTest, BadFilesAreNamedAndNothingIsWritten) {
  expectRefused("/no/such.g2o --output '" + output_ + "'", "/no/such.g2o");
  writeFileAtomically(input_, std::string(kSquare) + "EDGE_SE2 3 4 1 nan 0 1 0 0 1 0 1\n");
  expectRefused(files(), "a graph.g2o:8: EDGE_SE2 3 4: 'nan'");
  writeFileAtomically(input_, "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 5 6 1 0 0 1 0 0 1 0 1\n");
  expectRefused(files(), "a graph.g2o: ");
  writeFileAtomically(input_, "EDGE_SE2 0 1 1 0 0  1 2 0 1 0 1\n");
  expectRefused(files(), "EDGE_SE2 0 1: the information matrix is not positive definite");
  EXPECT_FALSE(std::filesystem::exists(report_));
}

TEST_F(OptimizeG2oTest, OutputThatCannotBeWrittenIsNamed) {
  expectRefused("'" + input_ + "' --output /no/such/folder/o.g2o", "/no/such/folder/o.g2o");
}

TEST_F(OptimizeG2oTest, IndefiniteInformationIsRepairedOnRequestAndReported) {
  writeFileAtomically(input_, "EDGE_SE2 0 1 1 0 0  1 2 0 1 0 1\n");
  const ProgramResult result = run(files() + "--project-information");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("1 information matrices repaired"), std::string::npos) << result.output;
  EXPECT_NE(readFile(report_).find("a graph.g2o:1: EDGE_SE2 0 1"), std::string::npos);
}

TEST_F(OptimizeG2oTest, ReportHoldsEveryField) {
  ASSERT_EQ(run(files()).exit_code, 0);
  EXPECT_EQ(field("vertices"), "5");
  EXPECT_EQ(field("points"), "0");
  EXPECT_EQ(field("edges"), "7");
  EXPECT_EQ(field("converged"), "true");
  EXPECT_EQ(field("rejected_loops"), "[]");
  EXPECT_EQ(field("projected_edges"), "[]");
  EXPECT_LT(std::stod(field("final_cost")), std::stod(field("initial_cost")));
  EXPECT_LE(std::stod(field("final_cost")), std::stod(field("start_cost")));
  EXPECT_EQ(field("accepted_cost"), field("final_cost"));
  EXPECT_GE(std::stoi(field("iterations")), 1);
  EXPECT_GE(std::stod(field("seconds")), 0.0);
  EXPECT_GE(std::stod(field("cpu_seconds")), 0.0);
  EXPECT_TRUE(field("start") == "\"chordal\"" || field("start") == "\"given\"") << field("start");
}

TEST_F(OptimizeG2oTest, RobustRunNamesTheWrongLoopClosureAndKeepsTheRightOnes) {
  const ProgramResult result = run(files() + "--robust cauchy");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("1 loop closures rejected"), std::string::npos) << result.output;
  EXPECT_EQ(field("from"), "2");
  EXPECT_EQ(field("to"), "0");
  EXPECT_GT(std::stod(field("mahalanobis_sq")), 100.0);
  EXPECT_LT(std::stod(field("accepted_cost")), 10.0);
  EXPECT_GT(std::stod(field("final_cost")), 50.0);
  ASSERT_EQ(run(files() + "--robust cauchy --keep-all-loops").exit_code, 0);
  EXPECT_EQ(field("rejected_loops"), "[]");
}

/// Several thousand poses on a helix with loop closures between its turns: large enough for threads to be worth it.
std::string helix() {
  std::string text;
  const std::string information = " 100 0 0 0 0 0 100 0 0 0 0 100 0 0 0 400 0 0 400 0 400\n";
  for (int i = 0; i + 1 < 1500; ++i) {
    const double wobble = 0.01 * ((i * 37) % 11 - 5);
    const auto name = [](int id) { return " " + std::to_string(id); };
    text += "EDGE_SE3:QUAT" + name(i) + name(i + 1) + " 1 " + std::to_string(wobble) + " 0.02 0 0 0.0627905 0.9980267" +
            information;
    if (i >= 50) {
      text += "EDGE_SE3:QUAT" + name(i - 50) + name(i) + " " + std::to_string(wobble) + " 0 1 0 0 0 1" + information;
    }
  }
  return text;
}

TEST_F(OptimizeG2oTest, OneThreadAndTwoThreadsAndASecondRunWriteTheSameBytes) {
  writeFileAtomically(input_, helix());
  std::string first;
  for (const char* threads : {"1", "2", "2"}) {
    ASSERT_EQ(::setenv("OMP_NUM_THREADS", threads, 1), 0);
    const ProgramResult result = run(files() + "--robust cauchy");
    ::unsetenv("OMP_NUM_THREADS");
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const std::string text = readFile(output_);
    EXPECT_EQ(std::get<BatchGraph<3>>(parseG2o(text, output_).graph).poses.size(), 1500U);
    if (first.empty()) first = text;
    EXPECT_TRUE(text == first) << threads << " threads";
  }
}

}  // namespace
}  // namespace semantic_mht_slam
