#pragma once

#include <string>
#include <vector>

namespace semantic_mht_slam {

/// The commands of `evaluate`. Each takes the command line after its name, prints its result and returns the exit code.
int evaluateTrajectory(const std::vector<std::string>& arguments);
int evaluateAssociation(const std::vector<std::string>& arguments);
int evaluateLoops(const std::vector<std::string>& arguments);
int evaluateLandmarks(const std::vector<std::string>& arguments);
int evaluateAlignment(const std::vector<std::string>& arguments);

}  // namespace semantic_mht_slam
