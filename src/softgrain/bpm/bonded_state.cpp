#include <utility>

#include "softgrain/bpm/bonded_grains.hpp"
#include "softgrain/rigid/contact_state.hpp"

namespace softgrain {

template <int Dim>
void BondedGrainsOf<Dim>::visit(StateVisitor& visit) {
  RigidParticles<Dim>& particles = dynamics_.particles;
  NeighbourReference<Dim>& reference = dynamics_.reference;
  visit({"position", "m", Owner::body, Role::state, "centres of the primaries"}, particles.position);
  visit({"velocity", "m/s", Owner::body, Role::state, "velocities of primaries, then walls"},
        particles.velocity);
  visit({"spin", "m/s", Owner::body, Role::state, "R omega of primaries, then walls"}, particles.spin);
  visit({"list_position", "m", Owner::body, Role::list, "where the lists inside grains were made"},
        reference.position);
  visit({"list_between", "m", Owner::body, Role::list, "where the list between grains was made"},
        reference.between);
  visit({"list_wall_point", "m", Owner::wall, Role::list, "where the walls were then"}, reference.wall_point);
  PeriodicCell<Dim> list_cell = particles.cell;
  if (list_cell.any())
    visit_matrix(visit, {"list_cell", "m", Owner::run, Role::list, "lattice vectors of the cell then"},
                 visit.reads() ? list_cell.edges : reference.cell.edges);
  visit(
      {"impulse_time", "s", Owner::run, Role::start, "the step over which impulses acted; 0: none was made"},
      impulse_time_);
  visit({"work_of_walls", "J/m", Owner::run, Role::sum, "done by the walls"}, work_.walls);
  visit({"work_dissipated", "J/m", Owner::run, Role::sum, "in all contacts"}, work_.dissipation);
  visit({"work_dissipated_between", "J/m", Owner::run, Role::sum, "of it between grains and at walls"},
        work_.between);
  visit({"work_dissipated_sliding", "J/m", Owner::run, Role::sum, "of that by sliding"}, work_.friction);
  visit({"energy_start", "J/m", Owner::run, Role::sum, "potential energies before the first step"},
        work_.energy_start);
  if (!(gravity_ == Vec<Dim>{}))
    visit({"height_start", "J/m", Owner::run, Role::sum, "of them that of gravity"}, work_.height_start);
  // the lists are a function of their reference, so they come back in the same order
  if (visit.reads()) {
    restore_reference(reference, particles, std::move(reference.position), std::move(reference.between),
                      std::move(reference.wall_point), list_cell);
    dynamics_.rebuild_contacts();
  }
  visit_impulses(dynamics_.contacts, visit, [&](std::int64_t a, std::int64_t b) {
    if (reference.shares.alone() || !(0 <= a && a < b && b < particles.size())) return true;
    const int grain = particles.grain[a];
    return grain != particles.grain[b] || reference.shares.mine(grain);
  });
}

template <int Dim>
Settings BondedGrainsOf<Dim>::settings() const {
  return {.friction = friction_.between,
          .wall_friction = friction_.wall,
          .solver_tolerance = dynamics_.options.solver.tolerance};
}

template <int Dim>
void BondedGrainsOf<Dim>::set(const Settings& settings) {
  double& tolerance = dynamics_.options.solver.tolerance;
  tolerance = settings.solver_tolerance.value_or(tolerance);
  const double between = settings.friction.value_or(friction_.between),
               wall = settings.wall_friction.value_or(friction_.wall);
  if (between == friction_.between && wall == friction_.wall) return;
  friction_.between = between;
  friction_.wall = wall;
  dynamics_.set_friction(friction_.rule(dynamics_.particles.grain, kind_));
}

template <int Dim>
void BondedGrainsOf<Dim>::go_on(const Box<Dim>& box) {
  dynamics_.particles.walls = box.walls;
  dynamics_.particles.cell = dynamics_.contacts.cell = box.cell;
  detect_contacts(dynamics_.particles, dynamics_.contacts);
  list_attraction();
}

template <int Dim>
void BondedGrainsOf<Dim>::gather() {
  dynamics_.gather();
  list_attraction();
}

/// Of all grains on the first rank, which alone is asked for energies; elsewhere of this rank's.
template <int Dim>
void BondedGrainsOf<Dim>::list_attraction() {
  const bool of_all = communicator().rank() == 0;
  attraction_.update(dynamics_.particles, dynamics_.reference,
                     of_all ? Shares() : dynamics_.reference.shares);
}

template void BondedGrainsOf<2>::visit(StateVisitor&);
template void BondedGrainsOf<3>::visit(StateVisitor&);
template Settings BondedGrainsOf<2>::settings() const;
template Settings BondedGrainsOf<3>::settings() const;
template void BondedGrainsOf<2>::set(const Settings&);
template void BondedGrainsOf<3>::set(const Settings&);
template void BondedGrainsOf<2>::go_on(const Box<2>&);
template void BondedGrainsOf<3>::go_on(const Box<3>&);
template void BondedGrainsOf<2>::gather();
template void BondedGrainsOf<3>::gather();
template void BondedGrainsOf<2>::list_attraction();
template void BondedGrainsOf<3>::list_attraction();

}  // namespace softgrain
