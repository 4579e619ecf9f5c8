#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

/// How an object's centroid may move between passes (paper, section II-A): points keep their place, extended objects
/// such as buildings show another part of themselves.
enum class Transition { kDirac, kGaussian };

/// What the system knows of one semantic class.
struct ClassInfo {
  int id = 0;                                  ///< number in messages and label images
  std::string name;                            ///< name in CSV files
  std::string color = "#808080";               ///< "#rrggbb"
  bool is_static = true;                       ///< false: objects that may drive away
  double prior_prob = 1.0;                     ///< p_s, how well the class fits the environment (paper eq. 2)
  double range_stddev_m = 0.1;                 ///< centroid noise along the line of sight
  double lateral_stddev_m = 0.1;               ///< centroid noise across it
  Transition transition = Transition::kDirac;  ///< between submaps
  double transition_stddev_m = 0.0;            ///< of a Gaussian transition

  /// Red, green and blue in [0, 1].
  std::array<double, 3> rgb() const;
};

void describe(ClassInfo& info, Fields& fields);

/// Index of a class in its table.
using ClassIndex = int;

/// The classes of a detector, in the order of their file. Immutable.
class ClassTable {
 public:
  ClassTable() = default;

  /// Throws ConfigError naming every class with a repeated or empty name, a repeated id, a bad colour or a Gaussian
  /// transition without deviation. `origin` (a file name) begins each message.
  ClassTable(std::vector<ClassInfo> classes, const std::string& origin);

  int size() const { return static_cast<int>(classes_.size()); }
  const ClassInfo& operator[](ClassIndex index) const { return classes_.at(static_cast<std::size_t>(index)); }
  const std::vector<ClassInfo>& all() const { return classes_; }

  std::optional<ClassIndex> findName(const std::string& name) const;
  std::optional<ClassIndex> findId(int id) const;

  /// "pole, trunk, ...", for messages.
  std::string names() const;

 private:
  std::vector<ClassInfo> classes_;
};

}  // namespace semantic_mht_slam
