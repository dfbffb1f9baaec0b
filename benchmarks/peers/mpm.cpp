// geomechanics/mpm (the successor of CB-Geo MPM) and softgrain on the same vibrating blocks, with the same
// material, cells and points: velocities against the closed form, CPU time of one point in one step.
//   SOFTGRAIN_MPM_SOURCE=/path/to/mpm mpm_peer [--csv FILE]
// builds geomechanics/mpm from its source tree at the first time.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>

#include "harness.hpp"
#include "peers/geomechanics_mpm.hpp"
#include "peers/vibrating_blocks.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

using Outcome = GeomechanicsMpm::Outcome;

constexpr int rounds = 5;
/// Implicit steps in the duration.
constexpr int implicit_steps = 32;
/// What velocities may be off [rms, relative]: the closed form, with 36 cells in half a wave; the same with
/// 32 implicit steps; and the same method in the other code.
constexpr double explicit_error = 0.02, implicit_error = 0.1, code_error = 1e-4;

const AnyLaw law = make_law(MaterialLaw::neo_hookean, VibratingBlocks::E, VibratingBlocks::nu);

/// The grid of a block, in units of its side; nodes of the outline last, counter-clockwise.
ReferenceGrid block_grid(int n) {
  ReferenceGrid grid;
  std::vector<int> number((n + 1) * (n + 1));
  const auto at = [&](int i, int j) -> int& { return number[j * (n + 1) + i]; };
  const auto add = [&](int i, int j) {
    at(i, j) = grid.nodes();
    grid.node.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n});
  };
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) add(i, j);
  grid.outline_begin = grid.nodes();
  for (int i = 0; i < n; ++i) add(i, 0);
  for (int j = 0; j < n; ++j) add(n, j);
  for (int i = n; i > 0; --i) add(i, n);
  for (int j = n; j > 0; --j) add(0, j);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) grid.cell.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return grid;
}

/// Total Lagrangian: every block has its own grid.
SoftGrains soft_blocks(const VibratingBlocks& blocks, const std::shared_ptr<const Topology>& shape) {
  std::vector<GrainPlacement> placed;
  for (int b = 0; b < blocks.count; ++b)
    placed.push_back(
        {.topology = shape, .radius = blocks.side(), .centre = blocks.corner(b), .velocity = {}});
  SoftGrains grains(placed, law, blocks.rho);
  for (GrainBatch& batch : grains.batches)
    for (int i = 0; i < shape->grid.nodes(); ++i) {
      const Vec<2> u = blocks.displacement(blocks.side() * shape->grid.node[i]);
      batch.position[i] += {u[0], u[1]};
    }
  return grains;
}

/// Velocities of the points, v_p = sum_i N_ip v_i.
std::vector<Vec<2>> point_velocities(const SoftGrains& grains) {
  std::vector<Vec<2>> velocity;
  for (int g = 0; g < grains.size(); ++g) {
    const Topology& shape = grains.topology(g);
    const auto [batch, lane] = grains.batch_of(g);
    for (std::size_t p = 0; p < shape.points.size(); ++p) {
      Vec<2>& v = velocity.emplace_back();
      for (int a = 0; a < 4; ++a) {
        const Vec<2, Wide>& v_i = batch->velocity[shape.grid.cell[p / 4][a]];
        v += shape.points[p].shape[a] * Vec<2>{v_i[0][lane], v_i[1][lane]};
      }
    }
  }
  return velocity;
}

/// `steps` of dt on one of our dynamics; CPU time of one [s].
template <class Dynamics>
double step_seconds(Dynamics& dynamics, int steps, double dt) {
  return seconds_of(repeated(steps, [&] { dynamics.step(dt); })) / steps;
}

template <class Dynamics, class Options>
Outcome run_total_lagrangian(SoftGrains grains, const Options& options, int steps, double dt) {
  Dynamics dynamics(std::move(grains), {}, options);
  const double seconds = step_seconds(dynamics, steps, dt);
  return {.step_seconds = seconds, .velocity = point_velocities(dynamics.grains)};
}

/// Updated Lagrangian: at rest with the stress of the mode, but not yet displaced, as theirs.
std::vector<PointGrain> point_blocks(const VibratingBlocks& blocks) {
  const int points = blocks.points() / blocks.count;
  const std::vector<Vec<2>> position = blocks.positions();
  const ReferenceGrid grid = block_grid(blocks.cells);
  std::vector<PointGrain> grains(blocks.count);
  for (int b = 0; b < blocks.count; ++b) {
    PointGrain& grain = grains[b];
    grain.radius = blocks.side() / 2;
    grain.volume.assign(points, blocks.h * blocks.h / 4);
    grain.position.assign(position.begin() + b * points, position.begin() + (b + 1) * points);
    grain.velocity.resize(points);
    for (int p = 0; p < points; ++p) {
      const Mat<2> H = blocks.displacement_gradient(blocks.from_corner(p));
      grain.F.push_back(Mat<2>::diagonal({1 + H(0, 0), 1 + H(1, 1)}));
    }
    for (const Vec<2>& X : grid.outline()) grain.outline.push_back(blocks.corner(b) + blocks.side() * X);
  }
  return grains;
}

Outcome run_updated_lagrangian(std::vector<PointGrain> grains, int steps, double dt) {
  UpdatedLagrangianDynamics dynamics(
      std::move(grains), {}, law, VibratingBlocks::rho,
      {.shape = ShapeFunction::bilinear, .cell = VibratingBlocks::h, .pic_share = 0});
  Outcome outcome{.step_seconds = step_seconds(dynamics, steps, dt), .velocity = {}};
  for (const PointGrain& grain : dynamics.grains)
    outcome.velocity.insert(outcome.velocity.end(), grain.velocity.begin(), grain.velocity.end());
  return outcome;
}

