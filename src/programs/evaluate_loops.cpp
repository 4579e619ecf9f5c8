#include <string>
#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/evaluation/loop_score.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "evaluate_rows.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kLoopsUsage =
    "Loop closures, or scores of pairs of frames, against true poses.\n"
    "\n"
    "usage: evaluate loops --poses poses.txt --closures loop_closures.csv [--calib calib.txt] [--json] [--output DIR]\n"
    "       evaluate loops --poses poses.txt --pairs scores.csv [--json] [--output DIR]\n"
    "\n"
    "  closures  precision of the accepted ones (right: translation wrong by less than 2 m) and share of the "
    "revisited\n"
    "            blocks of 10 frames with a right one within 100 frames\n"
    "  pairs     F1max and extended precision of the scores; positive < 3 m, negative > 20 m\n";

struct LoopsOptions {
  std::string poses_path;
  std::string closures_path;
  std::string pairs_path;
  std::string calibration_path;
  std::string folder;
  bool as_json = false;
};

std::vector<PairEstimate> readPairs(const std::string& path) {
  std::vector<PairEstimate> pairs;
  const auto add = [&](const CsvRow& row) { pairs.push_back({row.integer(0), row.integer(1), row.number(2)}); };
  printNotice("evaluate", CsvReader({"i", "j", "score"}).read(path, add));
  return pairs;
}

void scoreClosures(const LoopsOptions& options) {
  const std::string calibration_path =
      options.calibration_path.empty() ? calibrationBeside(options.poses_path) : options.calibration_path;
  const std::vector<Pose> poses =
      inVelodyneFrame(readKittiTrajectory(options.poses_path), readCalibration(calibration_path));
  const std::vector<ClosureEstimate> closures = readClosures(options.closures_path);
  ClosureScore score;
  withFileName(options.closures_path, [&] { score = closureScore(poses, closures); });
  const nlohmann::json json = {{"checked", closures.size()},
                               {"accepted", score.accepted},
                               {"wrong", score.wrong},
                               {"precision", score.precision},
                               {"revisited_blocks", score.revisited_blocks},
                               {"covered_blocks", score.covered_blocks},
                               {"recall", score.recall}};
  const std::string table = "accepted " + std::to_string(score.accepted) + ", wrong " + std::to_string(score.wrong) +
                            ", precision " + figure(score.precision, 3) +
                            ", revisited blocks with a closure within 100 frames " +
                            std::to_string(score.covered_blocks) + "/" + std::to_string(score.revisited_blocks) +
                            " = " + figure(score.recall, 3) + "\n";
  report(options.as_json, json, table, options.folder, {{"loops.json", jsonText(json)}});
}

Plot precisionRecallPlot(const PairScore& score) {
  Plot plot;
  plot.title = "Precision and recall of scene scores";
  plot.x_label = "recall [-]";
  plot.y_label = "precision [-]";
  plot.y_from_zero = true;
  PlotSeries series;
  series.x = score.recall;
  series.y = score.precision;
  plot.series.push_back(series);
  return plot;
}

void scorePairs(const LoopsOptions& options) {
  std::vector<Eigen::Vector2d> positions_m;  // the ground plane of the camera frame: x right, z forward
  for (const Pose& pose : readKittiTrajectory(options.poses_path)) {
    positions_m.emplace_back(pose.translation_m.x(), pose.translation_m.z());
  }
  const std::vector<PairEstimate> pairs = readPairs(options.pairs_path);
  PairScore score;
  withFileName(options.pairs_path, [&] { score = pairScore(positions_m, pairs); });
  if (score.positives == 0) throw InputError(options.pairs_path + ": no pair is less than 3 m apart, nothing to score");
  const nlohmann::json json = {{"pairs", score.pairs},
                               {"positives", score.positives},
                               {"f1_max", score.f1_max},
                               {"extended_precision", score.extended_precision},
                               {"recall_at_p100", score.recall_at_p100}};
  const std::string table = "pairs " + std::to_string(score.pairs) + " positives " + std::to_string(score.positives) +
                            " F1max " + figure(score.f1_max, 4) + " EP " + figure(score.extended_precision, 4) +
                            " R@P100 " + figure(score.recall_at_p100, 4) + "\n";
  report(options.as_json, json, table, options.folder,
         {{"pairs.json", jsonText(json)}, {"precision_recall.svg", svgPlot(precisionRecallPlot(score))}});
}

}  // namespace

int evaluateLoops(const std::vector<std::string>& arguments) {
  LoopsOptions values;
  po::options_description options("options");
  options.add_options()("poses", po::value(&values.poses_path)->required(), "true poses, KITTI format")(
      "closures", po::value(&values.closures_path),
      "CSV query_frame,match_frame,accepted,score,inliers,tx,ty,tz,qx,qy,qz,qw; t, q: the query frame in the match "
      "frame, Velodyne axes")("pairs", po::value(&values.pairs_path), "CSV i,j,score")(
      "calib", po::value(&values.calibration_path), "calibration; default: calib.txt beside the poses")(
      "json", po::bool_switch(&values.as_json), "print JSON in place of a line")(
      "output", po::value(&values.folder), "folder for loops.json, or pairs.json and precision_recall.svg");
  if (!parseOrHelp(arguments, kLoopsUsage, options)) return 0;
  if (values.closures_path.empty() == values.pairs_path.empty()) {
    throw InputError("loops needs either --closures or --pairs");
  }
  if (values.pairs_path.empty()) {
    scoreClosures(values);
  } else {
    scorePairs(values);
  }
  return 0;
}

}  // namespace semantic_mht_slam
