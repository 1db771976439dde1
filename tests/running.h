// The program at work beside the test.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/program.h"
#include "tests/temporary_folder.h"

namespace lanewise::test {

// In the folder, with its standard error in the folder's file err. prepare: called in its process before it begins, if given.
class Running {
 public:
  Running(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
          const std::function<void()>& prepare = nullptr)
      : folder_(folder) {
    std::vector<char*> argv = {const_cast<char*>("lanewise")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const std::string name = program(), err = folder.file("err");
    child_ = ::fork();
    if (child_ != 0) return;
    if (!std::freopen(err.c_str(), "w", stderr) || ::chdir(folder.path().c_str()) != 0) ::_exit(127);
    ::alarm(60);
    if (prepare) prepare();
    ::execv(name.c_str(), argv.data());
    ::_exit(127);
  }

  pid_t process() const { return child_; }

  void wait_for(const std::string& file) const {
    for (int i = 0; i < 6000 && !std::filesystem::exists(folder_.file(file)); ++i) sleep(std::chrono::milliseconds(5));
  }
  static void sleep(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }

  // 128 + the signal that ended it, or its exit code.
  int wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  // The same, when it has been sent the signal.
  int end(int signal) {
    ::kill(child_, signal);
    return wait();
  }

 private:
  const TemporaryFolder& folder_;
  pid_t child_;
};

}  // namespace lanewise::test
