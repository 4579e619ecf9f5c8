#include "semantic_mht_slam/ros/landmark_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

std::uint16_t idOfClass(const SemanticMap& map, const std::string& name) {
  std::vector<std::string> names;
  for (const SemanticClass& entry : map.classes) {
    if (entry.name == name) return entry.id;
    names.push_back(entry.name);
  }
  throw InputError("there is no class '" + name + "'; the classes are " + joined(names));
}

}  // namespace

std::vector<Landmark> chosenLandmarks(const SemanticMap& map, const GetLandmarks::Request& request) {
  if (!std::isfinite(request.center.x) || !std::isfinite(request.center.y))
    throw InputError("the center is not finite");
  if (!(request.radius >= 0.0) || !std::isfinite(request.radius))
    throw InputError("the radius is negative or not finite");
  std::optional<std::uint16_t> class_id;
  if (!request.class_name.empty()) class_id = idOfClass(map, request.class_name);
  std::vector<Landmark> chosen;
  std::copy_if(map.landmarks.begin(), map.landmarks.end(), std::back_inserter(chosen), [&](const Landmark& landmark) {
    if (class_id && landmark.class_id != *class_id) return false;
    const double distance_m =
        std::hypot(landmark.position.x - request.center.x, landmark.position.y - request.center.y);
    return request.radius == 0.0 || distance_m <= request.radius;
  });
  return chosen;
}

}  // namespace semantic_mht_slam
