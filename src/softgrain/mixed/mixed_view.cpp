#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <variant>

#include "softgrain/mixed/mixed_grains.hpp"
#include "softgrain/model/grain_contacts.hpp"

// What is seen of bonded grains among elastic ones, in the order of the sample.

namespace softgrain {
namespace {

template <class T>
std::vector<T>& values_of(Arrays& arrays, const std::string& name) {
  return std::get<std::vector<T>>(arrays.at(name).values);
}

/// Rows of `more` after those of `to`, for the names that both have.
void append_common(Arrays& to, const Arrays& more) {
  for (auto at = to.begin(); at != to.end();) {
    const auto found = more.find(at->first);
    if (found == more.end()) {
      at = to.erase(at);
      continue;
    }
    std::visit(
        [&](auto& values) {
          const auto& rows = std::get<std::decay_t<decltype(values)>>(found->second.values);
          values.insert(values.end(), rows.begin(), rows.end());
        },
        at->second.values);
    ++at;
  }
}

/// Of primaries what material points have, too: J = 1, an isotropic stress, no flow.
void add_fields_of_points(Arrays& primaries) {
  const std::vector<double>& pressure = values_of<double>(primaries, "pressure");
  std::vector<double> stress;
  for (const double p : pressure) stress.insert(stress.end(), {-p, 0, 0, -p});
  primaries["J"] = {1, std::vector<double>(pressure.size(), 1)};
  primaries["von_mises_stress"] = primaries["plastic_strain"] = {1, std::vector<double>(pressure.size(), 0)};
  primaries["stress"] = {4, std::move(stress)};
}

/// Of values of vertices those of each grain.
std::vector<std::vector<Vec<2>>> parts_of(const std::vector<Vec<2>>& values, const std::vector<int>& begin) {
  std::vector<std::vector<Vec<2>>> parts;
  for (std::size_t g = 0; g + 1 < begin.size(); ++g)
    parts.emplace_back(values.begin() + begin[g], values.begin() + begin[g + 1]);
  return parts;
}

/// Gives a force at x to the ends of the nearest side of a closed outline.
void give(const Vec<2>& force, const Vec<2>& x, std::span<const Vec<2>> outline, std::span<Vec<2>> forces) {
  double least = std::numeric_limits<double>::infinity(), share = 0;
  std::size_t nearest = 0;
  const auto after = [&](std::size_t k) { return k + 1 < outline.size() ? k + 1 : 0; };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec<2> side = outline[after(k)] - outline[k], d = x - outline[k];
    const double length = dot(side, side), s = length > 0 ? std::clamp(dot(d, side) / length, 0.0, 1.0) : 0;
    const double distance = norm(d - s * side);
    if (distance >= least) continue;
    least = distance, nearest = k, share = s;
  }
  if (outline.empty()) return;
  forces[nearest] += (1 - share) * force;
  forces[after(nearest)] += share * force;
}

}  // namespace

Bodies MixedGrains::bodies() const {
  Bodies all = elastic_.bodies();
  for (int& grain : all.grain) grain = elastic_number_[grain];
  const Bodies more = bonded_.bodies();
  all.mass.insert(all.mass.end(), more.mass.begin(), more.mass.end());
  all.velocity.insert(all.velocity.end(), more.velocity.begin(), more.velocity.end());
  for (const int grain : more.grain) all.grain.push_back(bonded_number_[grain]);
  return all;
}

/// How many spans of the same outline push on the primary of contact c, which is one of them.
int MixedGrains::spans_pushing(std::size_t c) const {
  const auto same = [&](const PrimaryContact& other) {
    return other.primary == contacts_[c].primary && other.grain == contacts_[c].grain;
  };
  std::size_t first = c;
  while (first > 0 && same(contacts_[first - 1])) --first;
  int count = 0;
  for (std::size_t k = first; k < contacts_.size() && same(contacts_[k]); ++k)
    count += contacts_[k].vertex < 0 && impulse_[k][0] > 0 ? 1 : 0;
  return std::max(count, 1);
}

/// From the bonded grain to the elastic one. Each side that brings places takes half of what its places stand
/// for: a vertex half of the segments beside it, a primary its diameter. A rigid grain brings none.
std::vector<ContactPoint> MixedGrains::between_models() const {
  const SoftGrains& grains = elastic_.dynamics().grains;
  const RigidParticles<2>& primaries = bonded_.dynamics().particles;
  const auto& ranges = bonded_.dynamics().reference.grains;
  std::vector<Vec<2>> x;
  grains.gather_outline(x);
  std::vector<ContactPoint> points;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!(impulse_[c][0] > 0)) continue;
    const PrimaryContact& contact = contacts_[c];
    const int grain = primaries.grain[contact.primary];
    const bool is_rigid = ranges[grain].end - ranges[grain].begin == 1;
    const double r = primaries.radius[contact.primary];
    double length = is_rigid ? 0 : r / spans_pushing(c);
    if (contact.vertex >= 0) {
      const auto [before, after] = grains.beside(contact.vertex);
      const Vec<2>& here = x[contact.vertex];
      length = (is_rigid ? 0.5 : 0.25) * (norm(here - x[before]) + norm(here - x[after]));
    }
    points.push_back({.a = bonded_number_[grain],
                      .b = elastic_number_[contact.grain],
                      .force = (1 / elastic_.dynamics().impulse_time) * impulse_vector(contact, impulse_[c]),
                      .normal = contact.normal,
                      .position = primaries.position[contact.primary] + r * contact.normal,
                      .length = length,
                      .image = contact.image});
  }
  return points;
}

