#include "semantic_mht_slam/ros/doctor.h"

#include <iostream>
#include <string>

#include <ros/ros.h>

#include "semantic_mht_slam/common/error.h"

#include "program.h"

namespace {

constexpr char kUsage[] =
    "Looks at a running system and names the first thing that is wrong, and the fix.\n"
    "  rosrun semantic_mht_slam doctor [options]\n"
    "Exit code 0: no fault; the rates are printed, and what may not be meant; 1: something is wrong.\n";

int run(int argc, char** argv) {
  using namespace semantic_mht_slam;
  ros::init(argc, argv, "doctor", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  arguments.erase(arguments.begin());
  std::string node = "/slam_node";
  double watch_s = 5.0;
  boost::program_options::options_description options("options");
  options.add_options()("node", boost::program_options::value(&node), "name of the SLAM node, default /slam_node");
  options.add_options()("seconds", boost::program_options::value(&watch_s),
                        "how long to look, in seconds of wall time, default 5");
  if (!parseOrHelp(arguments, kUsage, options)) return 0;
  if (!(watch_s >= 1.5 && watch_s <= 3600.0)) throw InputError("--seconds must be in [1.5, 3600]");
  if (node.empty()) throw InputError("--node is empty");
  if (node.front() != '/') node.insert(0, "/");

  const SystemObservation system = observeSystem(node, watch_s);
  if (const auto problem = firstProblem(system)) {
    std::cout << "problem: " << problem->problem << "\nfix:     " << problem->fix << "\n";
    return 1;
  }
  const std::vector<std::string> notes = notesOf(system);
  std::cout << (notes.empty() ? "all well\n" : "no fault, but see whether this is meant\n");
  for (const std::string& note : notes) std::cout << "note: " << note << "\n";
  std::cout << summaryOf(system);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("doctor", [&] { return run(argc, argv); });
}
