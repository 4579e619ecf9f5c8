#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/yaml_file.h"
#include "semantic_mht_slam/models/usable_detection.h"

#include "evaluate_alignment_trials.h"
#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kAlignmentUsage =
    "A frame against an earlier map after drift: the share of wrong or missed associations among detections that have "
    "a\n"
    "counterpart in the map of one earlier pass, for growing offsets of the frame.\n"
    "\n"
    "usage: evaluate alignment --dataset DIR --objects FILE --classes FILE [--truth FILE] [--frames-step N] [--seed "
    "N]\n"
    "           [--set key=value ...] [--json] [--output DIR]\n";

struct AlignmentOptions {
  std::string dataset_path;
  std::string objects;
  std::string classes_path;
  std::string truth_path;
  std::string folder;
  std::vector<std::string> settings;
  std::size_t frames_step = 10;
  double half_length_m = 50.0;
  std::uint64_t seed = 1;
  bool as_json = false;
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::string resultsCsv(const std::vector<MethodResult>& results) {
  std::string text = "method,offset_m,offset_deg,scored,wrong,missed,share,others,others_accepted\n";
  for (const MethodResult& r : results) {
    text += r.method + "," + formatDouble(r.offset.distance_m) + "," + formatDouble(r.offset.angle_deg) + "," +
            std::to_string(r.tally.scored) + "," + std::to_string(r.tally.wrong) + "," +
            std::to_string(r.tally.missed) + "," + formatFixed(r.tally.share(), 5) + "," +
            std::to_string(r.tally.others) + "," + std::to_string(r.tally.accepted) + "\n";
  }
  return text;
}

std::string curve(const std::vector<MethodResult>& results) {
  Plot plot;
  plot.title = "A frame against an earlier map";
  plot.x_label = "offset [m], turned by 0.5 to 4 deg";
  plot.y_label = "wrong or missed associations [%]";
  plot.y_from_zero = true;
  for (const MethodResult& r : results) {
    if (plot.series.empty() || plot.series.back().label != r.method) {
      plot.series.emplace_back();
      plot.series.back().label = r.method;
    }
    plot.series.back().x.push_back(r.offset.distance_m);
    plot.series.back().y.push_back(100.0 * r.tally.share());
  }
  return svgPlot(plot);
}

std::string table(const AlignmentTrials& trials) {
  std::string text = "method                offset m  deg   scored   wrong  missed  share %  others  accepted\n";
  for (const MethodResult& r : trials.methods) {
    text += r.method + padded(formatFixed(r.offset.distance_m, 1), 30 - r.method.size()) +
            padded(formatFixed(r.offset.angle_deg, 1), 5) + padded(std::to_string(r.tally.scored), 9) +
            padded(std::to_string(r.tally.wrong), 8) + padded(std::to_string(r.tally.missed), 8) +
            padded(figure(100.0 * r.tally.share(), 2), 9) + padded(std::to_string(r.tally.others), 8) +
            padded(std::to_string(r.tally.accepted), 10) + "\n";
  }
  text += "joint alignment by offset: frames, best right, some right, none, hypotheses, NEES of 3, ms median, ms p99\n";
  for (const AlignmentResult& r : trials.alignments) {
    text += padded(formatFixed(r.offset.distance_m, 1), 8);
    for (const int count : {r.frames, r.best_right, r.any_right, r.none}) text += padded(std::to_string(count), 7);
    text += padded(figure(r.hypotheses, 2), 7) + padded(figure(r.nees, 2), 7) +
            padded(figure(percentile(r.milliseconds, 0.5), 2), 7) +
            padded(figure(percentile(r.milliseconds, 0.99), 2), 7) + "\n";
  }
  return text + "on maps of other places: " + std::to_string(trials.elsewhere.frames) + " trials, believed " +
         std::to_string(trials.elsewhere.believed) + ", largest log likelihood " +
         figure(trials.elsewhere.max_log_likelihood, 1) + "\n";
}

/// Without times, so that two runs write the same bytes.
nlohmann::json toJson(const AlignmentTrials& trials) {
  nlohmann::json methods = nlohmann::json::array();
  for (const MethodResult& r : trials.methods) {
    methods.push_back({{"method", r.method},
                       {"offset_m", r.offset.distance_m},
                       {"offset_deg", r.offset.angle_deg},
                       {"scored", r.tally.scored},
                       {"wrong", r.tally.wrong},
                       {"missed", r.tally.missed},
                       {"share", r.tally.share()},
                       {"others", r.tally.others},
                       {"others_accepted", r.tally.accepted}});
  }
  nlohmann::json alignments = nlohmann::json::array();
  for (const AlignmentResult& r : trials.alignments) {
    alignments.push_back({{"offset_m", r.offset.distance_m},
                          {"offset_deg", r.offset.angle_deg},
                          {"frames", r.frames},
                          {"best_right", r.best_right},
                          {"any_right", r.any_right},
                          {"none", r.none},
                          {"hypotheses", r.hypotheses},
                          {"nees", r.nees}});
  }
  return {{"methods", methods},
          {"alignments", alignments},
          {"elsewhere",
           {{"frames", trials.elsewhere.frames},
            {"believed", trials.elsewhere.believed},
            {"max_log_likelihood", trials.elsewhere.max_log_likelihood}}}};
}

TrueLandmarks readTrueLandmarks(const std::string& path, const Dataset& dataset) {
  TrueLandmarks truth(dataset.frames());
  const std::string notice = CsvReader({"frame", "landmark"}).read(path, [&](const CsvRow& row) {
    const std::int64_t frame = row.integer(0);
    if (frame < 0 || frame >= static_cast<std::int64_t>(truth.size())) row.fail(0, "no such frame");
    truth[frame].push_back(static_cast<int>(row.integer(1)));
  });
  printNotice("evaluate", notice);
  for (std::size_t f = 0; f < truth.size(); ++f) {
    if (truth[f].size() == dataset.detections[f].size()) continue;
    throw InputError(path + ": frame " + std::to_string(f) + " has " + std::to_string(truth[f].size()) +
                     " detections, the objects file " + std::to_string(dataset.detections[f].size()));
  }
  return truth;
}

RegistrationConfig readConfig(const std::vector<std::string>& texts) {
  RegistrationConfig config;
  Fields fields;
  describe(config, fields);
  std::vector<Setting> settings;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw InputError("--set " + text + ": key=value was expected");
    settings.push_back({text.substr(0, equals), text.substr(equals + 1), "--set"});
  }
  applySettings(settings, fields);
  return config;
}

