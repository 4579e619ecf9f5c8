#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace semantic_mht_slam {

/// Progress of long work on stderr: done, rate and time left, at most once a second on a terminal (in place) and every
/// five seconds elsewhere. Work that ends sooner prints nothing.
class Progress {
 public:
  explicit Progress(std::string what) : what_(std::move(what)) {}
  ~Progress() {
    if (has_printed_ && is_terminal_) std::fputc('\n', stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void operator()(std::size_t done, std::size_t all) {
    const Clock::time_point now = Clock::now();
    const bool is_due = now - printed_ >= (is_terminal_ ? std::chrono::seconds(1) : std::chrono::seconds(5));
    if (!is_due && !(has_printed_ && done == all)) return;
    printed_ = now;
    has_printed_ = true;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    const double rate = static_cast<double>(done) / seconds;
    std::fprintf(stderr, "%s%s %zu/%zu, %.0f a second, %.0f s left%s", is_terminal_ ? "\r" : "", what_.c_str(), done,
                 all, rate, static_cast<double>(all - done) / rate, is_terminal_ ? "   " : "\n");
  }

 private:
  using Clock = std::chrono::steady_clock;

  const std::string what_;
  const bool is_terminal_ = ::isatty(2) != 0;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point printed_ = begin_;
  bool has_printed_ = false;
};

}  // namespace semantic_mht_slam
