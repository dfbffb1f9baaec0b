#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "softgrain/io/run/signals.hpp"

using namespace softgrain;

namespace {

/// Exit code of a child process that does this; 0 when it comes back.
int exit_code_after(const std::function<void()>& act) {
  const pid_t child = fork();
  if (child == 0) {
    act();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("a request to stop is kept until the run looks, and the first one counts") {
  SignalWatch signals;
  signals.defer();
  CHECK(signals.stop_signal() == 0);
  std::raise(SIGTERM);
  std::raise(SIGINT);
  CHECK(signals.stop_signal() == SIGTERM);
  CHECK(exit_code_of(SIGTERM) == 75);
  CHECK(exit_code_of(SIGUSR2) == 75);
  CHECK(exit_code_of(SIGHUP) == 75);
  CHECK(exit_code_of(SIGINT) == 130);
}

TEST_CASE("SIGUSR1 asks for one snapshot and does not stop") {
  SignalWatch signals;
  signals.defer();
  std::raise(SIGUSR1);
  CHECK(signals.take_snapshot_request());
  CHECK_FALSE(signals.take_snapshot_request());
  CHECK(signals.stop_signal() == 0);
}

TEST_CASE("a second Ctrl-C leaves at once") {
  CHECK(exit_code_after([] {
          SignalWatch signals;
          signals.defer();
          std::raise(SIGINT);
          std::raise(SIGINT);
        }) == 130);
}

TEST_CASE("before there is anything to save a request to stop leaves at once with its code") {
  CHECK(exit_code_after([] {
          const SignalWatch signals;
          std::raise(SIGTERM);
        }) == 75);
}

TEST_CASE("a signal that was ignored at the start stays ignored") {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    SignalWatch signals;
    signals.defer();
    std::raise(SIGHUP);
    CHECK(signals.stop_signal() == 0);
  }
  std::signal(SIGHUP, before);
}

TEST_CASE("after the watch the signals are the system's again") {
  CHECK(exit_code_after([] {
          std::signal(SIGTERM, SIG_DFL);
          { const SignalWatch signals; }
          std::raise(SIGTERM);
        }) == 128 + SIGTERM);
}