std::vector<ContactPoint> MixedGrains::contacts() const {
  std::vector<ContactPoint> all;
  const auto append = [&](std::vector<ContactPoint> points, const std::vector<int>& number) {
    for (ContactPoint& point : points) {
      point.a = number[point.a];
      if (point.b >= 0) point.b = number[point.b];
      all.push_back(point);
    }
  };
  append(elastic_.contacts(), elastic_number_);
  append(bonded_.contacts(), bonded_number_);
  const std::vector<ContactPoint> between = between_models();
  all.insert(all.end(), between.begin(), between.end());
  return all;
}

Outlines MixedGrains::outlines() const {
  const Outlines a = elastic_.outlines(), b = bonded_.outlines();
  Outlines all{.vertex = {}, .begin = {0}, .area = a.area + b.area};
  for (const std::vector<Vec<2>>& outline :
       in_order(parts_of(a.vertex, a.begin), parts_of(b.vertex, b.begin))) {
    all.vertex.insert(all.vertex.end(), outline.begin(), outline.end());
    all.begin.push_back(static_cast<int>(all.vertex.size()));
  }
  return all;
}

std::vector<BranchForce> MixedGrains::forces_on_primaries() const {
  const RigidParticles<2>& primaries = bonded_.dynamics().particles;
  std::vector<BranchForce> forces;
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (!(impulse_[c][0] > 0)) continue;
    const PrimaryContact& contact = contacts_[c];
    forces.push_back({.a = contact.primary,
                      .b = -1,
                      .force = (1 / elastic_.dynamics().impulse_time) * impulse_vector(contact, impulse_[c]),
                      .branch_a = primaries.radius[contact.primary] * contact.normal,
                      .branch_b = {}});
  }
  return forces;
}

/// Outlines of all grains, with the forces of all contacts on their vertices. Bonded grains have their forces
/// where the outline is nearest.
void MixedGrains::add_outlines(const std::vector<ContactPoint>& points, Scene& scene) const {
  const Outlines of_elastic = elastic_.outlines(), of_bonded = bonded_.outlines(), all = outlines();
  std::vector<Vec<2>> on_elastic(of_elastic.vertex.size()), on_bonded(of_bonded.vertex.size());
  const std::vector<double>& felt = values_of<double>(scene.outlines, "force");
  for (std::size_t v = 0; v < on_elastic.size(); ++v) on_elastic[v] = {felt[2 * v], felt[2 * v + 1]};
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Vec<2> force = (1 / elastic_.dynamics().impulse_time) * impulse_vector(contacts_[c], impulse_[c]);
    if (impulse_[c][0] > 0)
      contacts_[c].for_each_vertex([&](int v, double weight) { on_elastic[v] += weight * force; });
  }
  std::vector<int> place(kind_.size(), -1);  // of the bonded grains, among these
  for (std::size_t k = 0; k < bonded_number_.size(); ++k) place[bonded_number_[k]] = static_cast<int>(k);
  const auto give_to = [&](int grain, const Vec<2>& force, const Vec<2>& x) {
    if (grain < 0 || place[grain] < 0) return;
    const auto begin = static_cast<std::size_t>(of_bonded.begin[place[grain]]),
               count = static_cast<std::size_t>(of_bonded.begin[place[grain] + 1]) - begin;
    give(force, x, std::span(of_bonded.vertex).subspan(begin, count),
         std::span(on_bonded).subspan(begin, count));
  };
  for (const ContactPoint& point : points) {
    give_to(point.a, -point.force, point.position);
    give_to(point.b, point.force, point.position - point.image);
  }
  std::vector<Vec<2>> force;
  std::vector<std::int64_t> grain_of_vertex;
  for (const std::vector<Vec<2>>& part :
       in_order(parts_of(on_elastic, of_elastic.begin), parts_of(on_bonded, of_bonded.begin)))
    force.insert(force.end(), part.begin(), part.end());
  for (std::size_t g = 0; g < kind_.size(); ++g)
    grain_of_vertex.insert(grain_of_vertex.end(), all.begin[g + 1] - all.begin[g],
                           static_cast<std::int64_t>(g));
  scene.outlines["position"] = to_array(all.vertex);
  scene.outlines["force"] = to_array(force);
  scene.outlines["grain"] = {1, std::move(grain_of_vertex)};
}

/// Material points, then primaries.
Scene MixedGrains::scene(const Box<2>& box) const {
  Scene scene = elastic_.scene(box), more = bonded_.scene_with(box, forces_on_primaries());
  auto& grain = values_of<std::int64_t>(scene.particles, "grain");
  const std::size_t points = grain.size();
  for (std::int64_t& of_point : grain) of_point = elastic_number_[of_point];
  std::vector<std::int64_t> grain_of_primary, kind, is_primary(points, 0);
  for (const int of_primary : bonded_.dynamics().particles.grain)
    grain_of_primary.push_back(bonded_number_[of_primary]);
  is_primary.resize(points + grain_of_primary.size(), 1);
  more.particles["grain"] = {1, std::move(grain_of_primary)};
  add_fields_of_points(more.particles);
  append_common(scene.particles, more.particles);
  for (const std::int64_t of_particle : values_of<std::int64_t>(scene.particles, "grain"))
    kind.push_back(kind_[of_particle]);
  scene.particles["kind"] = {1, std::move(kind)};
  scene.particles["primary"] = {1, std::move(is_primary)};
  const std::vector<ContactPoint> contacts = this->contacts();
  add_outlines(contacts, scene);
  scene.contacts = grain_contacts(contacts, static_cast<int>(kind_.size()));
  return scene;
}

}  // namespace softgrain
