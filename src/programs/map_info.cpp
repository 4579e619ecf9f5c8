#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include "semantic_mht_slam/app/landmark_files.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/bags/readable_map.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "landmark_table.h"
#include "program.h"

namespace po = boost::program_options;

namespace semantic_mht_slam {
namespace {

constexpr const char* kUsage =
    "Says what is in a map file, and writes it as files that others read.\n"
    "  map_info FILE [--csv LANDMARKS.csv] [--geojson LANDMARKS.geojson] [--tum TRAJECTORY.tum] [--html PAGE.html]\n";

struct Arguments {
  std::string file;
  std::string csv;
  std::string geojson;
  std::string tum;
  std::string html;
  std::string config = packageConfigFile("kitti.yaml");
  std::vector<std::string> settings;
};

/// False if only help was asked for.
bool parse(int argc, char** argv, Arguments& arguments) {
  po::options_description options("Options");
  auto add = options.add_options();
  add("file", po::value(&arguments.file)->value_name("FILE"), "the map; the option's name may be left out");
  add("csv", po::value(&arguments.csv)->value_name("FILE"), "writes the landmarks (id,class,x,y,z,...)");
  add("geojson", po::value(&arguments.geojson)->value_name("FILE"),
      "writes the landmarks in longitude and latitude, if fixes said where the map is, else in metres");
  add("tum", po::value(&arguments.tum)->value_name("FILE"), "writes the trajectory (stamp x y z qx qy qz qw)");
  add("html", po::value(&arguments.html)->value_name("FILE"), "writes a page with a drawing of the map");
  add("config", po::value(&arguments.config)->value_name("FILE"), "parameters that the map was made with");
  add("set", po::value(&arguments.settings)->value_name("KEY=VALUE")->composing(),
      "changes a parameter; may be given several times");
  po::positional_options_description positions;
  positions.add("file", 1);
  if (!parseOrHelp({argv + 1, argv + argc}, kUsage, options, positions)) return false;
  if (arguments.file.empty()) throw InputError("a map file is needed");
  return true;
}

struct MapContent {
  std::unique_ptr<Slam> slam;
  ClassTable classes;
  std::vector<MixtureLandmark> landmarks;
  std::vector<StampedPose> trajectory;
  std::optional<MapOrigin> origin;  ///< if fixes determined it
};

MapContent readContent(const Arguments& arguments) {
  std::vector<Setting> overrides;
  for (const std::string& text : arguments.settings) overrides.push_back(parseOverride(text));
  SystemConfig config = loadSystemConfig(arguments.config, overrides);
  const std::string folder = std::filesystem::path(arguments.config).parent_path().string();
  MapContent content;
  content.classes = loadClassTable(config, folder);
  LoadedMap map = readMapFile(arguments.file, config, content.classes, [] { return true; });
  if (!map.remade.empty()) std::fprintf(stderr, "%s\n", describeRemade(map).c_str());
  const SlamConfig slam_config = loadableSlamConfig(config, folder);
  content.slam =
      std::make_unique<Slam>(slam_config, content.classes, stateOf(std::move(map), slam_config, content.classes));
  content.landmarks = landmarksOf(*content.slam);
  content.trajectory = trajectoryOf(*content.slam);
  if (const auto reference = geoReferenceOf(*content.slam)) content.origin = originOf(*reference);
  return content;
}

double length_m(const std::vector<StampedPose>& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double step_m =
        (trajectory[i].T_world_base.translation_m - trajectory[i - 1].T_world_base.translation_m).norm();
    if (trajectory[i].stamp > trajectory[i - 1].stamp) length_m += step_m;
  }
  return length_m;
}

std::string summary(const MapContent& content) {
  const Map& map = content.slam->map();
  std::map<std::string, int> of_class;
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d high_m = low_m;
  for (const MixtureLandmark& landmark : content.landmarks) {
    ++of_class[content.classes[landmark.mostLikelyClass()].name];
    const Eigen::Vector2d at_m = landmark.position.mean_m.head<2>();
    const bool is_first = &landmark == &content.landmarks.front();
    low_m = is_first ? at_m : Eigen::Vector2d(low_m.cwiseMin(at_m));
    high_m = is_first ? at_m : Eigen::Vector2d(high_m.cwiseMax(at_m));
  }
  const auto holding = std::count_if(map.closures().begin(), map.closures().end(),
                                     [](const LoopClosureRecord& closure) { return closure.is_accepted; });
  const auto sessions = content.slam->parts().sessions.summary(map);
  std::string text = "sessions   " + std::to_string(sessions.size()) + "\n";
  text += "trajectory " + std::to_string(content.trajectory.size()) + " poses, " +
          formatFixed(length_m(content.trajectory), 1) + " m\n";
  text += "submaps    " + std::to_string(map.submaps().size()) + "\n";
  text += "keyframes  " + std::to_string(map.keyframes().size()) + "\n";
  text += "closures   " + std::to_string(holding) + " that hold, of " + std::to_string(map.closures().size()) + "\n";
  text += "landmarks  " + std::to_string(content.landmarks.size()) + ", " + formatFixed(high_m.x() - low_m.x(), 1) +
          " x " + formatFixed(high_m.y() - low_m.y(), 1) + " m\n";
  if (content.origin) {
    text += "origin     " + formatFixed(content.origin->latitude_deg, 7) + " " +
            formatFixed(content.origin->longitude_deg, 7) + ", x axis " + formatFixed(content.origin->heading_rad, 4) +
            " rad from east\n";
  }
  for (const auto& [name, count] : of_class) text += "  " + name + " " + std::to_string(count) + "\n";
  return text;
}

std::string page(const MapContent& content, const std::string& text, const std::string& title) {
  Plot plot;
  plot.title = title;
  plot.x_label = "x [m]";
  plot.y_label = "y [m]";
  plot.equal_aspect = true;
  for (const ClassInfo& info : content.classes.all()) {
    PlotSeries dots{info.name, {}, {}, info.color, PlotSeries::Style::kDots};
    for (const MixtureLandmark& landmark : content.landmarks) {
      if (content.classes[landmark.mostLikelyClass()].id != info.id) continue;
      dots.x.push_back(landmark.position.mean_m.x());
      dots.y.push_back(landmark.position.mean_m.y());
    }
    if (!dots.x.empty()) plot.series.push_back(std::move(dots));
  }
  PlotSeries line{"trajectory", {}, {}, "#0050c8", PlotSeries::Style::kLine};
  for (const StampedPose& pose : content.trajectory) {
    line.x.push_back(pose.T_world_base.translation_m.x());
    line.y.push_back(pose.T_world_base.translation_m.y());
  }
  plot.series.push_back(std::move(line));
  return "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><title>Map</title></head><body>\n" + svgPlot(plot) +
         "\n<pre>" + text + "</pre>\n</body></html>\n";
}

int run(int argc, char** argv) {
  Arguments arguments;
  if (!parse(argc, argv, arguments)) return 0;
  const MapContent content = readContent(arguments);
  const std::string text = summary(content);
  std::fputs(text.c_str(), stdout);
  if (!arguments.csv.empty()) writeFileAtomically(arguments.csv, landmarkTable(content.landmarks, content.classes));
  if (!arguments.geojson.empty()) {
    writeFileAtomically(arguments.geojson, landmarksGeoJson(content.landmarks, content.classes, content.origin));
  }
  if (!arguments.tum.empty()) writeFileAtomically(arguments.tum, formatTumTrajectory(content.trajectory));
  const std::string title = std::filesystem::path(arguments.file).filename().string();
  if (!arguments.html.empty()) writeFileAtomically(arguments.html, page(content, text, title));
  return 0;
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  return semantic_mht_slam::runProgram("map_info", [&] { return semantic_mht_slam::run(argc, argv); });
}
