#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"

namespace fs = std::filesystem;
using namespace softgrain::test;

namespace {

/// A short run under the shim (tests/support/failing_calls.c), with everything that a run writes.
class FailingRun {
 public:
  /// The page is made after the run and of its files. nlohmann::json asserts when memory runs out in it.
  explicit FailingRun(bool with_page) : with_page_(with_page) {
    tiny_.settings.insert(tiny_.settings.end(), {with_page ? "output.report=true" : "output.report=false",
                                                 "output.snapshots=2", "output.samples=5"});
    case_file(workshop_, tiny_);
    REQUIRE(run_tiny(workshop_, tiny_, "whole").exit_code == 0);
  }

  /// How many calls of the kind a whole run makes.
  long count(const std::string& kind) {
    fail(kind + ":0");
    workshop_.environment["SOFTGRAIN_FAIL_COUNT"] = workshop_.path("count").string();
    CHECK(start().exit_code == 0);
    stop_failing();
    return std::stol(read_text(workshop_.path("count")));
  }

  /// One run in which the call fails; the exit code.
  int try_once(const std::string& failure) {
    CAPTURE(failure);
    fs::remove_all(workshop_.path("out"));
    fail(failure);
    const ProcessResult result = start();
    stop_failing();
    CAPTURE(result.err);
    CHECK(result.exit_code < 128);  // no crash
    CHECK((result.exit_code == 0) == (result.err.find("error") == std::string::npos));
    CHECK(result.err.find("this is a bug") == std::string::npos);
    for (const fs::path& snapshot : workshop_.snapshots("out"))
      CHECK(workshop_.softgrain({"info", snapshot.string()}).exit_code == 0);
    if (result.exit_code == 0) check_complete();
    return result.exit_code;
  }

  /// After a failure the run goes on to the same end.
  void check_going_on() {
    CHECK(run_tiny(workshop_, tiny_, "out",
                   {fs::exists(workshop_.path("out/run.json")) ? "--resume" : "--force"})
              .exit_code == 0);
    check_complete();
  }

 private:
  ProcessResult start() const { return run_tiny(workshop_, tiny_, "out"); }
  void fail(const std::string& what) {
    workshop_.environment["LD_PRELOAD"] = SOFTGRAIN_FAILING_CALLS;
    workshop_.environment["SOFTGRAIN_FAIL"] = what;
  }
  void stop_failing() {
    for (const char* name : {"LD_PRELOAD", "SOFTGRAIN_FAIL", "SOFTGRAIN_FAIL_COUNT"})
      workshop_.environment.erase(name);
  }
  void check_complete() const {
    CHECK(fs::exists(workshop_.path("out/report.html")) == with_page_);
    CHECK(workshop_.intact("out"));
    CHECK(workshop_.last_hash("out") == workshop_.last_hash("whole"));
    const bool same_series = workshop_.series("out") == workshop_.series("whole");
    CHECK(same_series);
    CHECK(nlohmann::json::parse(read_text(workshop_.path("out/run.json"))).at("state") == "done");
  }

  bool with_page_;
  Workshop workshop_;
  TinyCase tiny_{"failing", "diametral-mpm", tiny_settings("diametral-mpm")};
};

/// Lets each `kind` call fail in turn, `trials` of them evenly over the run.
void fail_in_turn(const std::string& kind, int trials, const std::string& suffix = "") {
  FailingRun failing(kind != "malloc");
  const long calls = failing.count(kind);
  int refused = 0;
  for (int trial = 0; trial < std::min<long>(trials, calls); ++trial) {
    const long k = 1 + trial * calls / std::min<long>(trials, calls);
    if (failing.try_once(kind + ":" + std::to_string(k) + suffix) == 0) continue;
    ++refused;
    if (trial % 4 == 0) failing.check_going_on();
  }
  MESSAGE(kind << suffix << ": " << calls << " calls in a run, " << refused << " failures ended it in order");
  CHECK(refused > 0);
}

}  // namespace

TEST_CASE("a write that fails never passes for a run that is done") {
  fail_in_turn("write", repeats(6, 200));
  fail_in_turn("write", repeats(3, 200), "+");
}

TEST_CASE("an fsync, a rename or an open that fails never passes for a run that is done") {
  for (const std::string kind : {"fsync", "rename", "open"}) fail_in_turn(kind, repeats(4, 200));
}

TEST_CASE("memory that runs out ends a run in order") { fail_in_turn("malloc", repeats(8, 400)); }
