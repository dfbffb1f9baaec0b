#include "softgrain/soft/lumped_bodies.hpp"

namespace softgrain {

BodyContacts::BodyContacts(std::span<const OutlineContact> contacts, const OutlineState& outline,
                           std::span<Vec<2>> velocity, std::span<const double> inverse_mass,
                           LumpedBodies& bodies)
    : velocity_(velocity), bodies_(bodies) {
  if (bodies.body.empty()) return;
  row_of_.assign(contacts.size(), -1);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const OutlineContact& contact = contacts[c];
    if (bodies.at(contact.vertex) < 0 && (contact.wall >= 0 || bodies.at(contact.master[0]) < 0)) continue;
    row_of_[c] = static_cast<int>(rows_.size());
    contact_.push_back(static_cast<int>(c));
    rows_.push_back(make_row(contact, outline, inverse_mass));
  }
}

BodyContacts::Row BodyContacts::make_row(const OutlineContact& contact, const OutlineState& outline,
                                         std::span<const double> inverse_mass) const {
  Row row{.side = {}, .normal = contact.normal, .offset = {}, .delassus = {}};
  Mat<2> C;  // in the axes of space
  contact.for_each_vertex([&](int vertex, double weight) {
    if (const int body = bodies_.at(vertex); body >= 0) {
      Side& side = row.side[row.side[0].body < 0 || row.side[0].body == body ? 0 : 1];
      side.body = body;
      side.weight += weight;
      side.arm += weight * perpendicular(outline.on_the_way(vertex) - bodies_.body[body].centre);
      return;
    }
    const auto k = static_cast<std::size_t>(row.vertices++);
    row.vertex[k] = vertex;
    row.weight[k] = weight;
    row.mobility[k] = weight * inverse_mass[vertex];
    for (int d = 0; d < 2; ++d) C(d, d) += weight * row.mobility[k];
  });
  for (const Side& side : row.side) {
    if (side.body < 0) continue;
    const LumpedBody& body = bodies_.body[side.body];
    for (int i = 0; i < 2; ++i) {
      C(i, i) += side.weight * side.weight * body.inverse_mass;
      for (int j = 0; j < 2; ++j) C(i, j) += side.arm[i] * side.arm[j] * body.inverse_inertia;
    }
  }
  const std::array<Vec<2>, 2> axis{row.normal, perpendicular(row.normal)};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) row.delassus(i, j) = dot(axis[i], C * axis[j]);
  const Vec<2> v =
      contact.wall >= 0 ? outline.walls[contact.wall].velocity : (1 / outline.dt) * contact.image_motion;
  row.offset = {contact.gap / outline.dt - dot(axis[0], velocity_of(row)), -dot(axis[1], v)};
  return row;
}

Vec<2> BodyContacts::velocity_of(const Row& row) const {
  Vec<2> u;
  for (int k = 0; k < row.vertices; ++k) u += row.weight[k] * velocity_[row.vertex[k]];
  for (const Side& side : row.side)
    if (side.body >= 0) {
      const LumpedBody& body = bodies_.body[side.body];
      u += side.weight * body.velocity + body.spin * side.arm;
    }
  return u;
}

Vec<2> BodyContacts::relative_velocity(int contact) const {
  const Row& r = row(contact);
  const Vec<2> u = velocity_of(r);
  return {dot(r.normal, u) + r.offset[0], dot(perpendicular(r.normal), u) + r.offset[1]};
}

void BodyContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const Row& r = row(contact);
  const Vec<2> P = dp[0] * r.normal + dp[1] * perpendicular(r.normal);
  for (int k = 0; k < r.vertices; ++k) velocity_[r.vertex[k]] += r.mobility[k] * P;
  for (const Side& side : r.side)
    if (side.body >= 0) {
      LumpedBody& body = bodies_.body[side.body];
      body.velocity += (side.weight * body.inverse_mass) * P;
      body.spin += body.inverse_inertia * dot(side.arm, P);
    }
}

}  // namespace softgrain
