#pragma once
#include <string>

namespace softgrain {

/// Exit codes of a run that was asked to stop (docs/guide: signals).
enum : int { exit_requeue = 75, exit_interrupted = 130 };

/// While it lives, signals are requests that the run answers between two steps:
///   SIGINT                        snapshot and exit 130; a second one leaves at once
///   SIGTERM, SIGUSR2, SIGHUP      snapshot and exit 75: requeue me
///   SIGUSR1                       snapshot and go on
/// Until `defer` is called there is nothing to save, and a request to stop exits at once with its code. A
/// signal that was ignored at the start stays ignored. A broken pipe is an error of the write, not the end.
/// Only one at a time.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  void defer();
  /// The first signal that asked to stop; 0 for none.
  int stop_signal() const;
  /// True once after each SIGUSR1.
  bool take_snapshot_request();
};

/// The exit code that answers a signal asking to stop.
int exit_code_of(int signal);

/// "SIGTERM".
std::string signal_name(int signal);

}  // namespace softgrain
