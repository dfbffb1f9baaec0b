#include "softgrain/rigid/neighbours.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <set>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/geometry/images.hpp"
#include "softgrain/math/wide.hpp"

namespace softgrain {
namespace {

/// Where the lists have a wall: an open one far away, so that they are stale when it closes.
template <int Dim>
Vec<Dim> listed_point(const Wall<Dim>& wall) {
  constexpr double out_of_reach = 1e9;  // [m]
  return wall.open ? -out_of_reach * wall.normal : wall.point;
}

/// How far a body may go before grains that were not close may meet, in units of the skin.
constexpr double far_share = 4;

/// How near to missing a pair a list is made again along with one that might: the arrays of contacts are
/// then put together once for all of them.
constexpr double renewed_share = 0.5;

template <int Dim>
std::vector<GrainRange> grain_ranges(const RigidParticles<Dim>& particles) {
  std::vector<GrainRange> ranges;
  for (int i = 0; i < particles.size(); ++i) {
    if (i == 0 || particles.grain[i] != particles.grain[i - 1]) ranges.push_back({i, i});
    ++ranges.back().end;
  }
  assert(std::set<int>(particles.grain.begin(), particles.grain.end()).size() == ranges.size());
  return ranges;
}

/// A circle (sphere) round a grain at the reference.
template <int Dim>
struct Bounds {
  Vec<Dim> centre;
  double radius = 0;

