#pragma once

#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace semantic_mht_slam {

/// What a program answered.
struct ProgramResult {
  int exit_code = -1;
  std::string output;  ///< standard output and standard error
};

/// Runs a program by its path through the shell.
inline ProgramResult runProgram(const std::string& path, const std::string& arguments) {
  ProgramResult result;
  FILE* pipe = ::popen(("'" + path + "' " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  while (std::size_t length = std::fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), length);
  const int status = ::pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

/// Runs a program of the package.
inline ProgramResult runProgramOfPackage(const std::string& name, const std::string& arguments) {
  return runProgram(std::string(SMHT_PROGRAM_DIR) + "/" + name, arguments);
}

}  // namespace semantic_mht_slam