/// One way to compute the blocks.
struct Method {
  std::string name;
  int steps = 0;  ///< over the duration
  std::function<Outcome(int steps)> run;
  int reference = 0;     ///< the method that its cost is compared with
  double error = 0;      ///< what its velocities may be off
  int same_method = -1;  ///< of the other code
};

std::vector<Method> methods_for(const GeomechanicsMpm& theirs, const VibratingBlocks& blocks,
                                const std::shared_ptr<const Topology>& shape) {
  const int steps = blocks.explicit_steps();
  const double dt = blocks.duration() / steps, long_dt = blocks.duration() / implicit_steps;
  const auto their_run = [&theirs](const GeomechanicsMpm::Scheme& scheme) {
    return [&theirs, scheme](int n) { return theirs.run(scheme, n); };
  };
  return {
      {"geomechanics/mpm USF", steps, their_run({.stress_update = "usf", .steps_in_duration = steps}), 0,
       explicit_error},
      {"geomechanics/mpm MUSL", steps, their_run({.stress_update = "musl", .steps_in_duration = steps}), 0,
       explicit_error},
      {"softgrain updated Lagrangian", steps,
       [=](int n) { return run_updated_lagrangian(point_blocks(blocks), n, dt); }, 0, explicit_error, 1},
      {"softgrain explicit", steps,
       [=](int n) {
         return run_total_lagrangian<ExplicitDynamics>(soft_blocks(blocks, shape), ExplicitOptions{}, n, dt);
       },
       0, explicit_error},
      {"geomechanics/mpm implicit", implicit_steps,
       their_run(
           {.analysis = "MPMImplicit2D", .stress_update = "newmark", .steps_in_duration = implicit_steps}),
       4, implicit_error},
      {"softgrain implicit", implicit_steps,
       [=](int n) {
         return run_total_lagrangian<ImplicitDynamics>(soft_blocks(blocks, shape),
                                                       ImplicitOptions{.tolerance = 1e-8}, n, long_dt);
       },
       4, implicit_error},
  };
}

using Velocities = std::vector<Vec<2>>;

/// Runs all methods to the end. False if velocities of one of them are off by more than they may be.
bool compare_velocities(const std::string& name, const VibratingBlocks& blocks,
                        const std::vector<Method>& methods, Results& results) {
  const Velocities closed = blocks.closed_velocity();
  std::vector<Velocities> velocity;
  bool accurate = true;
  const auto add = [&](const std::string& what, const Velocities& reference, double largest) {
    const double error = relative_difference(velocity.back(), reference);
    results.add({.what = fmt::format("{}: {}", name, what), .value = error, .unit = ""});
    accurate = accurate && error < largest;
  };
  for (const Method& method : methods) {
    velocity.push_back(method.run(method.steps).velocity);
    add("velocity error, " + method.name, closed, method.error);
    if (method.same_method >= 0)
      add("velocity off that of " + methods[method.same_method].name, velocity[method.same_method],
          code_error);
  }
  return accurate;
}

/// Runs all methods a quarter of the way in turn, `rounds` times.
void compare_costs(const std::string& name, const VibratingBlocks& blocks, const std::vector<Method>& methods,
                   Results& results) {
  std::vector<double> seconds(methods.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t m = 0; m < methods.size(); ++m)
      seconds[m] = std::min(seconds[m], methods[m].run(methods[m].steps / 4).step_seconds);
  for (std::size_t m = 0; m < methods.size(); ++m)
    results.add({.what = fmt::format("{}: a point in one step, {}", name, methods[m].name),
                 .value = 1e9 * seconds[m] / blocks.points(),
                 .unit = "ns",
                 .ratio = seconds[m] / seconds[methods[m].reference],
                 .reference = methods[methods[m].reference].name});
}

void compare(const std::filesystem::path& program, const VibratingBlocks& blocks, Results& results) {
  const std::string name = fmt::format("{} block{}", blocks.count, blocks.count > 1 ? "s" : "");
  results.heading(fmt::format("{} of {} x {} cells, {} points, {} explicit and {} implicit steps", name,
                              blocks.cells, blocks.cells, blocks.points(), blocks.explicit_steps(),
                              implicit_steps));
  const GeomechanicsMpm theirs(program, blocks);
  const auto shape = std::make_shared<const Topology>(block_grid(blocks.cells));
  const std::vector<Method> methods = methods_for(theirs, blocks, shape);
  if (!compare_velocities(name, blocks, methods, results))
    throw NumericalError(
        "velocities are further off than the methods are: the codes do not compute the same");
  compare_costs(name, blocks, methods, results);
}

}  // namespace

int main(int argc, char** argv) {
  const char* source = std::getenv("SOFTGRAIN_MPM_SOURCE");
  if (source == nullptr || *source == '\0') {
    fmt::print("mpm_peer is left out: SOFTGRAIN_MPM_SOURCE names no source tree of geomechanics/mpm\n");
    return 0;
  }
  try {
    const std::filesystem::path program = build_geomechanics_mpm(source);
    Results results("mpm", argc, argv);
    compare(program, {.count = 1, .cells = 100}, results);
    compare(program, {.count = 8, .cells = 36}, results);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mpm_peer: {}\n", error.what());
    return 1;
  }
}
