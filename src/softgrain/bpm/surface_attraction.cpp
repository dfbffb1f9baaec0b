#include "softgrain/bpm/surface_attraction.hpp"

#include <utility>

#include "softgrain/geometry/ball.hpp"

namespace softgrain {
namespace {

template <int Dim>
using Image = typename PeriodicCell<Dim>::Image;

/// Of body b, which particle a sees; null where it sees itself.
template <int Dim>
const Image<Dim>* image_of(const RigidContacts<Dim>& contacts, int c) {
  return c < contacts.first_crossing() ? nullptr : &contacts.image[c - contacts.first_crossing()];
}

/// Gap of a contact and normal from a to b, where the particles are.
template <int Dim>
struct Apart {
  double gap;
  Vec<Dim> normal;

  Apart(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts, int c) {
    const int a = contacts.body_a[c], b = contacts.body_b[c], n = particles.size();
    if (b < n) {
      const Image<Dim>* image = image_of(contacts, c);
      const Vec<Dim> shift = image == nullptr ? Vec<Dim>{} : particles.cell.shift(*image);
      const Vec<Dim> d = particles.position[b] + shift - particles.position[a];
      const double r = norm(d);
      gap = r - (particles.radius[a] + particles.radius[b]);
      normal = (1 / r) * d;
    } else {
      const Wall<Dim>& wall = particles.walls[b - n];
      gap = dot(particles.position[a] - wall.point, wall.normal) - particles.radius[a];
      normal = -wall.normal;
    }
  }
};

}  // namespace

template <int Dim>
SurfaceAttraction<Dim>::SurfaceAttraction(std::vector<int> kind_of_grain, int kinds,
                                          std::span<const PairAdhesion> named)
    : range_(longest_range(named)),
      kind_of_grain_(std::move(kind_of_grain)),
      law_(adhesion_by_kinds(kinds, named)) {}

template <int Dim>
auto SurfaceAttraction<Dim>::pair(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                                  int c) const -> std::optional<Pair> {
  const int a = contacts.body_a[c], b = contacts.body_b[c], n = particles.size();
  const int kind = kind_of_grain_[particles.grain[a]],
            other = b < n ? kind_of_grain_[particles.grain[b]] : ByKinds<Adhesion>::wall;
  const Adhesion& law = law_.of(kind, other);
  if (!law.any()) return std::nullopt;
  const double l = particles.radius[a] + particles.radius[b < n ? b : a];
  return Pair{law, times_power<Dim - 1>(1, l)};
}

template <int Dim>
double SurfaceAttraction<Dim>::pull(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                                    int c, double gap) const {
  if (!any() || gap >= range_) return 0;
  const std::optional<Pair> attracting = pair(particles, contacts, c);
  return attracting ? attracting->face * attracting->law.traction(gap) : 0;
}

template <int Dim>
double SurfaceAttraction<Dim>::add_forces(const RigidParticles<Dim>& particles,
                                          const RigidContacts<Dim>& contacts,
                                          std::span<Vec<Dim>> force) const {
  double power = 0;
  if (!any()) return power;
  for (int c = contacts.blocks.back().begin(); c < contacts.size(); ++c) {
    const Apart<Dim> apart(particles, contacts, c);
    const double F = pull(particles, contacts, c, apart.gap);
    if (F == 0) continue;
    // F n on a, -F n on b, of which the image moves faster by (dH/dt) n
    force[contacts.body_a[c]] += F * apart.normal;
    force[contacts.body_b[c]] -= F * apart.normal;
    if (const Image<Dim>* image = image_of(contacts, c))
      power += F * dot(apart.normal, particles.cell.velocity(*image));
  }
  return power;
}

template <int Dim>
double SurfaceAttraction<Dim>::energy(const RigidParticles<Dim>& particles,
                                      const RigidContacts<Dim>& contacts) const {
  double sum = 0;
  if (!any()) return sum;
  for (int c = contacts.blocks.back().begin(); c < contacts.size(); ++c) {
    const double gap = Apart<Dim>(particles, contacts, c).gap;
    if (gap >= range_) continue;
    if (const std::optional<Pair> attracting = pair(particles, contacts, c))
      sum += attracting->face * attracting->law.energy(gap);
  }
  return sum;
}

template class SurfaceAttraction<2>;
template class SurfaceAttraction<3>;

}  // namespace softgrain
