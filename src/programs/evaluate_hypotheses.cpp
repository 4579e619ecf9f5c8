#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/violin_plot.h"
#include "semantic_mht_slam/io/text_file.h"

#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kUsage =
    "How many hypotheses lived in each frame, by the report.json of runs.\n"
    "\n"
    "usage: evaluate hypotheses --report NAME=FILE [--report NAME=FILE ...] [--json] [--output DIR]\n";

Violin readViolin(const std::string& argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos) throw InputError("--report " + argument + ": NAME=FILE was expected");
  const std::string path = argument.substr(equals + 1);
  std::map<double, double> counts;
  try {
    const nlohmann::json json = nlohmann::json::parse(readFile(path));
    for (const auto& [value, frames] : json.at("hypotheses").at("frames_with").items()) {
      counts[std::stod(value)] = frames.get<double>();
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": no report of a run (" + error.what() + ")");
  }
  return {argument.substr(0, equals), {counts.begin(), counts.end()}};
}

}  // namespace

int evaluateHypotheses(const std::vector<std::string>& arguments) {
  std::vector<std::string> reports;
  std::string folder;
  bool as_json = false;
  po::options_description options("options");
  options.add_options()("report", po::value(&reports)->required()->multitoken()->composing(), "name and report.json")(
      "json", po::bool_switch(&as_json), "print JSON in place of a table")(
      "output", po::value(&folder), "folder for hypotheses.json and hypotheses.svg");
  if (!parseOrHelp(arguments, kUsage, options)) return 0;
  std::vector<Violin> violins;
  nlohmann::json json = nlohmann::json::object();
  std::string table;
  for (const std::string& argument : reports) {
    violins.push_back(readViolin(argument));
    const double mean = meanOf(violins.back());
    json[violins.back().label] = {{"mean", mean}};
    table += violins.back().label + " " + figure(mean, 2) + "\n";
  }
  report(as_json, json, table, folder,
         {{"hypotheses.json", jsonText(json)},
          {"hypotheses.svg", svgPlot(violinPlot("Hypotheses that live in a frame", "hypotheses", violins))}});
  return 0;
}

}  // namespace semantic_mht_slam
