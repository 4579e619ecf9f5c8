#pragma once

#include <cstdlib>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

/// Bytes as a file in memory.
class FuzzedFile {
 public:
  explicit FuzzedFile(const std::string& bytes) : file_(::memfd_create("fuzzed", 0)) {
    if (file_ < 0 || ::write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
  }
  ~FuzzedFile() { ::close(file_); }
  FuzzedFile(const FuzzedFile&) = delete;
  FuzzedFile& operator=(const FuzzedFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// Bytes may be refused, which gives false; any other exception is a finding.
template <class Read>
bool readOrRefuse(const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace semantic_mht_slam
