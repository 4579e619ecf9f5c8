#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace semantic_mht_slam {

/// Something that a user handed over (a file, a parameter, a command line) cannot be used.
/// The message is one clear sentence that names the file, line, field or key. Programs print it and end with code 1.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

/// One or more problems of a configuration, reported together, one a line.
class ConfigError : public InputError {
 public:
  explicit ConfigError(std::vector<std::string> problems);

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

}  // namespace semantic_mht_slam
