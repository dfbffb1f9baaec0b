#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/wall_couple.hpp"

namespace softgrain {
namespace {

Wide dot(std::span<const Vec<2, Wide>> a, std::span<const Vec<2, Wide>> b) {
  Wide sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += softgrain::dot(a[i], b[i]);
  return sum;
}

}  // namespace

/// Which grains keep their spin in this step, as frictionless walls alone touch them, and its direction
///   q_i = m_i e_z x (x_i - x_c) at x_n:  q . (x - x_n) = dt q . v_n
/// then is L = L_n. A couple -c q holds them to it (docs/decisions/0034).
void ImplicitDynamics::hold_spins(double dt) {
  held_.assign(grains.batches.size(), {});
  const std::vector<Wide> alone = grains_on_smooth_walls_alone(grains, contacts, friction_by_kind());
  own_for(grains.shares, batches(), [&](int b) {
    HeldSpin& held = held_[b];
    if (!any(alone[b] > 0.0)) return;
    const GrainBatch& batch = grains.batches[b];
    const Vec<2, Wide> centre = centre_of_mass(grains, batch, start_[b]);
    held.direction.resize(start_[b].size());
    for (std::size_t i = 0; i < start_[b].size(); ++i) {
      const Wide m = alone[b] * grains.node_mass(batch, static_cast<int>(i));
      const Vec<2, Wide> x = start_[b][i] - centre;
      held.direction[i] = {-m * x[1], m * x[0]};
      held.wanted += Wide(dt) * softgrain::dot(held.direction[i], flight_velocity(b, i));
    }
    held.lanes = alone[b];
  });
}

/// u = A^-1 q; A^-1 - u u^T/(q . u) is the compliance of grains that keep their spin.
void ImplicitDynamics::hold_in_compliance(std::size_t b) {
  HeldSpin& held = held_[b];
  if (held.direction.empty()) return;
  held.response = held.direction;
  matrix_[b].solve(numbers(held.response));
  const Wide along = dot(held.direction, held.response);
  held.inverse = select(held.lanes > 0.0, 1.0 / select(held.lanes > 0.0, along, Wide(1)), Wide(0));
  const ReferenceGrid& grid = grains.batches[b].topology->grid;
  const std::size_t width = 2 * static_cast<std::size_t>(grid.outline_nodes());
  const Wide* u = &held.response[grid.outline_begin][0];
  for (int lane = 0; lane < Wide::size; ++lane) {
    if (held.lanes[lane] == 0) continue;
    double* compliance = compliance_[b].data() + lane * width * width;
    for (std::size_t i = 0; i < width; ++i) {
      const double factor = held.inverse[lane] * u[i][lane];
      for (std::size_t j = 0; j < width; ++j) compliance[i * width + j] -= factor * u[j][lane];
    }
  }
}

/// The outline's part of A^-1 r, without the turn that it would bring.
void ImplicitDynamics::hold_increment(std::size_t b) {
  HeldSpin& held = held_[b];
  if (held.direction.empty()) return;
  const GrainBatch& batch = grains.batches[b];
  Wide left = held.wanted;
  for (std::size_t i = 0; i < batch.position.size(); ++i)
    left -= softgrain::dot(held.direction[i], batch.position[i] - start_[b][i]);
  held.left = left;
  const Wide couple = held.inverse * (dot(held.response, force_[b]) - left);
  const int begin = batch.topology->grid.outline_begin;
  for (std::size_t k = 0; k < kept_[b].size(); ++k) kept_[b][k] -= couple * held.response[begin + k];
}

/// The same of a correction; what is left of the couple once corrections vanish is what balances the walls'.
void ImplicitDynamics::hold_correction(std::size_t b) {
  HeldSpin& held = held_[b];
  if (held.direction.empty()) return;
  held.couple = held.inverse * (dot(held.direction, force_[b]) - held.left);
  for (std::size_t i = 0; i < force_[b].size(); ++i) force_[b][i] -= held.couple * held.response[i];
}

}  // namespace softgrain
