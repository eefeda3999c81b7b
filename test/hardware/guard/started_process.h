#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace arfm_vo {

/// A program of the package that runs until it is killed with this object.
class StartedProcess {
 public:
  /// The program's name and its arguments.
  explicit StartedProcess(std::vector<std::string> words) {
    words[0] = ARFM_VO_PROGRAM_DIR "/" + words[0];
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (::posix_spawn(&pid_, words[0].c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
      throw std::runtime_error("cannot start " + words[0]);
  }
  ~StartedProcess() {
    Signal(SIGKILL);
    Await();
  }
  StartedProcess(const StartedProcess&) = delete;
  StartedProcess& operator=(const StartedProcess&) = delete;

  void Signal(int number) const {
    if (pid_ > 0) ::kill(pid_, number);
  }
  /// Its exit status; -1 where a signal has ended it, or it was awaited before.
  int Await() {
    int status = -1;
    if (pid_ > 0) ::waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = 0;
};

}  // namespace arfm_vo
