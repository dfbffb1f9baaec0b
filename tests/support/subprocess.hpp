#pragma once
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace softgrain::test {

/// What a program left behind. A program that was killed has exit_code 128 + signal, as in the shell.
struct ProcessResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// A running program whose stdout and stderr go to unnamed temporary files, so that it can never block on a
/// pipe.
class Process {
 public:
  using Environment = std::map<std::string, std::string>;

  /// argv[0] is the program's path; `environment` is added to ours; `directory` is where it runs ("" = here).
  explicit Process(const std::vector<std::string>& argv, const Environment& environment = {},
                   const std::string& directory = "")
      : out_(std::tmpfile()), err_(std::tmpfile()) {
    if (out_ == nullptr || err_ == nullptr) throw std::runtime_error("no temporary file");
    std::vector<char*> arguments;
    for (const std::string& word : argv) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("fork failed");
    if (pid_ > 0) return;
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    const bool in_place = directory.empty() || chdir(directory.c_str()) == 0;
    dup2(open("/dev/null", O_RDONLY), 0);
    dup2(fileno(out_), 1);
    dup2(fileno(err_), 2);
    if (in_place) execv(arguments[0], arguments.data());
    _exit(127);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    std::fclose(out_);
    std::fclose(err_);
  }

  pid_t id() const { return pid_; }
  void send(int signal) const { kill(pid_, signal); }

  ProcessResult wait() {
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return {code, contents(out_), contents(err_)};
  }

 private:
  static std::string contents(std::FILE* file) {
    std::string text;
    std::rewind(file);
    char block[4096];
    for (std::size_t n = 0; (n = std::fread(block, 1, sizeof block, file)) > 0;) text.append(block, n);
    return text;
  }

  pid_t pid_ = -1;
  std::FILE* out_;
  std::FILE* err_;
};

/// Runs a program to its end.
inline ProcessResult run(const std::vector<std::string>& argv, const Process::Environment& environment = {},
                         const std::string& directory = "") {
  return Process(argv, environment, directory).wait();
}

}  // namespace softgrain::test
