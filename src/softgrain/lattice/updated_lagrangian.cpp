#include "softgrain/lattice/updated_lagrangian.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/lattice/with_elastic.hpp"

namespace softgrain {
namespace {

/// Smallest mass of a node that has a share in the outline, or in contacts on nodes, over that of a full
/// cell. With lighter nodes a vertex would throw the points beside them about.
constexpr double least_outline_share = 1e-3, least_node_share = 1e-5;

}  // namespace

UpdatedLagrangianDynamics::UpdatedLagrangianDynamics(std::vector<PointGrain> point_grains,
                                                     Box<2> box_of_grains, AnyLaw material,
                                                     double mass_density,
                                                     const UpdatedLagrangianOptions& lagrangian_options)
    : grains(std::move(point_grains)),
      box(std::move(box_of_grains)),
      law(material),
      density(mass_density),
      options(lagrangian_options),
      lattice_(options.shape, options.cell) {
  require(!grains.empty(), "there is no grain");
  with_elastic(law, [](const auto&) {});
  require(density > 0, "the density must be > 0, got {} kg/m^3", density);
  require(options.cell > 0, "the cell must be > 0, got {} m", options.cell);
  require(options.pic_share >= 0 && options.pic_share <= 1, "pic_share must be in [0, 1], got {}",
          options.pic_share);
  require(options.damping >= 0, "damping must be >= 0, got {} 1/s", options.damping);
  require(options.friction >= 0 && options.wall_friction >= 0, "friction must be >= 0, got {} and {}",
          options.friction, options.wall_friction);
  if (options.wall_reach < 0) options.wall_reach = support(options.shape) - point_side / 2;
  smallest_radius_ = grains.front().radius;
  for (const PointGrain& grain : grains) {
    mean_radius_ += grain.radius / static_cast<double>(grains.size());
    smallest_radius_ = std::min(smallest_radius_, grain.radius);
  }
  stencil_.resize(grains.size());
}

SoftStepReport UpdatedLagrangianDynamics::step(double dt) {
  check_wall_motion(box, dt, smallest_radius_);
  return options.implicit ? implicit_step(dt) : explicit_step(dt);
}

SoftStepReport UpdatedLagrangianDynamics::explicit_step(double dt) {
  damping_ = {options.damping, dt, box};
  box.advance(dt);
  work.internal += kinetic_energy_of_points();
  find_stencils();
  gather_momentum();  // m_i v_i = sum_p N_i m_p v_p
  start_velocity_ = lattice_.velocity;
  kick_nodes(dt);  // v_i += dt (g + f_i / m_i)
  kicked_velocity_ = lattice_.velocity;
  work.internal -= kinetic_energy_of_nodes();

  LatticeContacts system(lattice_);
  find_outline_weights();
  find_contacts(system, dt);
  const std::vector<double> friction = friction_of(system.contacts());
  impulse.assign(system.size(), {});
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  const SolverReport solved = solve_nlgs<2>(system, std::span(impulse), friction, solver);
  contacts.assign(system.contacts().begin(), system.contacts().end());
  impulse_time = dt;
  add_contact_work(system);

  work.internal += kinetic_energy_of_nodes();
  move_points(dt, options.pic_share);
  move_outlines(dt);
  work.internal -= kinetic_energy_of_points();
  gather_momentum();
  strain_points(dt);  // F_p <- (1 + dt L_p) F_p
  return report_of(solved);
}

/// The points' nodes, and the nodes' masses and mass gradients.
void UpdatedLagrangianDynamics::find_stencils() {
  lattice_.reset(grains);
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    stencil_[g].clear();
    for (int p = 0; p < grains[g].points(); ++p) {
      const double m = density * grains[g].volume[p];
      stencil_[g].emplace_back(options.shape, grains[g].position[p], options.cell);
      stencil_[g][p].for_each_node([&](int column, int row, double N, const Vec<2>& dN) {
        const int i = lattice_.node(g, column, row);
        lattice_.mass[i] += N * m;
        lattice_.inward[i] -= m * dN;
      });
    }
  }
}

/// From the points as they are now, with the nodes of the step.
void UpdatedLagrangianDynamics::gather_momentum() {
  lattice_.velocity.assign(lattice_.nodes(), {});
  for (int g = 0; g < static_cast<int>(grains.size()); ++g)
    for (int p = 0; p < grains[g].points(); ++p) {
      const Vec<2> momentum = density * grains[g].volume[p] * grains[g].velocity[p];
      stencil_[g][p].for_each_node([&](int column, int row, double N, const Vec<2>&) {
        lattice_.velocity[lattice_.node(g, column, row)] += N * momentum;
      });
    }
  for (int i = 0; i < lattice_.nodes(); ++i)
    if (lattice_.mass[i] > 0) lattice_.velocity[i] *= 1 / lattice_.mass[i];
}

