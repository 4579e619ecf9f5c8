// What the map server takes from a robot: good updates, in which the bytes change fields, and the map that they make.
#include <algorithm>
#include <memory>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/slam/map_delta.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_file.h"
#include "fuzz/fuzzed_values.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMostUpdates = 20;

/// From the last keyframe to the first, as the map has them.
MapUpdateClosure closureOf(const Map& map) {
  MapUpdateClosure closure;
  const KeyframeId last(map.keyframes().size() - 1);
  closure.query_keyframe = static_cast<std::uint32_t>(last.index());
  const Pose T_match_query = map.T_map_keyframe(KeyframeId(0)).inverse() * map.T_map_keyframe(last);
  const Eigen::Vector3d rotation_rad = logRotation(T_match_query.rotation);
  for (std::size_t i = 0; i < 3; ++i) {
    closure.position[i] = static_cast<float>(T_match_query.translation_m[static_cast<Eigen::Index>(i)]);
    closure.rotation[i] = static_cast<float>(rotation_rad[static_cast<Eigen::Index>(i)]);
  }
  closure.stddev.fill(0.1F);
  return closure;
}

/// The updates of a drive, the last one with a loop closure.
struct GoodUpdates {
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  const ClassTable classes = makeStreetClasses();
  std::vector<MapUpdate> updates;

  GoodUpdates() {
    Slam slam(config, classes);
    SquareDrive(7).feed(slam, 0, 150);  // a short one: thousands of maps are made of it
    slam.finish();
    for (const SubmapId id : slam.map().submaps().ids()) updates.push_back(toMessage(slam.parts(), id, classes));
    updates.back().closures.push_back(closureOf(slam.map()));
    updates.back().closures_held = {1};
  }
};

class ChangedUpdates {
 public:
  ChangedUpdates(const GoodUpdates& good, const std::string& bytes) : updates_(good.updates), values_(bytes) {
    while (!values_.isEmpty()) {
      const std::uint8_t which = values_.byte();
      const std::uint8_t what = values_.byte();
      MapUpdate& update = updates_[which % updates_.size()];
      if (what < 160) {
        changeField(what % 16, update);
      } else if (what < 240) {
        changeItem(what % 8, update);
      } else {
        changeOrder(which, what);
      }
    }
  }

  const std::vector<MapUpdate>& updates() const { return updates_; }

 private:
  template <class List>
  auto& oneOf(List& list) {
    if (list.empty()) list.emplace_back();
    return list[values_.byte() % list.size()];
  }

  float real() { return static_cast<float>(values_.number()); }

  void changeField(int which, MapUpdate& update) {
    switch (which) {
      case 0:
        update.range_factor = real();
        break;
      case 1:
        update.landmark_step = real();
        update.keyframe_step = real();
        break;
      case 2:
        update.odometry_noise[values_.byte() % 6] = real();
        update.odometry_errors[values_.byte() % 10] = real();
        break;
      case 3:
        update.begins_session = 1;
        update.first_position[values_.byte() % 3] = values_.number();
        update.first_rotation[values_.byte() % 3] = real();
        break;
      case 4:
        update.begin.sec = values_.byte() << 24U;
        break;
      case 5:
        update.driven = values_.number();
        update.turned = values_.number();
        break;
      case 6:
        oneOf(update.shown) = values_.byte();
        break;
      case 7:
        oneOf(update.landmarks).id = values_.byte();
        break;
      case 8:
        oneOf(update.landmarks).class_index = values_.byte();
        break;
      case 9:
        oneOf(update.duplicates) = values_.byte();
        break;
      case 10:
        oneOf(update.keyframes).after = real();
        break;
      case 11:
        oneOf(update.keyframes).position[values_.byte() % 3] = static_cast<std::int16_t>(256 * values_.byte());
        break;
      case 12:
        oneOf(update.pairs) = values_.byte();
        break;
      case 13:
        changeLandmark(oneOf(update.landmarks));
        break;
      case 14:
        changeClosure(oneOf(update.closures));
        break;
      default:
        oneOf(update.closures_held) = values_.byte();
        break;
    }
  }

  void changeItem(int which, MapUpdate& update) {
    switch (which) {
      case 0:
        oneOf(update.keyframes).driven = real();
        break;
      case 1:
        oneOf(update.keyframes).turned = real();
        break;
      case 2:
        oneOf(update.keyframes).rotation[values_.byte() % 3] = static_cast<std::int16_t>(256 * values_.byte());
        break;
      case 3:
        oneOf(update.landmarks).class_prob = values_.byte();
        break;
      case 4:
        oneOf(update.landmarks).existence_prob = values_.byte();
        break;
      case 5:
        oneOf(update.closures).rotation[values_.byte() % 3] = real();
        break;
      case 6:
        if (!update.closures.empty()) update.closures.push_back(update.closures.front());
        break;
      default:
        update.header.stamp.sec = values_.byte() << 24U;
        break;
    }
  }

  /// One update twice, missing, or in the place of another.
  void changeOrder(std::size_t which, int what) {
    const auto place = updates_.begin() + static_cast<std::ptrdiff_t>(which % updates_.size());
    if (what % 3 == 0 && updates_.size() > 1) {
      updates_.erase(place);
    } else if (what % 3 == 1) {
      std::iter_swap(place, updates_.begin());
    } else if (updates_.size() < kMostUpdates) {
      updates_.insert(place, MapUpdate(*place));
    }
  }

  void changeLandmark(MapUpdateLandmark& landmark) {
    landmark.keyframe = values_.byte();
    landmark.position[values_.byte() % 3] = static_cast<std::int16_t>(256 * values_.byte());
    landmark.stddev[values_.byte() % 3] = values_.byte();
  }

  void changeClosure(MapUpdateClosure& closure) {
    closure.source = values_.byte() % 5;
    closure.query_keyframe = values_.byte();
    closure.match_keyframe = values_.byte();
    closure.position[values_.byte() % 3] = real();
    closure.stddev[values_.byte() % 6] = real();
    closure.correlation[values_.byte() % 15] = static_cast<std::int8_t>(values_.byte());
    oneOf(closure.pairs) = values_.byte();
  }

  std::vector<MapUpdate> updates_;
  FuzzedValues values_;
};

}  // namespace

FuzzTarget mapUpdateTarget() {
  const auto good = std::make_shared<GoodUpdates>();
  const auto run = [good](const std::string& bytes) {
    const ChangedUpdates changed(*good, bytes);
    return readOrRefuse([&] {
      MapByDeltas map;
      for (const MapUpdate& update : changed.updates()) map.deltas.push_back(fromMessage(update, good->classes));
      map.range_factor = changed.updates().front().range_factor;
      map.held = heldClosures(changed.updates().back());
      makeMap(map, good->config, good->classes);
    });
  };
  return {"map_update", run, {"", std::string("\x01\x0b\x02\x01\x66", 5), std::string("\x00\x0f\x00\xff", 4)}};
}

}  // namespace semantic_mht_slam
