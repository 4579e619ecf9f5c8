#pragma once

#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "semantic_mht_slam/ros/diagnosis.h"

namespace semantic_mht_slam {

/// Collects findings: the first one becomes the message.
class Finding {
 public:
  explicit Finding(diagnostic_updater::DiagnosticStatusWrapper& status) : status_(status) {}

  void report(bool is_wrong, unsigned char level, const std::string& message, const std::string& fix) {
    if (!is_wrong || is_found_) return;
    is_found_ = true;
    status_.summary(level, message);
    status_.add(kFixKey, fix);
  }
  void error(bool is_wrong, const std::string& message, const std::string& fix) {
    report(is_wrong, diagnostic_msgs::DiagnosticStatus::ERROR, message, fix);
  }
  void warn(bool is_wrong, const std::string& message, const std::string& fix) {
    report(is_wrong, diagnostic_msgs::DiagnosticStatus::WARN, message, fix);
  }
  void otherwise(const std::string& message) {
    if (!is_found_) status_.summary(diagnostic_msgs::DiagnosticStatus::OK, message);
  }

 private:
  diagnostic_updater::DiagnosticStatusWrapper& status_;
  bool is_found_ = false;
};

}  // namespace semantic_mht_slam
