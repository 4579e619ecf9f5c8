#pragma once

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace semantic_mht_slam {

/// A program of the package that runs beside the test; killed at the end if it still runs.
class RosProcess {
 public:
  RosProcess(const std::string& program, std::vector<std::string> arguments) : pid_(::fork()) {
    if (pid_ != 0) return;
    arguments.insert(arguments.begin(), std::string(SMHT_PROGRAM_DIR) + "/" + program);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const int null = ::open("/dev/null", O_WRONLY);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    ::execv(argv.front(), argv.data());
    ::_exit(127);
  }

  ~RosProcess() {
    if (pid_ <= 0) return;
    if (stop(SIGINT, 5.0) < 0.0) stop(SIGKILL, 5.0);
  }

  RosProcess(const RosProcess&) = delete;
  RosProcess& operator=(const RosProcess&) = delete;

  /// Sends a signal and returns the seconds until the program has ended; negative if it has not within the limit.
  double stop(int signal, double limit_s) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    ::kill(pid_, signal);
    while (true) {
      const double passed_s = std::chrono::duration<double>(Clock::now() - begin).count();
      if (::waitpid(pid_, &exit_status_, WNOHANG) == pid_) {
        pid_ = -1;
        return passed_s;
      }
      if (passed_s > limit_s) return -1.0;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  /// Exit code after `stop`; -1 if a signal ended it.
  int exitCode() const { return WIFEXITED(exit_status_) ? WEXITSTATUS(exit_status_) : -1; }

 private:
  pid_t pid_;
  int exit_status_ = 0;
};

}  // namespace semantic_mht_slam
