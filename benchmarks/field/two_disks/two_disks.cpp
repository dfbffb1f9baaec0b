// Case 2 of the soft-grain benchmark set: two soft disks fly at each other along the diagonal (Sulsky, Chen
// and Schreyer 1994) by softgrain's explicit step, by its implicit one, and by points that move through a
// lattice with contact on its nodes, as most codes of material points have it. Initial velocities are no part
// of a case file.
//   two_disks explicit|implicit|points CELLS > FILE     CELLS across a disk, of the grid or of the lattice
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>

#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/stable_step.hpp"

using namespace softgrain;

namespace {

constexpr double radius = 0.2, speed = 0.1, density = 1000, duration = 1.6;  // [m] [m/s] [kg/m^3] [s]
constexpr double from = 0.35, to = 0.65;                                     // centres on the diagonal [m]

AnyLaw law() { return make_law(MaterialLaw::neo_hookean, 1000, 0.3); }

/// A row every 10 ms: kinetic and stored energy [J/m], distance of the centres [m], contacts.
void row(double time, double kinetic, double elastic, const Vec<2>& apart, int contacts) {
  fmt::print("{:.4f},{:.6g},{:.6g},{:.6g},{}\n", time, kinetic, elastic, norm(apart), contacts);
}

/// step() once a dt, show(time, contacts) every 10 ms. Contacts: most of a step since the row before.
template <class Step, class Show>
void go(double dt, Step step, Show show) {
  fmt::print("time[s],kinetic_energy[J/m],elastic_energy[J/m],distance[m],contacts\n");
  show(0.0, 0);
  int contacts = 0, rows = 1;
  for (int k = 1; k * dt < duration; ++k) {
    contacts = std::max(contacts, step());
    if (k * dt < rows * 0.01) continue;
    show(k * dt, contacts);
    contacts = 0;
    ++rows;
  }
}

template <class Dynamics>
void on_grids(int cells, double share_of_stable) {
  const auto shape = std::make_shared<const Topology>(disk_grid(cells));
  const auto at = [&](double place, double v) {
    return GrainPlacement{.topology = shape, .radius = radius, .centre = {place, place}, .velocity = {v, v}};
  };
  SoftGrains grains({at(from, speed), at(to, -speed)}, law(), density);
  const double dt = share_of_stable * stable_time_step(grains, 1.0);
  Dynamics dynamics(std::move(grains), {}, {});
  go(
      dt, [&] { return dynamics.step(dt).contacts; },
      [&](double time, int contacts) {
        const auto& batch = dynamics.grains.batches[0];  // both grains are lanes of it
        const Wide elastic = elastic_energy(dynamics.grains, batch);
        const Vec<2, Wide> x = centre_of_mass(dynamics.grains, batch, batch.position);
        row(time, dynamics.grains.kinetic_energy(), elastic[0] + elastic[1],
            Vec<2>{x[0][1] - x[0][0], x[1][1] - x[1][0]}, contacts);
      });
}

Vec<2> centre(const PointGrain& grain) {
  Vec<2> sum;
  for (int p = 0; p < grain.points(); ++p) sum += grain.volume[p] / grain.area() * grain.position[p];
  return sum;
}

void on_a_lattice(int cells) {
  const double cell = 2 * radius / cells;
  PointGrain a = disk_of_points(radius, {from, from}, cell, 80),
             b = disk_of_points(radius, {to, to}, cell, 80);
  for (Vec<2>& v : a.velocity) v = {speed, speed};
  for (Vec<2>& v : b.velocity) v = {-speed, -speed};
  UpdatedLagrangianDynamics dynamics(
      {std::move(a), std::move(b)}, {}, law(), density,
      {.shape = ShapeFunction::bilinear, .contact_on = ContactOn::grid_nodes, .cell = cell});
  const double dt = stable_time_step(law(), density, cell);
  go(
      dt, [&] { return dynamics.step(dt).contacts; },
      [&](double time, int contacts) {
        row(time, dynamics.grains[0].kinetic_energy(density) + dynamics.grains[1].kinetic_energy(density),
            dynamics.elastic_energy(), centre(dynamics.grains[1]) - centre(dynamics.grains[0]), contacts);
      });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string way = argc == 3 ? argv[1] : "";
  const int cells = argc == 3 ? std::atoi(argv[2]) : 0;
  if (cells < 4 || (way != "explicit" && way != "implicit" && way != "points")) {
    fmt::print(stderr, "two_disks explicit|implicit|points CELLS, CELLS at least 4\n");
    return 2;
  }
  if (way == "explicit") on_grids<ExplicitDynamics>(cells, 0.4);
  if (way == "implicit") on_grids<ImplicitDynamics>(cells, 2.0);
  if (way == "points") on_a_lattice(cells);
}
