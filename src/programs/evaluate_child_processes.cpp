#include "evaluate_child_processes.h"

#include <cerrno>
#include <cstdint>
#include <map>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace semantic_mht_slam {
namespace {

constexpr int kNotStarted = 127;  // as a shell says it

/// The process's id; 0 if it could not be started.
pid_t start(const ChildProcess& process) {
  std::vector<char*> arguments;
  for (const std::string& argument : process.command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, process.log_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0644);
  ::posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = 0;
  const int problem = ::posix_spawn(&id, arguments.front(), &actions, nullptr, arguments.data(), ::environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return problem == 0 ? id : 0;
}

int exitCode(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

void runChildProcesses(const std::vector<ChildProcess>& processes, int at_once,
                       const std::function<void(std::size_t, int)>& ended) {
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  while (next < processes.size() || !running.empty()) {
    if (next < processes.size() && running.size() < static_cast<std::size_t>(at_once)) {
      if (const pid_t id = start(processes[next])) {
        running[id] = next;
      } else {
        ended(next, kNotStarted);
      }
      ++next;
      continue;
    }
    int status = 0;
    const pid_t id = ::waitpid(-1, &status, 0);
    if (id < 0 && errno == EINTR) continue;
    if (id < 0) throw std::runtime_error("cannot wait for the programs that were started");
    const auto found = running.find(id);
    if (found == running.end()) continue;
    const std::size_t index = found->second;
    running.erase(found);
    ended(index, exitCode(status));
  }
}

}  // namespace semantic_mht_slam