/// Rows of the truth belong to rows of the objects, so none can be left out.
void requireUsable(const Dataset& dataset, const std::string& objects) {
  for (std::size_t frame = 0; frame < dataset.frames(); ++frame) {
    for (const Detection& detection : dataset.detections[frame]) {
      if (isUsable(detection)) continue;
      throw InputError(objects + ": frame " + std::to_string(frame) + ", object " + std::to_string(detection.row) +
                       ": its numbers cannot be used");
    }
  }
}

po::options_description describe(AlignmentOptions& values) {
  po::options_description options("options");
  options.add_options()("dataset", po::value(&values.dataset_path)->required(), "folder with poses.txt")(
      "objects", po::value(&values.objects)->default_value("objects.csv"), "detections")(
      "classes", po::value(&values.classes_path)->required(), "class table")(
      "truth", po::value(&values.truth_path), "CSV frame,landmark, a row a detection: for scoring")(
      "frames-step", po::value(&values.frames_step)->default_value(10), "every so many frames")(
      "map-half-length", po::value(&values.half_length_m)->default_value(50.0, "50"),
      "length of the earlier pass before and after the place, m")("seed", po::value(&values.seed)->default_value(1),
                                                                  "of the directions of the offsets")(
      "set", po::value(&values.settings)->multitoken()->composing(), "parameter of the alignment, key=value")(
      "json", po::bool_switch(&values.as_json), "print JSON in place of a table")(
      "output", po::value(&values.folder), "folder for alignment.json, alignment.csv and alignment.svg");
  return options;
}

}  // namespace

int evaluateAlignment(const std::vector<std::string>& arguments) {
  AlignmentOptions options;
  if (!parseOrHelp(arguments, kAlignmentUsage, describe(options))) return 0;
  if (options.frames_step == 0) throw InputError("--frames-step must be positive");
  const RegistrationConfig config = readConfig(options.settings);
  const ClassTable classes = readClassTable(options.classes_path);
  const Dataset dataset = readDataset({options.dataset_path, options.objects, "poses.txt"}, classes);
  printNotice("evaluate", dataset.notice);
  if (!dataset.T_map_base) throw InputError(options.dataset_path + ": no poses.txt, which this needs");
  requireUsable(dataset, options.objects);
  std::optional<TrueLandmarks> truth;
  if (!options.truth_path.empty()) truth = readTrueLandmarks(options.truth_path, dataset);
  const std::vector<AlignmentScene> scenes =
      alignmentScenes(dataset, classes, truth, options.frames_step, options.half_length_m);

  if (scenes.empty()) throw InputError(options.dataset_path + ": the drive comes back to no place, nothing to score");
  const AlignmentTrials trials = runAlignmentTrials(scenes, classes, config, Rng(options.seed));
  const nlohmann::json json = toJson(trials);
  report(options.as_json, json, table(trials), options.folder,
         {{"alignment.json", jsonText(json)},
          {"alignment.csv", resultsCsv(trials.methods)},
          {"alignment.svg", curve(trials.methods)}});
  return 0;
}

}  // namespace semantic_mht_slam
