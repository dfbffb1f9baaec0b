#include "softgrain/mixed/primary_contacts.hpp"

#include "softgrain/contact/tangents.hpp"

namespace softgrain {

PrimaryContactSystem::PrimaryContactSystem(std::span<const PrimaryContact> contacts,
                                           const OutlineState& outline, std::span<Vec<2>> outline_velocity,
                                           std::span<const double> inverse_mass, RigidParticles<2>& primaries,
                                           double push_out)
    : velocity_(outline_velocity), primaries_(primaries) {
  rows_.reserve(contacts.size());
  for (const PrimaryContact& contact : contacts) {
    Row row;
    row.primary = contact.primary;
    row.normal = contact.normal;
    double mobility = 0;  // M
    contact.for_each_vertex([&](int v, double weight) {
      const auto k = static_cast<std::size_t>(row.vertices++);
      row.vertex[k] = v;
      row.weight[k] = weight;
      row.mobility[k] = weight * inverse_mass[v];
      mobility += weight * row.mobility[k];
      row.outline_start += (weight / outline.dt) * (outline.position[v] - outline.start[v]);
    });
    const double of_primary = primaries.inverse_mass[contact.primary];
    row.delassus = {mobility + of_primary, mobility + (1 + primaries.inertia_ratio) * of_primary};
    row.primary_start = primary_velocity(row);
    row.image = (1 / outline.dt) * contact.image_motion;
    const Vec<2> u_found = row.outline_start + row.image - row.primary_start;
    const double now = contact.gap / outline.dt - dot(row.normal, u_found);
    row.offset = now > 0 ? now : push_out * now;
    rows_.push_back(row);
  }
}

Vec<2> PrimaryContactSystem::outline_velocity(const Row& row) const {
  Vec<2> v;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.vertices); ++k)
    v += row.weight[k] * velocity_[row.vertex[k]];
  return v;
}

Vec<2> PrimaryContactSystem::primary_velocity(const Row& row) const {
  return primaries_.velocity[row.primary] + primaries_.spin[row.primary][0] * perpendicular(row.normal);
}

Vec<2> PrimaryContactSystem::relative_velocity(int contact) const {
  const Row& row = rows_[contact];
  Vec<2> u = to_local(row.normal, outline_velocity(row) + row.image - primary_velocity(row));
  u[0] += row.offset;
  return u;
}

void PrimaryContactSystem::apply_impulse(int contact, const Vec<2>& dp) {
  const Row& row = rows_[contact];
  const Vec<2> P = from_local(row.normal, dp);
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.vertices); ++k)
    velocity_[row.vertex[k]] += row.mobility[k] * P;
  const double of_primary = primaries_.inverse_mass[row.primary];
  primaries_.velocity[row.primary] -= of_primary * P;
  primaries_.spin[row.primary][0] -= primaries_.inertia_ratio * of_primary * dp[1];
}

void PrimaryContactSystem::apply_impulses(std::span<const Vec<2>> impulse) {
  for (int c = 0; c < size(); ++c)
    if (!(impulse[c] == Vec<2>{})) apply_impulse(c, impulse[c]);
}

PrimaryWork PrimaryContactSystem::work(std::span<const Vec<2>> impulse) const {
  PrimaryWork work;
  for (int c = 0; c < size(); ++c) {
    if (impulse[c] == Vec<2>{}) continue;
    const Row& row = rows_[c];
    const Vec<2> P = from_local(row.normal, impulse[c]);
    const Vec<2> of_outline = 0.5 * (row.outline_start + outline_velocity(row)),
                 of_primary = 0.5 * (row.primary_start + primary_velocity(row));
    work.on_outlines += dot(P, of_outline);
    work.on_primaries -= dot(P, of_primary);
    work.by_cell -= dot(P, row.image);
    work.friction -= impulse[c][1] * dot(perpendicular(row.normal), of_outline + row.image - of_primary);
  }
  return work;
}

}  // namespace softgrain
