#include <numbers>

#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/equilibrium.hpp"
#include "softgrain/soft/implicit_step.hpp"

// What Newton's method solves: the matrix of the grains, and what is left of their equations.

namespace softgrain {

/// A = M/t^2 + K(x) + c p/l on the outline; its Cholesky factor and the compliance of the outlines.
ImplicitDynamics::Failure ImplicitDynamics::factor(double dt, double proximal, SoftStepReport& report) {
  proximal_.assign(grains.outline_size(), {});
  if (!contacts.empty()) {
    const std::vector<Vec<2>> force = contact_forces(grains, contacts, felt(), dt);
    for (int v = 0; v < grains.outline_size(); ++v) {
      const int g = grains.grain_of_vertex(v);
      const double length =
          2 * std::numbers::pi * grains.radius(g) / (grains.outline_end(g) - grains.outline_begin(g));
      proximal_[v] = (proximal * norm(force[v]) / length) * Vec<2>{1, 1};
    }
  }
  report.factorisations += batches();
  const double t = step_of_matrix(dt);
  const Precision precision =
      t <= options.single_precision_steps * explicit_step_ ? Precision::single : Precision::full;
  std::vector<int> failed(batches(), -1);
  const auto factor_batch = [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    if (batch.topology->rigid()) return;  // see solve_rigid
    BatchedCholesky& A = matrix_[b];
    A.clear(precision);
    add_stiffness(grains, batch, A, dt);
    WideVectors diagonal(batch.position.size());
    grains.scatter_outline(proximal_, batch, diagonal);
    for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
      const Wide entry = grains.node_mass(batch, i) * Wide(1 / (t * t)) + diagonal[i][0];
      A.add(i, i, {entry, 0.0, 0.0, entry});
    }
    failed[b] = batch.grain_in(A.factor());
    if (failed[b] >= 0) return;
    compliance_[b].resize(compliance_size(batch));
    A.kept_inverse(compliance_[b]);
    hold_in_compliance(b);
  };
  share(factor_batch, [&](int b, Message& message) {
    message(failed[b]);
    if (shares_contacts() || grains.batches[b].topology->rigid()) return;
    compliance_[b].resize(compliance_size(grains.batches[b]));
    message(compliance_[b]);
  });
  return none_failed(failed) ? Failure::none : Failure::indefinite_matrix;
}

/// r of a batch, and A^-1 r on its outlines. The first grain that has a point turned inside out, or -1.
int ImplicitDynamics::solve_elastic(int b, double dt) {
  const GrainBatch& batch = grains.batches[b];
  if (const int inverted = batch.grain_in(internal_force(grains, batch, force_[b], dt)); inverted >= 0)
    return inverted;
  WideVectors& r = force_[b];
  for (int i = 0; i < batch.topology->grid.nodes(); ++i) {
    const Wide m = grains.node_mass(batch, i), rate = m * Wide(1 / (dt * dt));
    const Vec<2, Wide> flight = flight_velocity(b, i);
    for (int d = 0; d < 2; ++d) {
      const Wide inertia = rate * (batch.position[i][d] - start_[b][i][d] - Wide(dt) * flight[d]);
      r[i][d] = m * Wide(options.gravity[d]) - r[i][d] - inertia;
    }
  }
  half_solved_[b].resize(r.size());
  matrix_[b].begin_solve(numbers(r), numbers(half_solved_[b]), numbers(kept_[b]));
  hold_increment(b);
  return -1;
}

/// r = f_ext - f_int - M (x - x_n - dt v_n)/dt^2, and A^-1 r on the outlines.
ImplicitDynamics::Failure ImplicitDynamics::residual(double dt) {
  outline_increment_.assign(grains.outline_size(), {});
  std::vector<int> failed(batches(), -1);
  share(
      [&](int b) {
        const GrainBatch& batch = grains.batches[b];
        kept_[b].resize(batch.topology->grid.outline_nodes());
        if (!batch.topology->rigid()) failed[b] = solve_elastic(b, dt);
      },
      [&](int b, Message& message) {
        kept_[b].resize(grains.batches[b].topology->grid.outline_nodes());
        message(failed[b]), message(kept_[b]);
      });
  parallel_for(batches(), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    if (batch.topology->rigid()) solve_rigid(b, dt);
    if (failed[b] >= 0) return;
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      for (int v = 0; v < batch.topology->grid.outline_nodes(); ++v)
        outline_increment_[grains.outline_begin(batch.grain[lane]) + v] = {kept_[b][v][0][lane],
                                                                           kept_[b][v][1][lane]};
  });
  return none_failed(failed) ? Failure::none : Failure::inverted_point;
}

/// Remembers the first grain >= 0 as the one that failed.
bool ImplicitDynamics::none_failed(std::span<const int> grain_of_batch) {
  failed_grain_ = -1;
  for (const int grain : grain_of_batch)
    if (failed_grain_ < 0) failed_grain_ = grain;
  return failed_grain_ < 0;
}

}  // namespace softgrain
