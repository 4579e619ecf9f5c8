#include "semantic_mht_slam/models/class_table.h"

#include <cctype>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

bool isColor(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return false;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!std::isxdigit(static_cast<unsigned char>(text[i]))) return false;
  }
  return true;
}

}  // namespace

void describe(ClassInfo& info, Fields& fields) {
  fields.add("id", info.id, "", {0, 65535}, "Number of the class in messages and label images.");
  fields.add("name", info.name, "Name of the class in CSV files.");
  fields.add("color", info.color, "Display colour, #rrggbb.");
  fields.add("static", info.is_static, "False for objects that may drive away; they serve recognition only.");
  fields.add("prior_prob", info.prior_prob, "", {1e-6, 1.0}, "p_s: how well the class fits the environment.");
  fields.add("range_stddev", info.range_stddev_m, "m", {1e-3, 100.0}, "Centroid noise along the line of sight.");
  fields.add("lateral_stddev", info.lateral_stddev_m, "m", {1e-3, 100.0}, "Centroid noise across the line of sight.");
  fields.add<Transition>("transition", info.transition,
                         {{"dirac", Transition::kDirac}, {"gaussian", Transition::kGaussian}},
                         "Whether the centroid keeps its place between passes or shows another part of the object.");
  fields.add("transition_stddev", info.transition_stddev_m, "m", {0.0, 100.0}, "Deviation of a Gaussian transition.");
}

std::array<double, 3> ClassInfo::rgb() const {
  const unsigned long value = std::stoul(color.substr(1), nullptr, 16);
  return {static_cast<double>((value >> 16) & 255) / 255.0, static_cast<double>((value >> 8) & 255) / 255.0,
          static_cast<double>(value & 255) / 255.0};
}

ClassTable::ClassTable(std::vector<ClassInfo> classes, const std::string& origin) : classes_(std::move(classes)) {
  std::vector<std::string> problems;
  if (classes_.empty()) problems.push_back(origin + ": no classes");
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const ClassInfo& info = classes_[i];
    const std::string where = origin + ": class " + std::to_string(i) + " ('" + info.name + "'): ";
    if (info.name.empty()) problems.push_back(where + "has no name");
    if (!isColor(info.color)) problems.push_back(where + "color '" + info.color + "' is not #rrggbb");
    if (info.transition == Transition::kGaussian && info.transition_stddev_m <= 0.0) {
      problems.push_back(where + "a gaussian transition needs a transition_stddev above 0");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (classes_[j].name == info.name) problems.push_back(where + "the name stands twice");
      if (classes_[j].id == info.id) problems.push_back(where + "the id " + std::to_string(info.id) + " stands twice");
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
}

std::optional<ClassIndex> ClassTable::findName(const std::string& name) const {
  for (int i = 0; i < size(); ++i) {
    if ((*this)[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<ClassIndex> ClassTable::findId(int id) const {
  for (int i = 0; i < size(); ++i) {
    if ((*this)[i].id == id) return i;
  }
  return std::nullopt;
}

std::string ClassTable::names() const {
  std::vector<std::string> result;
  for (const ClassInfo& info : classes_) result.push_back(info.name);
  return joined(result);
}

}  // namespace semantic_mht_slam
