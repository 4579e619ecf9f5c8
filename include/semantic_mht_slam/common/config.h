#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/length.h"

namespace semantic_mht_slam {

/// Closed interval of allowed numbers.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();

  bool contains(double value) const { return value >= min && value <= max; }
};

/// One described parameter: what the reference prints, and how its value is read and written as text.
struct Field {
  std::string key;      ///< dotted, for example "mapping.submap_length"
  std::string type;     ///< "number", "integer", "true | false", "text" or the choices
  std::string unit;     ///< "m", "rad", "s", ... or empty
  std::string allowed;  ///< the range, or empty
  std::string help;     ///< one sentence
  std::function<std::string()> get;
  std::function<std::optional<std::string>(const std::string&)> set;  ///< empty, or what is wrong with the text
  std::function<void(double)> scale;                                  ///< of a length that is not set; else empty
};

/// The parameters of one or more config structs. A struct describes itself once, in a function found by
/// argument-dependent look-up:
///
///     void describe(MapperConfig& config, Fields& fields) {
///       fields.add("submap_length", config.submap_length_m, "m", {1.0, 1000.0}, "Travelled length of a submap.");
///     }
///
/// YAML files, ROS parameters, command lines, the effective configuration and the reference all use that description.
/// The structs must outlive this list.
class Fields {
 public:
  void add(const std::string& name, double& value, const std::string& unit, Range range, const std::string& help);
  void add(const std::string& name, int& value, const std::string& unit, Range range, const std::string& help);
  /// "auto" or a number.
  void add(const std::string& name, Length& value, const std::string& unit, Range range, const std::string& help);
  void add(const std::string& name, std::uint64_t& value, const std::string& unit, const std::string& help);
  void add(const std::string& name, bool& value, const std::string& help);
  void add(const std::string& name, std::string& value, const std::string& help);

  /// One of several named values.
  template <class Enum>
  void add(const std::string& name, Enum& value, const std::vector<std::pair<std::string, Enum>>& choices,
           const std::string& help) {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.push_back(choice.first);
    addChoice(
        name, names, help,
        [&value, choices] {
          std::size_t i = 0;
          while (i + 1 < choices.size() && choices[i].second != value) ++i;
          return i;
        },
        [&value, choices](std::size_t i) { value = choices[i].second; });
  }

  /// Describes `config` with "name." before each of its keys.
  template <class Config>
  void group(const std::string& name, Config& config) {
    const std::string outer = prefix_;
    prefix_ += name + ".";
    describe(config, *this);
    prefix_ = outer;
  }

  const std::vector<Field>& all() const { return fields_; }

 private:
  void addChoice(const std::string& name, const std::vector<std::string>& names, const std::string& help,
                 const std::function<std::size_t()>& get, const std::function<void(std::size_t)>& set);
  void append(Field field);

  std::string prefix_;
  std::vector<Field> fields_;
};

/// A value as it was found in a file, a parameter server or on a command line.
struct Setting {
  std::string key;     ///< dotted
  std::string value;   ///< text of the scalar
  std::string origin;  ///< "kitti.yaml:12", "/slam_node", "--set"
};

/// Writes the settings into the described structs; later settings win.
/// Throws ConfigError with every unknown key, unreadable value and value out of range; then nothing was changed.
void applySettings(const std::vector<Setting>& settings, Fields& fields);

/// Makes every described length that is not set what it is for a detector that sees `factor` times as far as the
/// reference (see `Length`).
void scaleLengths(double factor, const Fields& fields);

/// The described values as YAML, nested by the dots of their keys.
std::string toYaml(const Fields& fields);

/// The parameter reference: a Markdown table of key, type, unit, allowed range, default and help, one a group.
std::string toMarkdown(const Fields& fields);

}  // namespace semantic_mht_slam