void UpdatedLagrangianDynamics::strain_points(double dt) {
  for (int g = 0; g < static_cast<int>(grains.size()); ++g)
    for (int p = 0; p < grains[g].points(); ++p) {
      Mat<2> L;  // sum_i v_i (x) dN_i/dx
      stencil_[g][p].for_each_node([&](int column, int row, double, const Vec<2>& dN) {
        const Vec<2>& v_i = lattice_.velocity[lattice_.node(g, column, row)];
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b) L(a, b) += v_i[a] * dN[b];
      });
      grains[g].F[p] += dt * (L * grains[g].F[p]);
    }
}

/// v_i += dt f_i/m_i, f_i = - sum_p V_p P F^T dN_i/dx, with V_p at rest: P F^T is Kirchhoff's stress; and
/// what gravity and damping give.
void UpdatedLagrangianDynamics::kick_nodes(double dt) {
  impulse_on_node_.assign(lattice_.nodes(), {});
  with_elastic(law, [&](const auto& material) { add_internal_impulse(material, dt); });
  for (int g = 0; g < static_cast<int>(grains.size()); ++g)
    lattice_.for_each_node(g, [&](int i, const Vec<2>& x) {
      const double m = lattice_.mass[i];
      if (!(m > 0)) return;
      const Vec<2> damped = damping_.velocity_change(x, lattice_.velocity[i]);
      const Vec<2> dv = (1 / m) * impulse_on_node_[i] + dt * options.gravity + damped;
      const Vec<2> mean = lattice_.velocity[i] + 0.5 * dv;
      const double by_gravity = m * dt * dot(options.gravity, mean), by_damping = m * dot(damped, mean);
      work.gravity += by_gravity;
      work.damping -= by_damping;
      work.internal += by_gravity + by_damping;
      lattice_.velocity[i] += dv;
    });
}

template <class Law>
void UpdatedLagrangianDynamics::add_internal_impulse(const Law& material, double dt) {
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    const PointGrain& grain = grains[g];
    for (int p = 0; p < grain.points(); ++p) {
      if (!admissible(grain.F[p]))
        throw NumericalError(
            fmt::format("a material point of grain {} is turned inside out; use a smaller time step", g));
      const Mat<2> impulse_tensor =
          (dt * grain.volume[p]) * (material.stress(grain.F[p]) * transpose(grain.F[p]));
      stencil_[g][p].for_each_node([&](int column, int row, double, const Vec<2>& dN) {
        impulse_on_node_[lattice_.node(g, column, row)] -= impulse_tensor * dN;
      });
    }
  }
}

double UpdatedLagrangianDynamics::kinetic_energy_of_nodes() const {
  double sum = 0;
  for (int i = 0; i < lattice_.nodes(); ++i)
    sum += 0.5 * lattice_.mass[i] * dot(lattice_.velocity[i], lattice_.velocity[i]);
  return sum;
}

double UpdatedLagrangianDynamics::kinetic_energy_of_points() const {
  double sum = 0;
  for (const PointGrain& grain : grains) sum += grain.kinetic_energy(density);
  return sum;
}

/// The contacts give P . (sum_i w_i (v_i + v_i+)/2) of kinetic energy to the nodes, v_i after the kick. Of
/// that P . (sum_i w_i (v_i - v_i-)/2), v_i- before it, is what the kick gave and contact takes back at once
/// where nothing moves: it belongs to the internal work.
void UpdatedLagrangianDynamics::add_contact_work(const LatticeContacts& system) {
  std::vector<Vec<2>> mean(lattice_.velocity.size()), kick(lattice_.velocity.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean[i] = 0.5 * (start_velocity_[i] + lattice_.velocity[i]);
    kick[i] = 0.5 * (kicked_velocity_[i] - start_velocity_[i]);
  }
  for (int c = 0; c < system.size(); ++c) {
    const LatticeContact& contact = contacts[c];
    const Vec<2> t = perpendicular(contact.normal), P = impulse[c][0] * contact.normal + impulse[c][1] * t;
    const Vec<2> u = system.combined(c, mean) - contact.wall_velocity;
    work.walls += dot(P, contact.wall_velocity);
    work.contacts -= dot(P, u);
    work.friction -= impulse[c][1] * dot(t, u);
    work.internal -= dot(P, system.combined(c, kick));
  }
}

