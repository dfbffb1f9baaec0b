#include "softgrain/bpm/bonded_grains.hpp"

namespace softgrain {
namespace {

constexpr int first_step_factor = 200;

}  // namespace

template <int Dim>
StepReport BondedGrainsOf<Dim>::step(Box<Dim>& box, double dt) {
  take_walls(box);
  if (keeps_problem_) velocity_start_ = dynamics_.particles.velocity;
  dynamics_.options.solver.max_sweeps = solver_options().max_sweeps;
  double power_of_cell = 0;
  StepReport report = dynamics_.step(
      [&](const RigidParticles<Dim>&, std::span<Vec<Dim>> force) { power_of_cell = add_forces(force); }, dt);
  report.residual_limit = dynamics_.options.solver.worst_factor * dynamics_.options.solver.tolerance;
  impulse_time_ = dt;
  for (std::size_t w = 0; w < box.walls.size(); ++w) {
    box.walls[w] = dynamics_.particles.walls[w];
    box.impulse[w] = dynamics_.wall_impulse(static_cast<int>(w));
  }
  box.presses = dynamics_.particles.presses;
  box.cell = dynamics_.particles.cell;
  add_work();
  work_.walls += dt * power_of_cell;
  // the stress of a cell asks for centres of mass after each step, an open box for the highest grain
  if (box.cell.any() || box.open_top) dynamics_.know_all();
  return report;
}

template <int Dim>
void BondedGrainsOf<Dim>::take_walls(const Box<Dim>& box) {
  dynamics_.particles.walls = box.walls;
  for (std::size_t w = 0; w < box.walls.size(); ++w)
    set_wall_velocity(dynamics_.particles, static_cast<int>(w), box.walls[w].velocity);
  dynamics_.particles.presses = box.presses;
  dynamics_.particles.cell = box.cell;
}

template <int Dim>
SolverOptions BondedGrainsOf<Dim>::solver_options() const {
  SolverOptions solver = dynamics_.options.solver;
  solver.max_sweeps = most_sweeps_ * (impulse_time_ == 0 ? first_step_factor : 1);
  return solver;
}

/// Returns the power of the cell [W/m].
template <int Dim>
double BondedGrainsOf<Dim>::add_forces(std::span<Vec<Dim>> force) {
  const RigidParticles<Dim>& particles = dynamics_.particles;
  const Shares& shares = dynamics_.reference.shares;
  attraction_.update(particles, dynamics_.reference, shares);
  attraction_.add_forces(particles, force, shares);
  const double power_of_cell = adhesion_.add_forces(particles, dynamics_.contacts, force);
  if (gravity_ == Vec<Dim>{}) return power_of_cell;
  particles.followed.for_each_range(particles.size(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) force[i] += particles.mass[i] * gravity_;
  });
  return power_of_cell;
}

template <int Dim>
RigidContactSystem<Dim> BondedGrainsOf<Dim>::begin_joint_step(double dt) {
  if (impulse_time_ > 0 && impulse_time_ != dt)  // the same force
    for (Vec<Dim>& p : dynamics_.contacts.impulse) p *= dt / impulse_time_;
  dynamics_.begin_step([&](const RigidParticles<Dim>&, std::span<Vec<Dim>> force) { add_forces(force); }, dt,
                       0);
  return dynamics_.contact_system(dt);
}

template <int Dim>
StepReport BondedGrainsOf<Dim>::end_joint_step(const SolverReport& solver, double dt,
                                               const JointWork& with_others) {
  const StepReport report = dynamics_.end_step(solver, dt, 0);
  impulse_time_ = dt;
  add_work();
  work_.between += with_others.contact;
  work_.friction += with_others.friction;
  return report;
}

template <int Dim>
void BondedGrainsOf<Dim>::add_work() {
  const StepWork& work = dynamics_.work;
  work_.walls += work.wall;
  work_.dissipation -= work.contact + work.push_out;
  work_.between -= work.between;
  work_.friction -= work.friction;
}

/// All primaries of a grain alike.
template <int Dim>
void BondedGrainsOf<Dim>::follow(const Mat<Dim>& L) {
  dynamics_.know_all();
  RigidParticles<Dim>& particles = dynamics_.particles;
  const double before = kinetic_energy(particles);
  const std::vector<Vec<Dim>> centre = centres();
  for (int i = 0; i < particles.size(); ++i) particles.velocity[i] += L * centre[particles.grain[i]];
  work_.walls += kinetic_energy(particles) - before;
}

template class BondedGrainsOf<2>;
template class BondedGrainsOf<3>;

}  // namespace softgrain
