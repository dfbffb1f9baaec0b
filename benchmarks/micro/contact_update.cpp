// CPU time of one contact update of nonlinear Gauss-Seidel, five ways, over all candidates of a dense
// packing.
#include <fmt/core.h>

#include "harness.hpp"
#include "packing.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/rigid/narrow_sweeps.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int warm_up_sweeps = 200;

/// Sweeps in a timed piece: about two million contact updates.
int sweeps_for(int contacts) { return 2'000'000 / contacts + 1; }

void measure(const PackingSize& size, double mu, Results& results) {
  ContactProblem problem = collapse_problem(size, mu);
  const FullProblem full = full_problem(problem);
  warm_up(problem, warm_up_sweeps);
  const int m = problem.contacts.size(), sweeps = sweeps_for(m);
  results.heading(fmt::format("{} disks, mu = {}: {} candidate contacts, {} carry impulse ({:.2f} per disk)",
                              size.disks(), mu, m, problem.active(),
                              static_cast<double>(problem.active()) / size.disks()));

  const std::vector<double>& friction = problem.contacts.friction;
  RigidContactSystem<2> system(problem.particles, problem.contacts, problem.offset);
  const SolverOptions options;
  const auto lanes = [&] {
    for (int k = 0; k < sweeps; ++k) system.sweep(problem.contacts.impulse, friction, options);
  };
  NarrowSweeps narrow;
  narrow.start(
      problem.particles, problem.contacts, [](int, int) {}, problem.offset, options.relaxation);
  const auto single = [&] {
    for (int k = 0; k < sweeps; ++k) narrow.sweep(true);
  };
  const auto generic = [&] {
    for (int k = 0; k < sweeps; ++k) nlgs_sweep<2>(system, problem.contacts.impulse, friction, 1.0);
  };
  DelassusSystem<2> stored(full.W, full.q);
  std::vector<Vec<2>> p = problem.contacts.impulse;
  for (int c = 0; c < m; ++c) stored.apply_impulse(c, p[c]);
  const auto with_matrix = [&] {
    for (int k = 0; k < sweeps; ++k) nlgs_sweep<2>(stored, p, friction, 1.0);
  };
  const auto seconds = fastest({lanes, generic, with_matrix, single});
  const double updates = static_cast<double>(m) * sweeps;
  const auto add = [&](const char* what, double time, const char* reference) {
    results.add({.what = fmt::format("{} disks, mu {}: {}", size.disks(), mu, what),
                 .value = 1e9 * time / updates,
                 .unit = "ns/update",
                 .ratio = time / seconds[1],
                 .reference = reference});
  };
  add("generic sweep", seconds[1], "itself");
  add("four-lane sweep", seconds[0], "generic sweep");
  add("eight-lane sweep in single precision", seconds[3], "generic sweep");
  add("generic sweep with W in full", seconds[2], "generic sweep");
}

}  // namespace

int main(int argc, char** argv) {
  Results results("contact_update", argc, argv);
  for (const PackingSize& size : {small_packing, middle_packing, large_packing})
    for (const double mu : {0.0, 0.5}) measure(size, mu, results);
}
