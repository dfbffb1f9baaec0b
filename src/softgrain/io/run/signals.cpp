#include "softgrain/io/run/signals.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

namespace softgrain {

namespace {

constexpr std::array watched{SIGINT, SIGTERM, SIGUSR2, SIGHUP, SIGUSR1, SIGPIPE};

// All that a handler may touch. It is the operating system's: one per process, so these are too.
std::atomic<int> first_stop{0};
std::atomic<bool> interrupted{false};
std::atomic<bool> snapshot_wanted{false};
std::atomic<bool> deferring{false};
std::array<struct sigaction, watched.size()> before;

static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void on_signal(int signal) {
  if (signal == SIGUSR1) {
    snapshot_wanted = true;
    return;
  }
  int none = 0;
  first_stop.compare_exchange_strong(none, signal);
  const bool second_interrupt = signal == SIGINT && interrupted.exchange(true);
  if (!deferring || second_interrupt) _exit(exit_code_of(signal));
}

}  // namespace

int exit_code_of(int signal) { return signal == SIGINT ? exit_interrupted : exit_requeue; }

std::string signal_name(int signal) {
  switch (signal) {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    case SIGHUP:
      return "SIGHUP";
    case SIGUSR2:
      return "SIGUSR2";
    default:
      return "signal " + std::to_string(signal);
  }
}

SignalWatch::SignalWatch() {
  first_stop = 0;
  interrupted = false;
  snapshot_wanted = false;
  deferring = false;
  for (std::size_t k = 0; k < watched.size(); ++k) {
    sigaction(watched[k], nullptr, &before[k]);
    if (before[k].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = watched[k] == SIGPIPE ? SIG_IGN : on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(watched[k], &action, nullptr);
  }
}

SignalWatch::~SignalWatch() {
  for (std::size_t k = 0; k < watched.size(); ++k) sigaction(watched[k], &before[k], nullptr);
}

void SignalWatch::defer() { deferring = true; }

int SignalWatch::stop_signal() const { return first_stop; }

bool SignalWatch::take_snapshot_request() { return snapshot_wanted.exchange(false); }

}  // namespace softgrain
