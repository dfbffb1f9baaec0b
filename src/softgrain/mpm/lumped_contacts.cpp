#include "softgrain/mpm/lumped_contacts.hpp"

namespace softgrain {

LumpedContacts::LumpedContacts(std::span<const OutlineContact> contacts, std::span<const Wall<2>> walls,
                               std::span<Vec<2>> velocity, std::span<const double> inverse_mass, double dt)
    : contacts_(contacts), walls_(walls), velocity_(velocity), inverse_mass_(inverse_mass) {
  for (int contact = 0; contact < size(); ++contact) {
    const OutlineContact& c = contacts[contact];
    weight_.push_back(c.weights());
    double W = inverse_mass[c.vertex];
    if (c.wall < 0)
      for (std::size_t m = 0; m < 4; ++m)
        W += weight_.back()[m] * weight_.back()[m] * inverse_mass[c.master[m]];
    delassus_.push_back(W);
    offset_.push_back(c.gap / dt - dot(c.normal, velocity_between(contact)));
  }
}

Vec<2> LumpedContacts::velocity_between(int contact) const {
  const OutlineContact& c = contacts_[contact];
  Vec<2> u = velocity_[c.vertex];
  if (c.wall >= 0) {
    u -= walls_[c.wall].velocity;
  } else {
    for (std::size_t m = 0; m < 4; ++m) u -= weight_[contact][m] * velocity_[c.master[m]];
  }
  return u;
}

Vec<2> LumpedContacts::relative_velocity(int contact) const {
  const Vec<2>& n = contacts_[contact].normal;
  const Vec<2> u = velocity_between(contact);
  return {dot(n, u) + offset_[contact], dot(perpendicular(n), u)};
}

void LumpedContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const OutlineContact& c = contacts_[contact];
  const Vec<2> P = impulse_vector(c, dp);
  velocity_[c.vertex] += inverse_mass_[c.vertex] * P;
  if (c.wall >= 0) return;
  for (std::size_t m = 0; m < 4; ++m)
    velocity_[c.master[m]] -= weight_[contact][m] * inverse_mass_[c.master[m]] * P;
}

}  // namespace softgrain
