#include "softgrain/soft/lumped_bodies.hpp"

#include "softgrain/contact/tangents.hpp"

namespace softgrain {
namespace {

// What a lever does: e_z x r in the plane, r in space.

Vec<2> speed_of(double spin, const Vec<2>& arm) { return spin * arm; }
Vec<3> speed_of(const Vec<3>& spin, const Vec<3>& arm) { return cross(spin, arm); }

double moment_of(const Vec<2>& arm, const Vec<2>& P) { return dot(arm, P); }
Vec<3> moment_of(const Vec<3>& arm, const Vec<3>& P) { return cross(arm, P); }

/// (r x)^T (r x)
double answer(const Vec<2>& arm, int i, int j) { return arm[i] * arm[j]; }
double answer(const Vec<3>& arm, int i, int j) { return (i == j ? dot(arm, arm) : 0) - arm[i] * arm[j]; }

/// (r x)^T I^-1 (r x)
Mat<3> answer(const Vec<3>& arm, const Mat<3>& inverse_inertia) {
  Mat<3> r;
  r(2, 1) = arm[0], r(1, 2) = -arm[0];
  r(0, 2) = arm[1], r(2, 0) = -arm[1];
  r(1, 0) = arm[2], r(0, 1) = -arm[2];
  return transpose(r) * (inverse_inertia * r);
}

void add_spin(LumpedBodyOf<2>& body, const Vec<2>& arm, const Vec<2>& P) {
  body.spin += body.inverse_inertia * moment_of(arm, P);
}
void add_spin(LumpedBodyOf<3>& body, const Vec<3>& arm, const Vec<3>& P) {
  const Vec<3> moment = moment_of(arm, P);
  if (body.radius > 0)
    body.spin += body.inverse_inertia * moment;
  else
    body.spin += body.inverse_tensor * moment;
}

}  // namespace

template <int Dim>
BodyContacts<Dim>::BodyContacts(std::span<const ContactOf<Dim>> contacts, const OutlineStateOf<Dim>& outline,
                                std::span<ScatteredVec<Dim>> velocity, std::span<const double> inverse_mass,
                                LumpedBodiesOf<Dim>& bodies)
    : velocity_(velocity), bodies_(bodies) {
  if (bodies.body.empty()) return;
  row_of_.assign(contacts.size(), -1);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactOf<Dim>& contact = contacts[c];
    if (bodies.at(contact.vertex) < 0 && (contact.wall >= 0 || bodies.at(contact.facing_vertex()) < 0))
      continue;
    row_of_[c] = static_cast<int>(rows_.size());
    contact_.push_back(static_cast<int>(c));
    rows_.push_back(make_row(contact, outline, inverse_mass));
  }
}

template <int Dim>
typename BodyContacts<Dim>::Row BodyContacts<Dim>::make_row(const ContactOf<Dim>& contact,
                                                            const OutlineStateOf<Dim>& outline,
                                                            std::span<const double> inverse_mass) const {
  Row row{.side = {}, .normal = contact.normal, .offset = {}, .delassus = {}};
  Mat<Dim> C;  // in the axes of space
  contact.for_each_vertex([&](int vertex, double weight) {
    if (const int body = bodies_.at(vertex); body >= 0) {
      Side& side = row.side[row.side[0].body < 0 || row.side[0].body == body ? 0 : 1];
      side.body = body;
      side.weight += weight;
      if constexpr (Dim == 2)
        side.arm += weight * perpendicular(outline.on_the_way(vertex) - bodies_.body[body].centre);
      else if (bodies_.body[body].radius > 0)
        side.arm = -bodies_.body[body].radius * contact.normal;
      else
        side.arm += weight * (outline.on_the_way(vertex) - bodies_.body[body].centre);
      return;
    }
    const auto k = static_cast<std::size_t>(row.vertices++);
    row.vertex[k] = vertex;
    row.weight[k] = weight;
    row.mobility[k] = weight * inverse_mass[vertex];
    for (int d = 0; d < Dim; ++d) C(d, d) += weight * row.mobility[k];
  });
  for (const Side& side : row.side) {
    if (side.body < 0) continue;
    const LumpedBodyOf<Dim>& body = bodies_.body[side.body];
    for (int i = 0; i < Dim; ++i) C(i, i) += side.weight * side.weight * body.inverse_mass;
    if constexpr (Dim == 3)
      if (body.radius == 0) {
        C += answer(side.arm, body.inverse_tensor);
        continue;
      }
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) C(i, j) += answer(side.arm, i, j) * body.inverse_inertia;
  }
  std::array<Vec<Dim>, Dim> axis{row.normal};
  for (std::size_t k = 1; k < Dim; ++k) axis[k] = tangents(row.normal)[k - 1];
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      row.delassus(i, j) = dot(axis[static_cast<std::size_t>(i)], C * axis[static_cast<std::size_t>(j)]);
  const Vec<Dim> v =
      contact.wall >= 0 ? outline.walls[contact.wall].velocity : (1 / outline.dt) * contact.image_motion;
  for (int k = 1; k < Dim; ++k) row.offset[k] = -dot(axis[static_cast<std::size_t>(k)], v);
  const double gap = Dim == 2 ? contact.gap : gap_now(contact, outline);
  row.offset[0] = gap / outline.dt - dot(axis[0], velocity_of(row));
  return row;
}

template <int Dim>
Vec<Dim> BodyContacts<Dim>::velocity_of(const Row& row) const {
  Vec<Dim> u;
  for (std::size_t k = 0; k < static_cast<std::size_t>(row.vertices); ++k)
    u += row.weight[k] * velocity_[row.vertex[k]];
  for (const Side& side : row.side)
    if (side.body >= 0) {
      const LumpedBodyOf<Dim>& body = bodies_.body[side.body];
      u += side.weight * body.velocity + speed_of(body.spin, side.arm);
    }
  return u;
}

template <int Dim>
Vec<Dim> BodyContacts<Dim>::relative_velocity(int contact) const {
  const Row& r = row(contact);
  return to_local(r.normal, velocity_of(r)) + r.offset;
}

template <int Dim>
void BodyContacts<Dim>::apply_impulse(int contact, const Vec<Dim>& dp) {
  const Row& r = row(contact);
  const Vec<Dim> P = from_local(r.normal, dp);
  for (std::size_t k = 0; k < static_cast<std::size_t>(r.vertices); ++k)
    velocity_[r.vertex[k]] += r.mobility[k] * P;
  for (const Side& side : r.side)
    if (side.body >= 0) {
      LumpedBodyOf<Dim>& body = bodies_.body[side.body];
      body.velocity += (side.weight * body.inverse_mass) * P;
      add_spin(body, side.arm, P);
    }
}

template class BodyContacts<2>;
template class BodyContacts<3>;

}  // namespace softgrain
