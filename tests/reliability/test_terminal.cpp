#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <functional>

#include "reliability/tiny_cases.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

bool has_tmux() { return run({"/bin/sh", "-c", "command -v tmux"}).exit_code == 0; }

/// A real terminal with a shell in it, by tmux.
class Terminal {
 public:
  explicit Terminal(const Workshop& workshop) : workshop_(workshop) {
    tmux("new-session -d -x 120 -y 30 'exec /bin/sh -i'");
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() { close(); }

  void type(const std::string& line) const { tmux("send-keys '" + line + "' Enter"); }
  void press(const std::string& key) const { tmux("send-keys " + key); }
  std::string screen() const { return tmux("capture-pane -p"); }
  /// As when the window is closed, or the connection breaks.
  void close() const { tmux("kill-server"); }

 private:
  std::string tmux(const std::string& words) const {
    return workshop_.shell("unset TMUX; exec tmux -S tmux.socket -f /dev/null " + words).out;
  }

  const Workshop& workshop_;
};

/// Waits for what must happen within 5 s, and returns how long it took [s]; 1000 if it did not.
double seconds_until(const std::function<bool()>& happened) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  while (elapsed() < 60) {
    if (happened()) return elapsed();
    usleep(2000);
  }
  return 1000;
}

/// A run in a terminal, of steps that take a while.
struct TerminalRun {
  Workshop workshop;
  Terminal terminal{workshop};

  TerminalRun() {
    workshop.softgrain({"new", "a", "--template", "compaction-mpm"});
    workshop.file("go", "exec " SOFTGRAIN_PROGRAM
                        " run a/case.toml -o out --resume --set sample.grains=300 --set mpm.cells=8 --set "
                        "output.vtk=false\n");
  }
  /// Begins, or goes on; the number of the process.
  pid_t start() const {
    fs::remove(workshop.path("code"));
    terminal.type("clear; sh go; echo $? > code");
    seconds_until([&] { return state() == "running" && terminal.screen().find(" %") != std::string::npos; });
    return std::stoi("0" + read_text(workshop.path("out/.lock")));
  }
  std::string state() const {
    const std::string text = read_text(workshop.path("out/run.json"));
    return nlohmann::json::accept(text) ? nlohmann::json::parse(text).at("state") : "";
  }
  std::string stopped_by() const {
    return nlohmann::json::parse(read_text(workshop.path("out/run.json"))).at("message");
  }
  /// Waits for the exit code that the shell saw.
  double wait_for_code(const std::string& code) const {
    return seconds_until([&] { return read_text(workshop.path("code")) == code + "\n"; });
  }
};

}  // namespace

TEST_CASE("in a real terminal a run answers signals within a step, or 5 s, and each as documented") {
  if (!has_tmux()) {
    MESSAGE("tmux is not here, so this was not tried: tools/install_dependencies.sh --with torture");
    return;
  }
  const TerminalRun run;
  const pid_t process = run.start();
  REQUIRE(process > 0);

  kill(process, SIGUSR1);
  const double snapshot = seconds_until([&] { return run.workshop.snapshots("out").size() == 2; });
  CHECK(run.state() == "running");
  const ProcessResult second = run.workshop.shell("exec sh go");
  CHECK(second.exit_code == 2);
  CHECK(second.err.find("out is in use by another run, process " + std::to_string(process)) !=
        std::string::npos);

  run.terminal.press("C-c");
  const double interrupt = run.wait_for_code("130");
  CHECK(run.state() == "stopped");
  CHECK(run.terminal.screen().find("go on with: softgrain resume out") != std::string::npos);

  kill(run.start(), SIGTERM);
  const double termination = run.wait_for_code("75");
  CHECK(run.stopped_by() == "SIGTERM");

  const pid_t last = run.start();
  run.terminal.close();
  const double hang_up = seconds_until([&] { return run.state() == "stopped" && kill(last, 0) != 0; });
  CHECK(run.stopped_by() == "SIGHUP");
  CHECK(run.workshop.intact("out"));

  MESSAGE("seconds to answer SIGUSR1 " << snapshot << ", Ctrl-C " << interrupt << ", SIGTERM " << termination
                                       << ", a closed terminal " << hang_up);
  for (const double latency : {snapshot, interrupt, termination, hang_up}) CHECK(latency < 5);
}
