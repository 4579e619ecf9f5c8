#pragma once

#include <fstream>
#include <string>

#ifdef __SANITIZE_ADDRESS__
#define SMHT_KEEPS_WHAT_WAS_FREED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SMHT_KEEPS_WHAT_WAS_FREED
#endif
#endif

namespace semantic_mht_slam {

/// Resident memory of this process, and the most of it since the last `begin`, by the kernel's count.
class PeakMemory {
 public:
  /// False if the system does not let one begin again, or a sanitizer keeps what was freed.
  bool begin() {
#ifdef SMHT_KEEPS_WHAT_WAS_FREED
    return false;
#endif
    std::ofstream peak("/proc/self/clear_refs");
    peak << "5" << std::flush;
    before_mb_ = megabytes("VmRSS:");
    return static_cast<bool>(peak) && before_mb_ > 0.0;
  }

  /// Above what there was at `begin`.
  double grown_mb() const {
    return megabytes("VmHWM:") - before_mb_;
  }

 private:
  static double megabytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.compare(0, key.size(), key) == 0) return std::stod(line.substr(key.size())) / 1024.0;
    }
    return 0.0;
  }

  double before_mb_ = 0.0;
};

}  // namespace semantic_mht_slam
