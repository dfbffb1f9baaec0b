// CPU time of the parts of an implicit step of a dense packing, of a point's internal force, and of a whole
// compaction: `mpm_step [GRAINS CELLS]`, by default 20 grains of 3 584 points and a quarter of that.
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <span>

#include "harness.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/soft/elastic_contacts.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr double speed = 5, implicit_dt = 5e-6, last_phi = 0.985;

struct Packing {
  std::vector<Wall<2>> walls;
  double area = 0, side = 0;
  SoftGrains grains;

  Packing(int count, int cells)
      : grains(placed(count, cells), make_law(MaterialLaw::neo_hookean, 10e6, 0.45), 990) {
    walls = {{{0, 0}, {0, 1}, {}},
             {{0, side}, {0, -1}, {0, -speed}},
             {{0, 0}, {1, 0}, {}},
             {{side, 0}, {-1, 0}, {}}};
  }

 private:
  std::vector<GrainPlacement> placed(int count, int cells) {
    const BoxSample sample = sample_box({.grains = count});
    const auto shape = std::make_shared<const Topology>(disk_grid(cells));
    std::vector<GrainPlacement> placed;
    for (const PlacedGrain& grain : sample.grains) {
      placed.push_back({shape, grain.radius, grain.centre, grain.angle, {}});
      area += std::numbers::pi * grain.radius * grain.radius;
    }
    side = sample.width;  // square
    return placed;
  }
};

/// Steps a packing until Phi_0 reaches `phi`.
template <class Dynamics>
SoftStepReport compact(Dynamics& dynamics, const Packing& packing, double dt, double phi, int& steps) {
  SoftStepReport sum;
  while (packing.area / (packing.side * dynamics.box.walls[1].point[1]) < phi) {
    const SoftStepReport report = dynamics.step(dt);
    ++steps;
    sum.iterations += report.iterations;
    sum.sweeps += report.sweeps;
    sum.rejected += report.rejected;
    sum.factorisations += report.factorisations;
  }
  return sum;
}

void add_run(Results& results, const std::string& name, const SoftStepReport& sum, int steps, double seconds,
             double points) {
  results.add({.what = name + ": to Phi_0 = 0.985", .value = seconds, .unit = "s"});
  results.add({.what = name + ": steps", .value = 1.0 * steps, .unit = ""});
  results.add(
      {.what = name + ": Newton iterations per step", .value = 1.0 * sum.iterations / steps, .unit = ""});
  results.add(
      {.what = name + ": sweeps per iteration", .value = 1.0 * sum.sweeps / sum.iterations, .unit = ""});
  results.add({.what = name + ": rejected steps", .value = 1.0 * sum.rejected, .unit = ""});
  results.add(
      {.what = name + ": per point and step", .value = 1e9 * seconds / (steps * points), .unit = "ns"});
}

