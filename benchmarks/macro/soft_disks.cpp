// 500 soft disks of 57 nodes (and of 73, mpm.cells = 4) with friction, compacted until 3 500 contact points
// carry impulse: CPU time of one implicit step, beside the 2.2 s that LMGC90 takes for as many on a like
// machine.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <numbers>

#include "harness.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/soft/implicit_step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int disks = 500, wanted_contacts = 3500, steps_timed = 20, rounds = 5;
constexpr double mu = 0.3, speed = 5, dt = 5e-6;  // of the top wall [m/s], of a step [s]
constexpr double reference_step = 2.2;            // [s] LMGC90, 500 x 57 nodes, 3 500 contacts

/// The grid of mpm.cells = 4 without the innermost of its three rings: 5 x 5 + 2 x 16 = 57 nodes.
ReferenceGrid grid_of_57_nodes() {
  constexpr int inner_nodes = 25, inner_cells = 16, around = 16;
  ReferenceGrid grid = disk_grid(4);
  for (int k = inner_cells; k < inner_cells + around; ++k) {  // the second ring now begins at the square
    grid.cell[k][1] = grid.cell[k + around][1];
    grid.cell[k][2] = grid.cell[k + around][2];
  }
  grid.cell.erase(grid.cell.begin() + inner_cells + around, grid.cell.begin() + inner_cells + 2 * around);
  grid.node.erase(grid.node.begin() + inner_nodes, grid.node.begin() + inner_nodes + around);
  for (auto& cell : grid.cell)
    for (int& node : cell)
      if (node >= inner_nodes) node -= around;
  grid.outline_begin -= around;
  return grid;
}

/// A box of loose disks under a top wall that comes down.
ImplicitDynamics loose_box(ReferenceGrid grid) {
  const BoxSample sample = sample_box({.grains = disks});
  const auto shape = std::make_shared<const Topology>(std::move(grid));
  std::vector<GrainPlacement> placed;
  for (const PlacedGrain& grain : sample.grains)
    placed.push_back({shape, grain.radius, grain.centre, grain.angle, {}});
  std::vector<Wall<2>> walls{{{0, 0}, {0, 1}, {}},
                             {{0, sample.height}, {0, -1}, {0, -speed}},
                             {{0, 0}, {1, 0}, {}},
                             {{sample.width, 0}, {-1, 0}, {}}};
  return {SoftGrains(std::move(placed), make_law(MaterialLaw::neo_hookean, 10e6, 0.45), 990),
          std::move(walls),
          {.friction = mu, .wall_friction = mu}};
}

double packing_fraction(const ImplicitDynamics& dynamics) {
  const std::vector<Wall<2>>& walls = dynamics.box.walls;
  double area = 0;
  for (int g = 0; g < disks; ++g) {
    const double radius = dynamics.grains.radius(g);
    area += std::numbers::pi * radius * radius;
  }
  return area / (walls[1].point[1] * walls[3].point[0]);
}

/// What `steps_timed` steps did together.
struct Window {
  SoftStepReport sum;
  int candidates = 0;  ///< contact points within the margin of detection, at the end
  double seconds = std::numeric_limits<double>::infinity();
};

Window timed_steps(ImplicitDynamics dynamics) {
  Window window;
  window.seconds = seconds_of([&] {
    for (int k = 0; k < steps_timed; ++k) {
      const SoftStepReport report = dynamics.step(dt);
      window.sum.iterations += report.iterations;
      window.sum.sweeps += report.sweeps;
      window.sum.factorisations += report.factorisations;
      window.sum.rejected += report.rejected;
      window.sum.contacts += report.contacts;
    }
  });
  window.candidates = static_cast<int>(dynamics.contacts.size());
  return window;
}

void measure(ReferenceGrid grid, Results& results) {
  ImplicitDynamics dynamics = loose_box(std::move(grid));
  while (dynamics.step(dt).contacts < wanted_contacts) {
  }
  Window window;
  for (int round = 0; round < rounds; ++round) {  // every time from the same state
    const double fastest = window.seconds;
    window = timed_steps(dynamics);
    window.seconds = std::min(window.seconds, fastest);
  }
  const int nodes = dynamics.grains.topology(0).grid.nodes();
  const int factored = window.sum.factorisations / static_cast<int>(dynamics.grains.batches.size());
  const auto per_step = [](double sum) { return sum / steps_timed; };
  results.heading(fmt::format("{} disks of {} nodes, mu = {}, Phi_0 = {:.3f}, {} contact points within reach",
                              disks, nodes, mu, packing_fraction(dynamics), window.candidates));
  const std::string name = fmt::format("{} nodes a disk: ", nodes);
  results.add({.what = name + "contact points that carry impulse",
               .value = per_step(window.sum.contacts),
               .unit = ""});
  results.add(
      {.what = name + "Newton iterations per step", .value = per_step(window.sum.iterations), .unit = ""});
  results.add({.what = name + "factorisations per step", .value = per_step(factored), .unit = ""});
  results.add({.what = name + "rejected steps", .value = per_step(window.sum.rejected), .unit = ""});
  results.add({.what = name + "sweeps per step", .value = per_step(window.sum.sweeps), .unit = ""});
  results.add({.what = name + "one implicit step",
               .value = 1e3 * per_step(window.seconds),
               .unit = "ms",
               .ratio = per_step(window.seconds) / reference_step,
               .reference = "LMGC90 (2.2 s; measured elsewhere)"});
}

}  // namespace

int main(int argc, char** argv) {
  Results results("soft_disks", argc, argv);
  measure(grid_of_57_nodes(), results);
  measure(disk_grid(4), results);
}
