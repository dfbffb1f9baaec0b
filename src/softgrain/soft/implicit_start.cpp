#include <algorithm>
#include <cmath>

#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/implicit_step.hpp"

namespace softgrain {
namespace {

/// Share of a step, in which inertia counts, at which pairs take their normals: half-way contact would give
/// no energy at all, but packings then rattle and take twice the time (docs/decisions/0026).
constexpr double normals_of_fast_steps = 0.65;

/// kept = of_nodes, from the node `first` on.
void keep_from(std::size_t first, const WideVectors& of_nodes, WideVectors& kept) {
  kept.assign(of_nodes.begin() + static_cast<std::ptrdiff_t>(first), of_nodes.end());
}

/// The inverse.
void give_back(std::size_t first, const WideVectors& kept, WideVectors& of_nodes) {
  std::copy(kept.begin(), kept.end(), of_nodes.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

/// x at which Newton's method starts: x_n + dt v_n (+ dt^2 g in a quasi-static step) for grains in flight,
/// x_n for others, whose velocity says how far they fell into their last places, not where they go; a
/// periodic cell carries these along.
void ImplicitDynamics::start(double dt) {
  if (box.cell.any()) grains.know_all();  // it carries grains by their centres of mass
  grains.gather_outline(outline_.start);
  for (const Press& press : box.presses) box.set_speed(press, press.speed);
  walls_start_ = box.walls;
  cell_start_ = box.cell;
  damping_ = {options.damping, dt, box};
  contacts_start_ = contacts;
  impulse_start_ = impulse;
  attraction_start_ = attraction;
  set_flying(dt);
  if (impulse_time > 0) scale_to(dt / impulse_time);  // the same force
  const Vec<2, Wide> fall{dt * dt * options.gravity[0], dt * dt * options.gravity[1]};
  parallel_for(batches(), [&](int b) {
    GrainBatch& batch = grains.batches[b];
    const auto first = static_cast<std::size_t>(first_here(b));
    keep_from(first, batch.position, start_[b]);
    keep_from(first, batch.velocity, velocity_start_[b]);
    const Vec<2, Wide> carried = (1.0 - flying_[b]) * Wide(dt) * velocity_of_cell(b);
    for (std::size_t i = first; i < batch.position.size(); ++i) {
      batch.position[i] += flying_[b] * Wide(dt) * flight_velocity(b, i - first) + carried;
      if (quasi_static(dt)) batch.position[i] += flying_[b] * fall;
    }
    keep_rigid(b);
  });
  outline_.dt = dt;
  outline_.normals_at = quasi_static(dt) ? 1 : normals_of_fast_steps;
  if (impulse_time <= 0) find_first_contacts();
  hold_spins(dt);
  box.advance(dt);
  outline_.walls = box.walls;
  outline_.cell = box.cell;
}

/// No step has found contacts yet, and hold_spins asks who is near whom.
void ImplicitDynamics::find_first_contacts() {
  outline_.position = outline_.start;
  outline_.walls = box.walls;
  outline_.cell = box.cell;
  contacts = neighbours_.detect(grains, outline_);
  impulse.assign(contacts.size(), {});
  attraction.assign(adheres() ? contacts.size() : 0, 0.0);
  adhesion_energy = energy_of_adhesion(contacts);
}

void ImplicitDynamics::scale_to(double factor) {
  for (Vec<2>& p : impulse) p *= factor;
  for (double& a : attraction) a *= factor;
}

/// Those that carry contacts.
std::vector<bool> ImplicitDynamics::touching_grains() const {
  std::vector<bool> touching(grains.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!(impulse[c][0] > 0 || (adheres() && attraction[c] > 0))) continue;
    touching[grains.grain_of_vertex(contacts[c].vertex)] = true;
    if (contacts[c].wall < 0) touching[grains.grain_of_vertex(contacts[c].master[0])] = true;
  }
  return touching;
}

/// Grains that carry contacts fly no more.
void ImplicitDynamics::hold_touching() {
  const std::vector<bool> touching = touching_grains();
  for (int b = 0; b < batches(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane)
      if (touching[grains.batches[b].grain[lane]]) flying_[b].set(lane, 0);
}

/// L x_c, x_c the centres of mass of the grains of a batch: at which a periodic cell carries them.
Vec<2, Wide> ImplicitDynamics::velocity_of_cell(std::size_t b) const {
  if (!box.cell.any()) return {};
  return affine_velocity(grains, grains.batches[b], box.cell.gradient());
}

/// All grains (lanes without one stay where they are), but in a step whose inertia A does not have those that
/// carry contacts or would fly further than is trusted; in a quasi-static one those that adhere to others.
void ImplicitDynamics::set_flying(double dt) {
  flying_.assign(grains.batches.size(), 1.0);
  for (int b = 0; b < batches(); ++b)
    for (int lane = 0; lane < Wide::size; ++lane)
      if (grains.batches[b].grain[lane] < 0) flying_[b].set(lane, 0);
  if (adheres() && quasi_static(dt)) hold_touching();  // a fall would part them
  if (!slow(dt)) return;
  hold_touching();
  const auto look = [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    Wide fastest = 0.0;
    const Vec<2, Wide> of_cell = velocity_of_cell(b);
    for (const Vec<2, Wide>& of_node : batch.velocity) {
      const Vec<2, Wide> v = of_node - of_cell;
      const Wide square = dot(v, v);
      fastest = select(square <= fastest, fastest, square);
    }
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      if (!(dt * std::sqrt(fastest[lane]) < largest_correction * mean_radius_)) flying_[b].set(lane, 0);
  };
  share(look, [&](int b, Message& message) { message(flying_[b]); });
}

void ImplicitDynamics::take_back() {
  for (int b = 0; b < batches(); ++b) {
    const auto first = static_cast<std::size_t>(first_here(b));
    give_back(first, start_[b], grains.batches[b].position);
    give_back(first, velocity_start_[b], grains.batches[b].velocity);
  }
  box.walls = walls_start_;
  box.cell = cell_start_;
  contacts = contacts_start_;
  impulse = impulse_start_;
  attraction = attraction_start_;
}

}  // namespace softgrain
