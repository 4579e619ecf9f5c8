#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

#include "evaluate_commands.h"
#include "git_revision.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Compares results with the truth.\n"
    "\n"
    "usage: evaluate COMMAND [options]\n"
    "\n"
    "  trajectory    trajectories against true poses: absolute, relative and revisit errors\n"
    "  association   detections' landmarks against the true ones\n"
    "  loops         loop closures, or scores of pairs of frames, against true poses\n"
    "  landmarks     mapped landmarks against true ones\n"
    "  alignment     frames against an earlier map after drift, for growing offsets\n"
    "\n"
    "evaluate COMMAND --help tells the options of a command, evaluate --revision the git revision of the source.\n";

using Command = std::pair<std::string, int (*)(const std::vector<std::string>&)>;

const std::vector<Command>& commands() {
  static const std::vector<Command> list = {{"trajectory", evaluateTrajectory},
                                            {"association", evaluateAssociation},
                                            {"loops", evaluateLoops},
                                            {"landmarks", evaluateLandmarks},
                                            {"alignment", evaluateAlignment}};
  return list;
}

[[noreturn]] void refuse(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : commands()) names.push_back(command.first);
  const std::string known = joined(names) + " (see evaluate --help)";
  if (name == "benchmark") throw InputError("'benchmark' is a program: rosrun semantic_mht_slam benchmark --help");
  if (name == "hypotheses")
    throw InputError("'hypotheses' is a command of the program benchmark: benchmark hypotheses");
  if (name.empty()) throw InputError("a command is missing: one of " + known);
  const std::optional<std::string> meant = closest(name, names);
  if (meant) throw InputError("unknown command '" + name + "', did you mean '" + *meant + "'?");
  throw InputError("unknown command '" + name + "', known are " + known);
}

int evaluate(const std::vector<std::string>& arguments) {
  const std::string name = arguments.empty() ? "" : arguments.front();
  if (name == "--help" || name == "-h") {
    std::cout << kUsage;
    return 0;
  }
  if (name == "--revision") {
    std::cout << kGitRevision << "\n";
    return 0;
  }
  for (const auto& [known, run] : commands()) {
    if (known == name) return run({arguments.begin() + 1, arguments.end()});
  }
  refuse(name);
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram(
      "evaluate", [&] { return semantic_mht_slam::evaluate(std::vector<std::string>(argv + 1, argv + argc)); });
}
