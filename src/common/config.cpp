#include "semantic_mht_slam/common/config.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

std::string describeRange(const Range& range) {
  const bool has_min = std::isfinite(range.min);
  const bool has_max = std::isfinite(range.max);
  if (has_min && has_max) return formatDouble(range.min) + " to " + formatDouble(range.max);
  if (has_min) return "at least " + formatDouble(range.min);
  if (has_max) return "at most " + formatDouble(range.max);
  return "";
}

std::optional<std::string> outside(double value, const Range& range) {
  if (!std::isfinite(value)) return "is not finite";
  if (range.contains(value)) return std::nullopt;
  return "is out of range (" + describeRange(range) + ")";
}

/// Single-quoted YAML scalar: a quote inside is doubled.
std::string quotedYaml(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string groupOf(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

/// The only key of the same name in another group, where a key may have moved to.
std::optional<std::string> namesake(const std::string& key, const std::vector<std::string>& keys) {
  const auto nameOf = [](const std::string& dotted) { return dotted.substr(dotted.rfind('.') + 1); };
  const auto isNamesake = [&](const std::string& other) { return nameOf(other) == nameOf(key); };
  const auto found = std::find_if(keys.begin(), keys.end(), isNamesake);
  if (found == keys.end() || std::any_of(found + 1, keys.end(), isNamesake)) return std::nullopt;
  return *found;
}

}  // namespace

void Fields::append(Field field) {
  field.key = prefix_ + field.key;
  const auto same = [&](const Field& other) { return other.key == field.key; };
  if (std::any_of(fields_.begin(), fields_.end(), same)) throw std::logic_error("described twice: " + field.key);
  fields_.push_back(std::move(field));
}

void Fields::add(const std::string& name, double& value, const std::string& unit, Range range,
                 const std::string& help) {
  const auto set = [&value, range](const std::string& text) -> std::optional<std::string> {
    const std::optional<double> number = parseDouble(text);
    if (!number) return "is not a number";
    if (auto problem = outside(*number, range)) return problem;
    value = *number;
    return std::nullopt;
  };
  append({name, "number", unit, describeRange(range), help, [&value] { return formatDouble(value); }, set, {}});
}

void Fields::add(const std::string& name, Length& value, const std::string& unit, Range range,
                 const std::string& help) {
  const auto set = [&value, range, initial = value](const std::string& text) -> std::optional<std::string> {
    const std::optional<double> number = parseDouble(text);
    if (text != "auto" && !number) return "is neither auto nor a number";
    if (text == "auto") {
      value = initial;
      return std::nullopt;
    }
    if (auto problem = outside(*number, range)) return problem;
    value = *number;
    return std::nullopt;
  };
  const auto get = [&value] { return value.isAuto() ? std::string("auto") : formatDouble(value); };
  const std::string allowed = describeRange(range) + ", or auto (" + formatDouble(value) + " for the reference range)";
  append({name, "number or auto", unit, allowed, help, get, set, [&value](double factor) { value.scale(factor); }});
}

void Fields::add(const std::string& name, int& value, const std::string& unit, Range range, const std::string& help) {
  range.min = std::max(range.min, static_cast<double>(std::numeric_limits<int>::min()));
  range.max = std::min(range.max, static_cast<double>(std::numeric_limits<int>::max()));
  const auto set = [&value, range](const std::string& text) -> std::optional<std::string> {
    const std::optional<std::int64_t> number = parseInteger(text);
    if (!number) return "is not a whole number";
    if (auto problem = outside(static_cast<double>(*number), range)) return problem;
    value = static_cast<int>(*number);
    return std::nullopt;
  };
  append({name, "integer", unit, describeRange(range), help, [&value] { return std::to_string(value); }, set, {}});
}

void Fields::add(const std::string& name, std::uint64_t& value, const std::string& unit, const std::string& help) {
  const auto set = [&value](const std::string& text) -> std::optional<std::string> {
    const std::optional<std::int64_t> number = parseInteger(text);
    if (!number || *number < 0) return "is not a whole number of at least 0";
    value = static_cast<std::uint64_t>(*number);
    return std::nullopt;
  };
  append({name, "integer", unit, "at least 0", help, [&value] { return std::to_string(value); }, set, {}});
}

void Fields::add(const std::string& name, bool& value, const std::string& help) {
  const auto set = [&value](const std::string& text) -> std::optional<std::string> {
    if (text != "true" && text != "false") return "is neither true nor false";
    value = text == "true";
    return std::nullopt;
  };
  append({name, "true or false", "", "", help, [&value] { return value ? "true" : "false"; }, set, {}});
}

void Fields::add(const std::string& name, std::string& value, const std::string& help) {
  const auto set = [&value](const std::string& text) -> std::optional<std::string> {
    value = text;
    return std::nullopt;
  };
  append({name, "text", "", "", help, [&value] { return value; }, set, {}});
}

void Fields::addChoice(const std::string& name, const std::vector<std::string>& names, const std::string& help,
                       const std::function<std::size_t()>& get, const std::function<void(std::size_t)>& set_index) {
  const auto set = [names, set_index](const std::string& text) -> std::optional<std::string> {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) return "is none of " + joined(names);
    set_index(static_cast<std::size_t>(found - names.begin()));
    return std::nullopt;
  };
  append({name, "choice", "", joined(names), help, [names, get] { return names[get()]; }, set, {}});
}