  Bounds(const NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
         const GrainRange& grain) {
    for (int i = grain.begin; i < grain.end; ++i)
      centre += (1.0 / (grain.end - grain.begin)) * reference.between[i];
    for (int i = grain.begin; i < grain.end; ++i)
      radius = std::max(radius, norm(reference.between[i] - centre) + particles.radius[i]);
  }
};

template <int Dim>
void find_close_grains(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  const double room = reference.skin + 2 * reference.far + reference.reach;
  std::vector<Vec<Dim>>& centre = reference.centre;
  std::vector<double> radius;
  centre.clear();
  for (const GrainRange& grain : reference.grains) {
    const Bounds<Dim> bounds(reference, particles, grain);
    centre.push_back(bounds.centre);
    radius.push_back(bounds.radius);
  }
  reference.close.clear();
  if (centre.empty()) return;
  reference.widest = *std::max_element(radius.begin(), radius.end());
  const double reach = 2 * reference.widest + room;
  for_each_close_pair<Dim>(centre, reference.cell, reach,
                           [&](int g, int h, const Vec<Dim>& d, const auto& image) {
                             if (norm(d) < radius[g] + radius[h] + room)
                               reference.close.push_back({g, h, image});
                           });
  const int grains = static_cast<int>(centre.size());
  for (int w = 0; w < static_cast<int>(particles.walls.size()); ++w)
    for (int g = 0; g < grains; ++g)
      if (dot(centre[g] - reference.wall_point[w], particles.walls[w].normal) < radius[g] + room)
        reference.close.push_back({g, grains + w, {}});
}

/// Displacement of a body since a reference: D of its middle, and d of its particles about it.
template <int Dim>
struct Displacement {
  Vec<Dim> middle;
  double most_about = 0;
};

template <int Dim>
Displacement<Dim> displacement_of(const std::vector<Vec<Dim>>& reference,
                                  const RigidParticles<Dim>& particles, const GrainRange& grain) {
  Displacement<Dim> moved;
  for (int i = grain.begin; i < grain.end; ++i) moved.middle += particles.position[i] - reference[i];
  moved.middle *= 1.0 / (grain.end - grain.begin);
  double square = 0;
  for (int i = grain.begin; i < grain.end; ++i) {
    const Vec<Dim> about = particles.position[i] - reference[i] - moved.middle;
    square = std::max(square, dot(about, about));
  }
  moved.most_about = std::sqrt(square);
  return moved;
}

/// How far a body has gone, but for what the cell carries it [m]; and half of what the cell brings together
/// grains that are not close.
template <int Dim>
double farthest(const NeighbourReference<Dim>& reference, const PeriodicCell<Dim>& cell,
                std::vector<Displacement<Dim>> moved) {
  double most = 0;
  if (cell.any()) {
    const Mat<Dim> stretch = stretch_since(reference.cell, cell);
    for (int g = 0; g < reference.between_list(); ++g) moved[g].middle -= stretch * reference.centre[g];
    const double together = 2 * (reference.widest + reference.far) + reference.skin + reference.reach;
    most = 0.5 * together * std::sqrt(contract(stretch, stretch));
  }
  double farthest = 0;
  for (const Displacement<Dim>& of : moved) farthest = std::max(farthest, norm(of.middle) + of.most_about);
  return most + farthest;
}

/// How near each list is to missing a pair: above 1 it might.
template <int Dim>
std::vector<double> staleness(const NeighbourReference<Dim>& reference,
                              const RigidParticles<Dim>& particles) {
  const int grains = reference.between_list();
  const double limit = 0.9 * reference.skin;
  std::vector<double> stale(grains + 1, 0);
  std::vector<Displacement<Dim>> moved(grains + reference.wall_point.size());
  shared_for(
      reference.shares, grains,
      [&](int g) {
        stale[g] = 2 * displacement_of(reference.position, particles, reference.grains[g]).most_about / limit;
        moved[g] = displacement_of(reference.between, particles, reference.grains[g]);
      },
      [&](int g, Message& message) { message(stale[g]), message(moved[g]); });
  for (std::size_t w = 0; w < reference.wall_point.size(); ++w)
    moved[grains + w].middle = listed_point(particles.walls[w]) - reference.wall_point[w];
  double& between = stale[grains];
  if (reference.cell.remaps != particles.cell.remaps) between = 2;  // its images have other numbers
  for (const auto& [g, h, image] : reference.close) {
    const Displacement<Dim>&a = moved[g], &b = moved[h];
    const Vec<Dim> of_image = particles.cell.shift(image) - reference.cell.shift(image);
    between = std::max(between, (a.most_about + b.most_about + norm(a.middle - b.middle - of_image)) / limit);
  }
  between = std::max(between, farthest(reference, particles.cell, moved) / reference.far);
  return stale;
}

template <int Dim>
void take_between(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  reference.between = particles.position;
  reference.cell = particles.cell;
  reference.wall_point.clear();
  for (const Wall<Dim>& wall : particles.walls) reference.wall_point.push_back(listed_point(wall));
  find_close_grains(reference, particles);
}

/// Fields of a reference that follow from no stored position.
template <int Dim>
void start_lists(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  reference.grains = grain_ranges(particles);
  std::vector<double> weight;
  for (const GrainRange& grain : reference.grains) weight.push_back(grain.end - grain.begin);
  if (reference.shared) reference.shares = Shares(weight);
  reference.far = far_share * reference.skin;
  reference.made.assign(reference.grains.size() + 1, ++reference.generation);
}

template <int Dim>
void detect_contact(const RigidParticles<Dim>& particles, int c, RigidContacts<Dim>& contacts) {
  const int n = particles.size(), a = contacts.body_a[c], b = contacts.body_b[c];
  if (b < n) {
    const Vec<Dim> d = particles.position[b] + contacts.shift(c) - particles.position[a];
    const double r = norm(d);
    contacts.gap[c] = r - (particles.radius[a] + particles.radius[b]);  // g = |x_b - x_a| - (R_a + R_b)
    contacts.normal[c] = (1 / r) * d;
  } else {
    const Wall<Dim>& wall = particles.walls[b - n];
    contacts.gap[c] = dot(particles.position[a] - wall.point, wall.normal) - particles.radius[a];
    contacts.normal[c] = -wall.normal;  // from the particle to the wall
  }
}

/// Four contacts of particles from c on, in the same arithmetic.
void detect_four(const RigidParticles<2>& particles, int c, RigidContacts<2>& contacts) {
  const int *a = &contacts.body_a[c], *b = &contacts.body_b[c];
  const LaneColumns x_a = gather_columns(particles.position.data(), a);
  const LaneColumns x_b = gather_columns(particles.position.data(), b);
  const double* R = particles.radius.data();
  const Lanes touch = Lanes{R[a[0]], R[a[1]], R[a[2]], R[a[3]]} + Lanes{R[b[0]], R[b[1]], R[b[2]], R[b[3]]};
  const Lanes d_x = x_b.x - x_a.x, d_y = x_b.y - x_a.y;
  const Lanes r = sqrt(d_x * d_x + d_y * d_y), inverse_r = 1 / r, gap = r - touch;
  std::memcpy(&contacts.gap[c], &gap, sizeof gap);
  store_columns({inverse_r * d_x, inverse_r * d_y}, &contacts.normal[c]);
}

}  // namespace

template <int Dim>
bool renew_stale_lists(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
                       const std::function<void()>& know_all) {
  if (reference.position.size() != particles.position.size()) {
    set_reference(reference, particles);
    return true;
  }
  const std::vector<double> stale = staleness(reference, particles);
  if (std::all_of(stale.begin(), stale.end(), [](double s) { return s <= 1; })) return false;
  ++reference.generation;
  for (int list = 0; list <= reference.between_list(); ++list) {
    if (stale[list] <= renewed_share) continue;
    reference.made[list] = reference.generation;
    if (list == reference.between_list()) {
      if (know_all) know_all();
      take_between(reference, particles);
      continue;
    }
    if (!reference.shares.mine(list)) continue;
    const auto [begin, end] = reference.grains[list];
    std::copy(particles.position.begin() + begin, particles.position.begin() + end,
              reference.position.begin() + begin);
  }
  return true;
}

template <int Dim>
void set_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles) {
  reference.position = particles.position;
  start_lists(reference, particles);
  take_between(reference, particles);
}

