#include "semantic_mht_slam/common/error.h"

#include <utility>

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {

ConfigError::ConfigError(std::vector<std::string> problems)
    : InputError(joined(problems, "\n")), problems_(std::move(problems)) {}

}  // namespace semantic_mht_slam
