#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

/// Expects an InputError whose message holds every one of `parts`.
inline void expectInputError(const std::function<void()>& action, const std::vector<std::string>& parts) {
  try {
    action();
    ADD_FAILURE() << "no InputError; expected: " << parts.front();
  } catch (const InputError& error) {
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what() << "\nlacks: " << part;
    }
  }
}

}  // namespace semantic_mht_slam