template <int Dim>
void restore_reference(NeighbourReference<Dim>& reference, const RigidParticles<Dim>& particles,
                       std::vector<Vec<Dim>> position, std::vector<Vec<Dim>> between,
                       std::vector<Vec<Dim>> wall_point, const PeriodicCell<Dim>& cell) {
  reference.position = std::move(position);
  reference.between = std::move(between);
  reference.wall_point = std::move(wall_point);
  reference.cell = cell;
  start_lists(reference, particles);
  find_close_grains(reference, particles);
}

template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, RigidContacts<Dim>& contacts) {
  parallel_ranges(contacts.size(),
                  [&](int begin, int end) { detect_contacts(particles, begin, end, contacts); });
}

template <int Dim>
void detect_contacts(const RigidParticles<Dim>& particles, int begin, int end, RigidContacts<Dim>& contacts) {
  const auto all_particles = [&](const int* b) {
    return std::max({b[0], b[1], b[2], b[3]}) < particles.size();
  };
  int c = begin;
  if constexpr (Dim == 2)
    for (const int last = std::min(end, contacts.first_crossing()); c + lane_count <= last; c += lane_count) {
      if (all_particles(&contacts.body_b[c]))
        detect_four(particles, c, contacts);
      else
        for (int k = c; k < c + lane_count; ++k) detect_contact(particles, k, contacts);
    }
  for (; c < end; ++c) detect_contact(particles, c, contacts);
}

template bool renew_stale_lists<2>(NeighbourReference<2>&, const RigidParticles<2>&,
                                   const std::function<void()>&);
template void set_reference<2>(NeighbourReference<2>&, const RigidParticles<2>&);
template void restore_reference<2>(NeighbourReference<2>&, const RigidParticles<2>&, std::vector<Vec<2>>,
                                   std::vector<Vec<2>>, std::vector<Vec<2>>, const PeriodicCell<2>&);
template bool renew_stale_lists<3>(NeighbourReference<3>&, const RigidParticles<3>&,
                                   const std::function<void()>&);
template void set_reference<3>(NeighbourReference<3>&, const RigidParticles<3>&);
template void restore_reference<3>(NeighbourReference<3>&, const RigidParticles<3>&, std::vector<Vec<3>>,
                                   std::vector<Vec<3>>, std::vector<Vec<3>>, const PeriodicCell<3>&);
template void detect_contacts<2>(const RigidParticles<2>&, RigidContacts<2>&);
template void detect_contacts<2>(const RigidParticles<2>&, int, int, RigidContacts<2>&);
template void detect_contacts<3>(const RigidParticles<3>&, RigidContacts<3>&);
template void detect_contacts<3>(const RigidParticles<3>&, int, int, RigidContacts<3>&);

}  // namespace softgrain
