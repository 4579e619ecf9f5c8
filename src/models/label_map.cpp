#include "semantic_mht_slam/models/label_map.h"

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

LabelMap::LabelMap(const std::vector<LabelRule>& rules, const std::vector<int>& ignored, const std::string& origin)
    : targets_(kMaxId + 1) {
  std::vector<std::string> problems;
  const auto assign = [&](int id, const Target& target) {
    const std::string where = origin + ": label id " + std::to_string(id) + " ";
    if (id < 0 || id > kMaxId) {
      problems.push_back(where + "is not in [0, " + std::to_string(kMaxId) + "]");
    } else if (targets_[static_cast<std::size_t>(id)].class_index != kUnknown) {
      problems.push_back(where + "stands twice");
    } else {
      targets_[static_cast<std::size_t>(id)] = target;
    }
  };
  for (const LabelRule& rule : rules) assign(rule.id, {rule.class_index, rule.is_moving});
  for (const int id : ignored) assign(id, {kIgnored, false});
  if (!problems.empty()) throw ConfigError(problems);
}

LabelMap LabelMap::ofTable(const ClassTable& classes) {
  LabelMap map;
  for (Target& target : map.targets_) target.class_index = kIgnored;
  for (ClassIndex i = 0; i < classes.size(); ++i) map.targets_[static_cast<std::size_t>(classes[i].id)].class_index = i;
  return map;
}

}  // namespace semantic_mht_slam