/// The parts of one Newton iteration at the end of a compaction, and of the factorisation of a step.
void measure_parts(Results& results, const std::string& name, ImplicitDynamics& dynamics, double points) {
  const SoftGrains& grains = dynamics.grains;
  std::vector<BatchedCholesky> A;
  std::vector<OutlineCompliance> compliance;
  std::vector<WideVectors> half, force(grains.batches.size());
  for (const GrainBatch& batch : grains.batches) {
    A.emplace_back(batch.topology->pattern);
    const std::size_t width = 2 * batch.topology->grid.outline_nodes();
    compliance.emplace_back(Wide::size * width * width);
    half.emplace_back(batch.position.size());
  }
  const auto for_batches = [&](auto&& work) {
    return [&, work] {
      for (std::size_t b = 0; b < A.size(); ++b) work(b);
    };
  };
  const auto assemble = for_batches([&](std::size_t b) {
    const GrainBatch& batch = grains.batches[b];
    A[b].clear(Precision::single);  // as ImplicitDynamics for these steps
    add_stiffness(grains, batch, A[b]);
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide m = grains.node_mass(batch, i) * Wide(1 / (implicit_dt * implicit_dt));
      A[b].add(i, i, {m, 0.0, 0.0, m});
    }
  });
  WideVectors kept;
  OutlineState state{.position = {}, .start = {}, .walls = dynamics.box.walls, .dt = implicit_dt};
  grains.gather_outline(state.position);
  state.start = state.position;
  OutlineNeighbours neighbours;
  std::vector<OutlineContact> contacts = neighbours.detect(grains, state);
  const std::vector<Vec<2>> increment(grains.outline_size());
  const std::vector<double> friction(contacts.size(), 0.0);
  std::vector<Vec<2>> impulse;
  SolverReport solved;
  ElasticScratch scratch;

  assemble();
  double factored = 0;
  const double assembly = seconds_of(assemble);
  double least_assembly = assembly;
  for (int round = 0; round < 5; ++round) {
    least_assembly = std::min(least_assembly, seconds_of(assemble));
    const double now = seconds_of(for_batches([&](std::size_t b) { A[b].factor(); }));
    factored = round == 0 ? now : std::min(factored, now);
  }
  const auto seconds = fastest({
      for_batches([&](std::size_t b) { internal_force(grains, grains.batches[b], force[b]); }),
      for_batches([&](std::size_t b) { A[b].kept_inverse(compliance[b]); }),
      for_batches([&](std::size_t b) {
        kept.resize(grains.batches[b].topology->grid.outline_nodes());
        A[b].begin_solve(numbers(force[b]), numbers(half[b]), numbers(kept));
        A[b].finish_solve(numbers(half[b]), numbers(kept), numbers(half[b]));
      }),
      [&] { contacts = neighbours.detect(grains, state); },
      [&] { ElasticContacts(grains, contacts, compliance, increment, implicit_dt, scratch); },
      [&] {
        ElasticContacts system(grains, contacts, compliance, increment, implicit_dt, scratch);
        impulse = carried_impulses(grains, dynamics.contacts, dynamics.impulse, contacts);
        system.apply_impulses(impulse);
        SolverOptions options{.max_sweeps = 10, .tolerance = 0};
        options.velocity_scale = dynamics.mean_radius() / implicit_dt;
        solved = solve_nlgs<2>(system, std::span(impulse), friction, options);
      },
  });
  const auto add = [&](const char* part, double s) {
    results.add({.what = fmt::format("{}: {}", name, part), .value = 1e9 * s / points, .unit = "ns/point"});
  };
  add("internal force", seconds[0]);
  add("tangent stiffness", least_assembly);
  add("Cholesky factor", factored);
  add("compliance of the outlines", seconds[1]);
  add("solve", seconds[2]);
  add("detection", seconds[3]);
  add("Delassus blocks", seconds[4]);
  add("ten sweeps of NLGS, with columns", seconds[5] - seconds[4]);
}

void measure(Results& results, int count, int cells) {
  const Packing packing(count, cells);
  const double points = 14.0 * cells * cells * count;
  results.heading(fmt::format("{} grains of {} points", count, 14 * cells * cells));
  const std::string name = fmt::format("{} grains, cells {}", count, cells);
  ImplicitDynamics implicit(packing.grains, packing.walls, {});
  int steps = 0;
  SoftStepReport sum;
  const double implicit_seconds =
      seconds_of([&] { sum = compact(implicit, packing, implicit_dt, last_phi, steps); });
  add_run(results, name + ", implicit", sum, steps, implicit_seconds, points);
  measure_parts(results, name, implicit, points);
  ExplicitDynamics explicit_(packing.grains, packing.walls, {});
  const double dt = stable_time_step(packing.grains);
  steps = 0;
  const double explicit_seconds = seconds_of([&] { sum = compact(explicit_, packing, dt, last_phi, steps); });
  add_run(results, name + ", explicit", sum, steps, explicit_seconds, points);
}

}  // namespace

int main(int argc, char** argv) {
  Results results("mpm_step", argc, argv);
  if (argc > 2 && std::atoi(argv[1]) > 0) {
    measure(results, std::atoi(argv[1]), std::atoi(argv[2]));
    return 0;
  }
  measure(results, 20, 8);
  measure(results, 20, 16);
}
