#pragma once

#include <functional>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {

/// What takes bytes that may come from anybody. One list for libFuzzer (driver/libfuzzer.cpp) and for fuzz_test.
struct FuzzTarget {
  std::string name;
  std::function<bool(const std::string& bytes)> run;  ///< true: took them, false: refused; an exception is a finding
  std::vector<std::string> seeds;                     ///< a small corpus of what is good
  /// Changes one thing in a way that the reader does not notice at once; none: any bytes do.
  std::function<std::string(std::string bytes, Rng& rng)> mutate{};
};

FuzzTarget csvTarget();
FuzzTarget estimatorTarget();
FuzzTarget g2oTarget();
FuzzTarget mapSectionTarget();
FuzzTarget mapStateTarget();
FuzzTarget mapUpdateTarget();
FuzzTarget messagesTarget();
FuzzTarget scanTarget();
FuzzTarget trajectoryTarget();
FuzzTarget treeTarget();
FuzzTarget yamlTarget();

}  // namespace semantic_mht_slam
