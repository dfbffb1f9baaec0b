#include "softgrain/rigid/neighbours.hpp"

#include <algorithm>
#include <numeric>

#include "softgrain/contact/coloring.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/geometry/cell_grid.hpp"

namespace softgrain {
namespace {

struct BodyPair {
  int a, b;
  auto operator<=>(const BodyPair&) const = default;
};

/// Pairs with gap < skin at the reference positions, sorted by (a, b).
template <int Dim>
std::vector<BodyPair> close_pairs(const RigidParticles<Dim>& particles,
                                  const NeighbourReference<Dim>& reference) {
  const auto& x = reference.position;
  const auto& radius = particles.radius;
  std::vector<BodyPair> pairs;
  if (x.empty()) return pairs;
  const double reach = 2 * *std::max_element(radius.begin(), radius.end()) + reference.skin;
  const CellGrid<Dim> grid(x, reach);
  grid.for_each_close_pair([&](int i, int j) {
    const Vec<Dim> d = x[j] - x[i];
    const double touch = radius[i] + radius[j] + reference.skin;
    if (dot(d, d) < touch * touch) pairs.push_back({i, j});
  });
  for (std::size_t w = 0; w < particles.walls.size(); ++w) {
    for (int i = 0; i < particles.size(); ++i) {
      const double height = dot(x[i] - reference.wall_point[w], particles.walls[w].normal);
      if (height < radius[i] + reference.skin) pairs.push_back({i, particles.wall_body(static_cast<int>(w))});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// The contacts of `pairs`, ordered frictionless first, then by colour, then by (a, b), with their batches.
template <int Dim>
RigidContacts<Dim> coloured_contacts(const std::vector<BodyPair>& pairs, const RigidParticles<Dim>& particles,
                                     const FrictionRule& rule) {
  const std::size_t m = pairs.size();
  std::vector<int> a(m), b(m), order(m);
  std::vector<double> mu(m);
  for (std::size_t c = 0; c < m; ++c)
    a[c] = pairs[c].a, b[c] = pairs[c].b, mu[c] = rule(pairs[c].a, pairs[c].b);
  const std::vector<int> color = color_contacts(a, b, particles.size());
  std::iota(order.begin(), order.end(), 0);
  const auto batch_of = [&](int c) { return color[c] + (mu[c] > 0 ? 64 : 0); };
  std::stable_sort(order.begin(), order.end(), [&](int c, int d) { return batch_of(c) < batch_of(d); });

  RigidContacts<Dim> contacts;
  for (const int c : order) {
    const int index = contacts.size();
    if (index == 0 || batch_of(c) != batch_of(order[index - 1]))
      contacts.batches.push_back({.begin = index, .end = index, .frictional = mu[c] > 0});
    ++contacts.batches.back().end;
    const double inverse_a = particles.inverse_mass[a[c]], inverse_b = particles.inverse_mass[b[c]];
    contacts.body_a.push_back(a[c]);
    contacts.body_b.push_back(b[c]);
    contacts.inverse_mass_a.push_back(inverse_a);
    contacts.inverse_mass_b.push_back(inverse_b);
    contacts.inverse_delassus.push_back(1 / (inverse_a + inverse_b));
    contacts.friction.push_back(mu[c]);
  }
  contacts.normal.resize(m);
  contacts.gap.resize(m);
  contacts.impulse.resize(m);
  return contacts;
}

/// Warm start: the impulse of each old contact that carries one goes to the new contact of the same two
/// bodies.
template <int Dim>
void carry_impulses(const RigidContacts<Dim>& old, RigidContacts<Dim>& contacts) {
  std::vector<std::pair<BodyPair, int>> carrying;
  for (int c = 0; c < old.size(); ++c)
    if (old.impulse[c][0] > 0) carrying.push_back({{old.body_a[c], old.body_b[c]}, c});
  std::sort(carrying.begin(), carrying.end());
  for (int c = 0; c < contacts.size(); ++c) {
    const BodyPair pair{contacts.body_a[c], contacts.body_b[c]};
    const auto found = std::lower_bound(carrying.begin(), carrying.end(), std::pair{pair, 0});
    if (found != carrying.end() && found->first == pair) contacts.impulse[c] = old.impulse[found->second];
  }
}

}  // namespace

template <int Dim>
bool needs_rebuild(const NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  if (reference.position.size() != particles.position.size()) return true;
  double largest = 0;  // squared
  for (std::size_t i = 0; i < reference.position.size(); ++i) {
    const Vec<Dim> d = particles.position[i] - reference.position[i];
    largest = std::max(largest, dot(d, d));
  }
  for (std::size_t w = 0; w < reference.wall_point.size(); ++w) {
    const Vec<Dim> d = particles.walls[w].point - reference.wall_point[w];
    largest = std::max(largest, dot(d, d));
  }
  return 4 * largest > 0.81 * reference.skin * reference.skin;
}

template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  reference.position = particles.position;
  reference.wall_point.clear();
  for (const Wall<Dim>& wall : particles.walls) reference.wall_point.push_back(wall.point);
  ++reference.generation;
}

template <int Dim>
RigidContacts<Dim> candidate_contacts(const RigidParticles<Dim>& particles,
                                      const NeighbourReference<Dim>& reference, const FrictionRule& friction,
                                      const RigidContacts<Dim>& old) {
  RigidContacts<Dim> contacts = coloured_contacts(close_pairs(particles, reference), particles, friction);
  carry_impulses(old, contacts);
  return contacts;
}

template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, RigidContacts<Dim>& contacts) {
  const int n = particles.size();
  for (int c = 0; c < contacts.size(); ++c) {
    const int a = contacts.body_a[c], b = contacts.body_b[c];
    if (b < n) {
      const Vec<Dim> d = particles.position[b] - particles.position[a];
      const double r = norm(d);
      contacts.gap[c] = r - (particles.radius[a] + particles.radius[b]);  // g = |x_b - x_a| - (R_a + R_b)
      contacts.normal[c] = (1 / r) * d;
    } else {
      const Wall<Dim>& wall = particles.walls[b - n];
      contacts.gap[c] = dot(particles.position[a] - wall.point, wall.normal) - particles.radius[a];
      contacts.normal[c] = -wall.normal;  // from the particle to the wall
    }
  }
}

template bool needs_rebuild<2>(const NeighbourReference<2>&, const RigidParticles<2>&);
template bool needs_rebuild<3>(const NeighbourReference<3>&, const RigidParticles<3>&);
template void set_reference<2>(NeighbourReference<2>&, const RigidParticles<2>&);
template void set_reference<3>(NeighbourReference<3>&, const RigidParticles<3>&);
template RigidContacts<2> candidate_contacts<2>(const RigidParticles<2>&, const NeighbourReference<2>&,
                                                const FrictionRule&, const RigidContacts<2>&);
template RigidContacts<3> candidate_contacts<3>(const RigidParticles<3>&, const NeighbourReference<3>&,
                                                const FrictionRule&, const RigidContacts<3>&);
template void detect_contacts<2>(const RigidParticles<2>&, RigidContacts<2>&);
template void detect_contacts<3>(const RigidParticles<3>&, RigidContacts<3>&);

}  // namespace softgrain
