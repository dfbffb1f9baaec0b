#include "softgrain/rigid/narrow_sweeps.hpp"

namespace softgrain {

NarrowSweeps::System::System(NarrowSweeps& sweeps, const RigidParticles<2>& particles,
                             const RigidContacts<2>& contacts, std::span<const double> offset)
    : sweeps_(sweeps), contacts_(contacts), offset_(offset), inertia_ratio_(particles.inertia_ratio) {}

Mat<2> NarrowSweeps::System::delassus_block(int contact) const {
  const double W_nn = contacts_.inverse_mass_a[contact] + contacts_.inverse_mass_b[contact];
  return Mat<2>::diagonal({W_nn, (1 + inertia_ratio_) * W_nn});
}

Vec<2> NarrowSweeps::System::relative_velocity(int contact) const {
  const int a = contacts_.body_a[contact], b = contacts_.body_b[contact];
  const Velocity &v_a = sweeps_.velocity_[a], &v_b = sweeps_.velocity_[b];
  const Vec<2> along = Vec<2>{static_cast<double>(v_b.x) - v_a.x, static_cast<double>(v_b.y) - v_a.y} +
                       contacts_.image_velocity(contact);
  const Vec<2>& n = contacts_.normal[contact];
  return {dot(n, along) + offset_[contact],
          dot(perpendicular(n), along) - (static_cast<double>(sweeps_.spin_[a]) + sweeps_.spin_[b])};
}

void NarrowSweeps::System::apply_impulse(int contact, const Vec<2>& dp) {
  const Vec<2>& n = contacts_.normal[contact];
  const Vec<2> P = dp[0] * n + dp[1] * perpendicular(n);
  const auto give = [&](int body, double inverse_mass, double sign) {
    Velocity& v = sweeps_.velocity_[body];
    v.x += static_cast<float>(sign * inverse_mass * P[0]);
    v.y += static_cast<float>(sign * inverse_mass * P[1]);
    sweeps_.spin_[body] -= static_cast<float>(inertia_ratio_ * inverse_mass * dp[1]);
  };
  give(contacts_.body_a[contact], contacts_.inverse_mass_a[contact], -1);
  give(contacts_.body_b[contact], contacts_.inverse_mass_b[contact], 1);
}

}  // namespace softgrain
