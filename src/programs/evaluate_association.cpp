#include <string>
#include <vector>

#include "semantic_mht_slam/evaluation/association_score.h"

#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "evaluate_rows.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kAssociationUsage =
    "How well detections were assigned to landmarks: precision, recall and F1 of \"these two detections are the same\n"
    "landmark\" over all pairs, and over pairs within windows of 300 frames (local).\n"
    "\n"
    "usage: evaluate association --truth objects_landmark.csv --associations associations.csv [--json] [--output "
    "DIR]\n";

nlohmann::json toJson(const PairwiseScore& score) {
  return {{"precision", score.precision}, {"recall", score.recall}, {"f1", score.f1}};
}

nlohmann::json toJson(const AssociationScore& score) {
  return {{"all", toJson(score.all)},
          {"local", toJson(score.local)},
          {"scored_detections", score.scored_detections},
          {"true_detections", score.true_detections},
          {"clutter_accepted", score.clutter_accepted},
          {"static_rejected", score.static_rejected}};
}

std::string line(const std::string& name, const PairwiseScore& score) {
  return name + " precision " + figure(score.precision, 4) + " recall " + figure(score.recall, 4) + " f1 " +
         figure(score.f1, 4) + "\n";
}

std::string table(const AssociationScore& score) {
  return line("all   ", score.all) + line("local ", score.local) + "detections " +
         std::to_string(score.scored_detections) + " of " + std::to_string(score.true_detections) +
         "; clutter accepted " + figure(score.clutter_accepted, 3) + "; static rejected " +
         figure(score.static_rejected, 4) + "\n";
}

}  // namespace

int evaluateAssociation(const std::vector<std::string>& arguments) {
  std::string truth_path;
  std::string associations_path;
  std::string folder;
  bool as_json = false;
  po::options_description options("options");
  options.add_options()("truth", po::value(&truth_path)->required(),
                        "CSV frame,landmark, a row a detection; -1 clutter, -2 moving")(
      "associations", po::value(&associations_path)->required(),
      "CSV frame,row,landmark; the row counts the detections of a frame from 0; -1 false positive")(
      "json", po::bool_switch(&as_json), "print JSON in place of a table")("output", po::value(&folder),
                                                                           "folder for association.json");
  if (!parseOrHelp(arguments, kAssociationUsage, options)) return 0;

  const std::vector<TrueDetection> truth = readTrueDetections(truth_path);
  const std::vector<AssociatedDetection> associations = readAssociations(associations_path);
  AssociationScore score;
  withFileName(associations_path, [&] { score = associationScore(truth, associations); });
  const nlohmann::json json = toJson(score);
  report(as_json, json, table(score), folder, {{"association.json", jsonText(json)}});
  return 0;
}

}  // namespace semantic_mht_slam
