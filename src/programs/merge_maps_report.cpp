#include "merge_maps_report.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"

namespace semantic_mht_slam {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation_m;
  const Eigen::Quaterniond& q = pose.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

Json toJson(const OverlapHypothesis& hypothesis) {
  return {{"log_odds", hypothesis.log_odds},
          {"log_evidence", hypothesis.log_evidence},
          {"landmarks", hypothesis.landmarks},
          {"tiles_found", hypothesis.tiles_found},
          {"tiles_missing", hypothesis.tiles_missing}};
}

Json toJson(const MergedPair& pair, const std::vector<MergeMap>& maps) {
  Json hypotheses = Json::array();
  for (const OverlapHypothesis& hypothesis : pair.overlap.hypotheses) hypotheses.push_back(toJson(hypothesis));
  return {{"a", maps[pair.a].name()},
          {"b", maps[pair.b].name()},
          {"joined", pair.is_joined},
          {"posterior", pair.posterior},
          {"no_overlap", pair.overlap.none_prob},
          {"closures", pair.closures},
          {"reason", pair.reason},
          {"hypotheses", hypotheses}};
}

Json mapsJson(const MergeResult& result, const std::vector<MergeMap>& maps) {
  Json list = Json::array();
  for (std::size_t m = 0; m < maps.size(); ++m) {
    Json map = {{"file", maps[m].name()},
                {"keyframes", maps[m].map().keyframes().size()},
                {"driven_m", maps[m].map().keyframes().back().driven_m}};
    const MergedGroup& group = result.groups.front();
    for (std::size_t i = 0; group.joined && i < group.maps.size(); ++i) {
      if (group.maps[i] != m) continue;
      const JoinedMember& member = group.joined->members[i];
      map["landmark_offset"] = member.landmark_offset;
      const KeyframeId first(member.first_keyframe);
      map["T_joined_first_keyframe"] = toJson(group.joined->parts.map.T_map_keyframe(first));
    }
    list.push_back(map);
  }
  return list;
}

std::vector<std::string> namesOf(const std::vector<std::size_t>& indices, const std::vector<MergeMap>& maps) {
  std::vector<std::string> names;
  for (const std::size_t map : indices) names.push_back(maps[map].name());
  return names;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += c;
    }
  }
  return result;
}

std::string joinNames(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Plot drawing(const std::vector<MemberResult>& members, const std::vector<MixtureLandmark>& landmarks) {
  Plot plot;
  plot.title = "The joined map";
  plot.x_label = "x [m]";
  plot.y_label = "y [m]";
  plot.equal_aspect = true;
  PlotSeries dots{"landmarks", {}, {}, "#b0b0b0", PlotSeries::Style::kDots};
  for (const MixtureLandmark& landmark : landmarks) {
    dots.x.push_back(landmark.position.mean_m.x());
    dots.y.push_back(landmark.position.mean_m.y());
  }
  plot.series.push_back(std::move(dots));
  for (const MemberResult& member : members) {
    PlotSeries line{member.name, {}, {}, "", PlotSeries::Style::kLine};
    for (const StampedPose& pose : member.trajectory) {
      line.x.push_back(pose.T_world_base.translation_m.x());
      line.y.push_back(pose.T_world_base.translation_m.y());
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

std::string mergeReportJson(const MergeResult& result, const std::vector<MergeMap>& maps, std::size_t landmarks,
                            double seconds) {
  Json report;
  report["maps_joined"] = namesOf(result.groups.front().maps, maps);
  Json islands = Json::array();
  Json reasons = Json::object();
  Json groups = Json::array();
  for (const MergedGroup& group : result.groups) {
    groups.push_back(namesOf(group.maps, maps));
    if (group.maps.size() > 1 || maps.size() == 1) continue;
    const std::size_t map = group.maps.front();
    islands.push_back(maps[map].name());
    reasons[maps[map].name()] = result.reasons[map];
  }
  report["islands"] = islands;
  report["island_reasons"] = reasons;
  report["groups"] = groups;
  report["landmarks"] = landmarks;
  report["pairs"] = Json::array();
  for (const MergedPair& pair : result.pairs) report["pairs"].push_back(toJson(pair, maps));
  report["maps"] = mapsJson(result, maps);
  report["seconds"] = seconds;
  report["peak_rss_mb"] = peakRssMb();
  return report.dump(2) + "\n";
}

std::string mergeReportHtml(const MergeResult& result, const std::vector<MergeMap>& maps,
                            const std::vector<MemberResult>& members, const std::vector<MixtureLandmark>& landmarks) {
  std::string html =
      "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><title>Merged "
      "maps</title><style>body{font-family:sans-serif}"
      "td,th{padding:.2em .8em;text-align:left;border-bottom:1px solid #ddd}</style></head><body>\n<h1>Merged "
      "maps</h1>\n"
      "<p>" +
      escaped(mergeSummary(result, maps)) + "</p>\n";
  html += svgPlot(drawing(members, landmarks));
  html +=
      "\n<table><tr><th>map</th><th>map</th><th>joined</th><th>posterior</th><th>no overlap</th><th>closures</th>"
      "<th>reason</th></tr>\n";
  for (const MergedPair& pair : result.pairs) {
    html += "<tr><td>" + escaped(maps[pair.a].name()) + "</td><td>" + escaped(maps[pair.b].name()) + "</td><td>" +
            (pair.is_joined ? "yes" : "no") + "</td><td>" + formatFixed(pair.posterior, 4) + "</td><td>" +
            formatFixed(pair.overlap.none_prob, 4) + "</td><td>" + std::to_string(pair.closures) + "</td><td>" +
            escaped(pair.reason) + "</td></tr>\n";
  }
  return html + "</table>\n</body></html>\n";
}

std::string mergeSummary(const MergeResult& result, const std::vector<MergeMap>& maps) {
  std::string text;
  for (const MergedGroup& group : result.groups) {
    if (group.maps.size() < 2) continue;
    text += (text.empty() ? "joined: " : "; joined apart from them: ") + joinNames(namesOf(group.maps, maps));
  }
  if (text.empty()) text = "nothing joined";
  for (const MergedGroup& group : result.groups) {
    if (group.maps.size() > 1) continue;
    const std::size_t map = group.maps.front();
    text += "; island: " + maps[map].name();
    if (!result.reasons[map].empty()) text += " (" + result.reasons[map] + ")";
  }
  return text;
}

}  // namespace semantic_mht_slam
