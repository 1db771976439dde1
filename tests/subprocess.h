// Runs a program and keeps what it says.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lanewise::test {

struct ProcessResult {
  int exit_code = 0;  // 128 + the signal's number if one ended it
  std::string out;
  std::string err;
  long peak_kilobytes = 0;  // of memory that it had
};

inline std::string read_back(FILE* file) {
  std::string text;
  std::rewind(file);
  char chunk[4096];
  while (const size_t n = std::fread(chunk, 1, sizeof chunk, file)) text.append(chunk, n);
  std::fclose(file);
  return text;
}

// In the folder given, with empty standard input; killed after a minute. program: an absolute path. prepare: called in its process
// before it begins, if given; to take something away from it.
inline ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments,
                                 const std::filesystem::path& folder, const std::function<void()>& prepare = nullptr) {
  FILE* out = std::tmpfile();
  FILE* err = std::tmpfile();
  FILE* in = std::fopen("/dev/null", "r");
  if (!out || !err || !in) throw std::runtime_error("no temporary file");
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    ::dup2(::fileno(in), STDIN_FILENO);
    ::dup2(::fileno(out), STDOUT_FILENO);
    ::dup2(::fileno(err), STDERR_FILENO);
    ::alarm(60);
    if (::chdir(folder.c_str()) != 0) ::_exit(127);
    if (prepare) prepare();
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  std::fclose(in);
  ProcessResult result;
  result.peak_kilobytes = usage.ru_maxrss;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = read_back(out);
  result.err = read_back(err);
  return result;
}

// The same by the shell.
inline ProcessResult run_shell(const std::filesystem::path& folder, const std::string& command) {
  return run_process("/bin/sh", {"-c", command}, folder);
}

}  // namespace lanewise::test