void applySettings(const std::vector<Setting>& settings, Fields& fields) {
  std::vector<std::string> before;
  std::vector<std::string> keys;
  for (const Field& field : fields.all()) {
    before.push_back(field.get());
    keys.push_back(field.key);
  }
  std::vector<std::string> problems;
  for (const Setting& setting : settings) {
    const auto found = std::find(keys.begin(), keys.end(), setting.key);
    if (found == keys.end()) {
      std::optional<std::string> guess = namesake(setting.key, keys);
      if (!guess) guess = closest(setting.key, keys);
      problems.push_back(setting.origin + ": unknown key '" + setting.key + "'" +
                         (guess ? ", did you mean '" + *guess + "'?" : ""));
      continue;
    }
    const Field& field = fields.all()[static_cast<std::size_t>(found - keys.begin())];
    if (const auto problem = field.set(setting.value)) {
      problems.push_back(setting.origin + ": " + setting.key + " = '" + setting.value + "' " + *problem);
    }
  }
  if (problems.empty()) return;
  for (std::size_t i = 0; i < before.size(); ++i) fields.all()[i].set(before[i]);
  throw ConfigError(problems);
}

void scaleLengths(double factor, const Fields& fields) {
  for (const Field& field : fields.all()) {
    if (field.scale) field.scale(factor);
  }
}

std::string toYaml(const Fields& fields) {
  std::string text;
  std::vector<std::string> open;  // groups that the previous line was in
  for (const Field& field : fields.all()) {
    std::vector<std::string> path;
    for (const std::string_view part : split(field.key, '.')) path.emplace_back(part);
    const std::string name = path.back();
    path.pop_back();
    std::size_t common = 0;
    while (common < std::min(open.size(), path.size()) && open[common] == path[common]) ++common;
    for (std::size_t i = common; i < path.size(); ++i) text += std::string(2 * i, ' ') + path[i] + ":\n";
    const std::string value = field.get();
    const bool quoted = field.type == "text";
    text += std::string(2 * path.size(), ' ') + name + ": " + (quoted ? quotedYaml(value) : value) + "\n";
    open = std::move(path);
  }
  return text;
}

std::string toMarkdown(const Fields& fields) {
  std::string text;
  std::string group = "\n";  // no group has this name
  for (const Field& field : fields.all()) {
    if (groupOf(field.key) != group) {
      group = groupOf(field.key);
      text += "\n## " + (group.empty() ? "General" : "`" + group + "`") +
              "\n\n| key | type | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
    }
    text += "| `" + field.key + "` | " + field.type + " | " + field.unit + " | " + field.allowed + " | " + field.get() +
            " | " + field.help + " |\n";
  }
  return text;
}

}  // namespace semantic_mht_slam
