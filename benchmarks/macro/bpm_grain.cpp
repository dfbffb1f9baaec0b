// CPU time of the paper's grain: preparation, and the whole diametral compression to 35 % strain.
#include <fmt/core.h>

#include "bonded.hpp"
#include "harness.hpp"
#include "softgrain/experiment/run.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

struct NoRecorder final : Recorder {
  bool after_step(AnySimulation&, const StepReport&, RunReport&) override { return true; }
};

}  // namespace

int main(int argc, char** argv) {
  Results results("bpm_grain", argc, argv);
  const Case paper;
  results.heading(
      fmt::format("{} primaries to a strain of {}, once", paper.bpm.primaries, paper.loading.max_strain));
  const double start = cpu_seconds();
  Simulation simulation = simulation_of(paper);
  const double prepared = cpu_seconds();
  results.add({.what = "preparation of the grain", .value = prepared - start, .unit = "s"});
  NoRecorder recorder;
  const RunReport report = run(simulation, recorder);
  const double run_seconds = cpu_seconds() - prepared;
  const double updates = static_cast<double>(report.sweeps) * bonded(simulation).contacts.size();
  results.add({.what = "compression",
               .value = run_seconds,
               .unit = "s",
               .ratio = run_seconds / (prepared - start),
               .reference = "preparation"});
  results.add({.what = "steps", .value = static_cast<double>(report.steps), .unit = ""});
  results.add({.what = "sweeps per step",
               .value = static_cast<double>(report.sweeps) / static_cast<double>(report.steps),
               .unit = ""});
  results.add(
      {.what = "one step", .value = 1e6 * run_seconds / static_cast<double>(report.steps), .unit = "us"});
  results.add({.what = "whole step per contact update", .value = 1e9 * run_seconds / updates, .unit = "ns"});
}