void UpdatedLagrangianDynamics::find_outline_weights() {
  const double full_cell = density * options.cell * options.cell;
  outline_.first_vertex.assign(1, 0);
  outline_.weights.clear();
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    for (const Vec<2>& x : grains[g].outline) {
      lattice_.vertex_weights(g, x, least_outline_share * full_cell, outline_.weights.emplace_back());
      if (outline_.weights.back().empty())
        throw NumericalError(
            fmt::format("the outline of grain {} has left its material points; use a smaller time step", g));
    }
    outline_.first_vertex.push_back(static_cast<int>(outline_.weights.size()));
  }
}

void UpdatedLagrangianDynamics::find_contacts(LatticeContacts& system, double dt) const {
  const double full_cell = density * options.cell * options.cell;
  if (options.contact_on == ContactOn::outline)
    add_outline_contacts(grains, lattice_, outline_, box.walls, dt, system);
  else
    add_node_contacts(lattice_, static_cast<int>(grains.size()), box.walls, least_node_share * full_cell,
                      options.wall_reach * options.cell, system);
}

/// v_p += sum_i N_i (v_i+ - v_i-);  x_p += dt sum_i N_i v_i+.
void UpdatedLagrangianDynamics::move_points(double dt, double pic_share) {
  for (int g = 0; g < static_cast<int>(grains.size()); ++g) {
    PointGrain& grain = grains[g];
    double squares = 0;  // of velocities
    for (int p = 0; p < grain.points(); ++p) {
      Vec<2> v, dv;
      stencil_[g][p].for_each_node([&](int column, int row, double N, const Vec<2>&) {
        if (!(N > 0)) return;
        const int i = lattice_.node(g, column, row);
        v += N * lattice_.velocity[i];
        dv += N * (lattice_.velocity[i] - start_velocity_[i]);
      });
      grain.velocity[p] = (1 - pic_share) * (grain.velocity[p] + dv) + pic_share * v;
      grain.position[p] += dt * v;
      squares += dot(v, v);
    }
    if (!std::isfinite(squares))
      throw NumericalError(fmt::format("a velocity of grain {} is not finite; use a smaller time step", g));
  }
}

void UpdatedLagrangianDynamics::move_outlines(double dt) {
  for (std::size_t g = 0; g < grains.size(); ++g)
    for (std::size_t v = 0; v < grains[g].outline.size(); ++v)
      grains[g].outline[v] += dt * velocity_of(lattice_, outline_.weights[outline_.first_vertex[g] + v]);
}

SoftStepReport UpdatedLagrangianDynamics::report_of(const SolverReport& solved) {
  SoftStepReport report{.iterations = 1,
                        .sweeps = solved.sweeps,
                        .residual = solved.residual_max,
                        .residual_mean = solved.residual_mean,
                        .converged = solved.converged};
  box.impulse.assign(box.walls.size(), {});
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const LatticeContact& contact = contacts[c];
    if (!(impulse[c][0] > 0)) continue;
    ++report.contacts;
    if (contact.wall < 0) continue;
    box.impulse[contact.wall] -=
        impulse[c][0] * contact.normal + impulse[c][1] * perpendicular(contact.normal);
    if (contact.vertex >= 0) {
      const Vec<2>& x = grains[contact.grain].outline[contact.vertex];
      const double depth = std::max(0.0, -dot(x - box.walls[contact.wall].point, contact.normal));
      report.overlap_max = std::max(report.overlap_max, depth / smallest_radius_);
      report.overlap_mean += depth / smallest_radius_;
    }
  }
  if (report.contacts > 0) report.overlap_mean /= report.contacts;
  return report;
}

double UpdatedLagrangianDynamics::elastic_energy() const {
  double sum = 0;
  with_elastic(law, [&](const auto& material) {
    for (const PointGrain& grain : grains)
      for (int p = 0; p < grain.points(); ++p) sum += grain.volume[p] * material.energy(grain.F[p]);
  });
  return sum;
}

Mat<2> UpdatedLagrangianDynamics::stress(int grain, int point) const {
  const Mat<2>& F = grains[grain].F[point];
  const Mat<2> P = with_elastic(law, [&](const auto& material) { return material.stress(F); });
  return (1 / determinant(F)) * (P * transpose(F));
}

double stable_time_step(const AnyLaw& law, double density, double cell, double safety) {
  return safety * cell / wave_speed(law, density);
}

}  // namespace softgrain
