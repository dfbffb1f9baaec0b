// Where the time of one step of the paper's grain goes, part by part, in the middle of the compression.
#include <fmt/core.h>

#include "bonded.hpp"
#include "harness.hpp"
#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int steps_before = 4000, steps_measured = 200, calls = 100;

/// What the steps did, in the mean of one step.
struct MeanStep {
  double sweeps = 0, rebuilds = 0, contacts = 0;
};

MeanStep run_steps(Simulation simulation) {
  MeanStep mean;
  const int generation = bonded(simulation).reference.generation;
  for (int k = 0; k < steps_measured; ++k) {
    const StepReport report = simulation.step();
    mean.sweeps += report.sweeps;
    mean.contacts += report.contacts;
  }
  mean.rebuilds = bonded(simulation).reference.generation - generation;
  for (double* sum : {&mean.sweeps, &mean.rebuilds, &mean.contacts}) *sum /= steps_measured;
  return mean;
}

/// CPU seconds per step of the whole step and of its parts, by the library's own functions.
struct StepParts {
  double whole, attraction, detection, offsets, sweeps, stale, warm_start, velocities, rebuild;
};

StepParts time_parts(const Simulation& simulation, const Case& paper, const MeanStep& mean) {
  RigidDynamics<2> state = bonded(simulation);
  RigidParticles<2>& particles = state.particles;
  RigidContacts<2>& contacts = state.contacts;
  AttractionForces attraction({.F0 = paper.bpm.attraction, .gamma = paper.bpm.exponent});
  attraction.update(particles, state.reference);
  std::vector<Vec<2>> force(particles.position.size());
  std::vector<double> offset;
  signorini_offset<2>(contacts, particles.velocity, {}, paper.time.step, offset);
  const auto start = [&](NarrowSweeps& narrow) {
    narrow.start(
        particles, contacts, [](int, int) {}, offset, paper.solver.relaxation);
  };
  NarrowSweeps swept, started;
  start(swept);
  // impulses change velocities for good, the rebuild contacts: both work on copies
  RigidParticles<2> pushed = particles;
  RigidContactSystem<2> pushed_system(pushed, contacts, offset);
  RigidDynamics<2> rebuilt = state;
  AttractionForces listed({.F0 = paper.bpm.attraction, .gamma = paper.bpm.exponent});

  int stale = 0;
  NeighbourReference<2> checked = state.reference;
  const auto seconds = fastest({
      [&] {
        Simulation copy = simulation;
        for (int k = 0; k < steps_measured; ++k) copy.step();
      },
      repeated(calls, [&] { attraction.add_forces(particles, force); }),
      repeated(calls, [&] { detect_contacts(particles, contacts); }),
      repeated(calls,
               [&] { signorini_offset<2>(contacts, particles.velocity, {}, paper.time.step, offset); }),
      repeated(calls, [&] { swept.sweep(true); }),
      repeated(calls, [&] { stale += renew_stale_lists(checked, particles) ? 1 : 0; }),
      repeated(calls, [&] { start(started); }),
      repeated(calls, [&] { pushed_system.apply_impulses(contacts.impulse); }),
      repeated(calls,
               [&] {
                 set_reference(rebuilt.reference, rebuilt.particles);
                 rebuilt.rebuild_contacts();
                 listed.update(rebuilt.particles, rebuilt.reference);
               }),
  });
  return {.whole = seconds[0] / steps_measured,
          .attraction = seconds[1] / calls,
          .detection = seconds[2] / calls,
          .offsets = seconds[3] / calls,
          .sweeps = mean.sweeps * seconds[4] / calls,
          .stale = seconds[5] / calls,
          .warm_start = seconds[6] / calls,
          .velocities = seconds[7] / calls,
          .rebuild = mean.rebuilds * seconds[8] / calls};
}

}  // namespace

int main(int argc, char** argv) {
  Results results("bpm_step", argc, argv);
  Case paper;
  paper.time.step = 0.25e-6;
  Simulation simulation = simulation_of(paper);
  for (int k = 0; k < steps_before; ++k) simulation.step();
  const MeanStep mean = run_steps(simulation);
  const StepParts part = time_parts(simulation, paper, mean);
  const int n = bonded(simulation).particles.size(), m = bonded(simulation).contacts.size();
  results.heading(fmt::format(
      "{} primaries, {} candidates, {:.0f} carry impulse; {:.1f} sweeps and {:.4f} rebuilds per step", n, m,
      mean.contacts, mean.sweeps, mean.rebuilds));

  double rest = part.whole;
  const auto add = [&](const char* what, double seconds) {
    rest -= seconds;
    results.add({.what = what,
                 .value = 1e6 * seconds,
                 .unit = "us",
                 .ratio = seconds / part.whole,
                 .reference = "whole step"});
  };
  add("sweeps", part.sweeps);
  add("attraction", part.attraction);
  add("detection", part.detection);
  add("rebuild of both lists", part.rebuild);
  add("warm start, in single precision", part.warm_start);
  add("velocities from impulses", part.velocities);
  add("offsets", part.offsets);
  add("question whether to rebuild", part.stale);
  add("the rest: work, report, wall forces, drift", rest);
  add("whole step", part.whole);
  results.add({.what = "whole step, per primary", .value = 1e9 * part.whole / n, .unit = "ns"});
  results.add({.what = "whole step, per candidate contact", .value = 1e9 * part.whole / m, .unit = "ns"});
  results.add({.what = "whole step, per candidate contact and sweep",
               .value = 1e9 * part.whole / (m * mean.sweeps),
               .unit = "ns"});
}
