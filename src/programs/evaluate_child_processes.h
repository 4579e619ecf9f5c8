#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace semantic_mht_slam {

/// A program to run, with its output.
struct ChildProcess {
  std::vector<std::string> command;  ///< the program's path and its arguments
  std::string log_path;              ///< gets standard output and standard error; its folder must exist
};

/// Runs every process, at most `at_once` of them at a time, in their order. `ended(index, exit_code)` is called for
/// each as it ends; the code of one that a signal ended is 128 + its number, and that of one that could not be started
/// 127. The caller must have no other child processes.
void runChildProcesses(const std::vector<ChildProcess>& processes, int at_once,
                       const std::function<void(std::size_t, int)>& ended);

}  // namespace semantic_mht_slam
