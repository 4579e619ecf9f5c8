#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/models/odometry_model.h"
#include "semantic_mht_slam/slam/slam_state.h"

namespace semantic_mht_slam {

/// The pose graph at the beginning of the section 'graph' of a map's state by its fields, so that a test can change any
/// one of them. What follows it in the section is not read, and not written.
struct GraphSection {
  struct Measured {  ///< a relative pose with the square root of its information
    Pose pose;
    PoseCov root = PoseCov::Zero();
    void transfer(StateArchive& archive) { archive(pose, root); }
  };
  struct Step {
    Pose T_previous_node;
    PoseCov cov = PoseCov::Zero();
    void transfer(StateArchive& archive) { archive(T_previous_node, cov); }
  };
  struct Odometry {
    bool is_known = false;  ///< from the keyframes
    Step step;
    SharedErrors shared = SharedErrors::Zero();
    void transfer(StateArchive& archive) {
      archive(is_known);
      if (!is_known) archive(step, shared);
    }
  };
  struct Prior {
    Step place;
    Measured cost;
    void transfer(StateArchive& archive) { archive(place, cost); }
  };
  struct Node {
    std::array<double, 7> block{};
    std::vector<std::int64_t> landmarks;
    std::vector<int> loops;
    std::vector<Prior> priors;
    void transfer(StateArchive& archive) { archive(block, landmarks, loops, priors); }
  };
  struct Sighting {
    int node = 0;
    std::int64_t landmark = 0;
    Eigen::Vector3d measured = Eigen::Vector3d::Zero();
    Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
    void transfer(StateArchive& archive) { archive(node, landmark, measured, root); }
  };
  struct Landmark {
    int anchor = 0;
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    std::vector<Sighting> sightings;
    void transfer(StateArchive& archive) { archive(anchor, position_m, sightings); }
  };
  struct Loop {
    int from = 0;
    int to = 0;
    Step closure;
    bool is_certain = false;
    int state = 0;
    bool is_reviewed = false;
    bool is_readmitted = false;
    void transfer(StateArchive& archive) { archive(from, to, closure, is_certain, state, is_reviewed, is_readmitted); }
  };
  struct HubLink {
    int from = 0;
    int to = 0;
    bool is_robust = false;
    SharedErrors shared = SharedErrors::Zero();
    Measured cost;
    void transfer(StateArchive& archive) { archive(from, to, is_robust, shared, cost); }
  };
  struct LoopLink {
    std::optional<int> link;
    bool is_settled = false;
    void transfer(StateArchive& archive) { archive(link, is_settled); }
  };

  std::map<SubmapId, OdometryModel> odometry_of_submap;
  int window_nodes = 0;
  int chunk_nodes = 0;
  std::vector<Node> nodes;
  std::map<std::int64_t, Landmark> landmarks;
  std::map<std::int64_t, std::int64_t> group_of;
  std::vector<Loop> loops;
  std::vector<Odometry> odometry;
  std::vector<bool> fits_odometry;
  std::vector<std::vector<bool>> agrees;
  int reviewed = 0;
  std::vector<std::array<double, 7>> hubs;
  std::vector<HubLink> links;
  std::vector<int> active;
  std::vector<LoopLink> loop_links;
  std::map<int, LoopLink> landmark_links;
  std::set<int> touched;
  std::vector<std::size_t> prior_links;
  std::vector<double> bend;
  double news = 0.0;
  bool is_pending = false;
  int in_hierarchy = 0;
  std::vector<std::optional<int>> reported;

  explicit GraphSection(const std::string& bytes) {
    StateArchive reading(bytes);
    transfer(reading);
  }

  std::string bytes() const {
    StateArchive archive;
    GraphSection(*this).transfer(archive);
    return archive.written();
  }

 private:
  void transfer(StateArchive& archive) {
    archive(odometry_of_submap, window_nodes, chunk_nodes, nodes, landmarks, group_of, loops, odometry);
    archive(fits_odometry, agrees, reviewed, hubs, links, active, loop_links, landmark_links, touched);
    archive(prior_links, bend, news, is_pending, in_hierarchy, reported);
  }
};

/// The bytes of a section.
inline std::string& sectionOf(SlamState& state, const std::string& name) {
  for (StateSection& section : state.sections) {
    if (section.name == name) return section.bytes;
  }
  throw std::logic_error("there is no section " + name);
}

}  // namespace semantic_mht_slam
