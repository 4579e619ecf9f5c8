#include <cstdio>

#include "semantic_mht_slam/app/system_config.h"

#include "program.h"

/// Prints docs/parameters.md: the parameter reference that the descriptions in the code make.
int main() {
  return semantic_mht_slam::runProgram("parameter_reference", [] {
    std::fputs(semantic_mht_slam::parameterReference().c_str(), stdout);
    return 0;
  });
}
