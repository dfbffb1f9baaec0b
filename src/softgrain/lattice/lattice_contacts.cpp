#include "softgrain/lattice/lattice_contacts.hpp"

#include <algorithm>
#include <limits>

namespace softgrain {
namespace {

/// A vertex that the free motion leaves farther than this from everything has no contact, in cells.
constexpr double margin = 0.5;

/// An outline where the free motion brings it, with the outward normals of its vertices.
struct MovedOutline {
  std::vector<Vec<2>> position, normal;
  Vec<2> low, high;
};

MovedOutline move_outline(const PointGrain& grain, std::span<const std::vector<NodeWeight>> weights,
                          const Lattice& lattice, double dt) {
  MovedOutline moved;
  for (std::size_t v = 0; v < grain.outline.size(); ++v)
    moved.position.push_back(grain.outline[v] + dt * velocity_of(lattice, weights[v]));
  moved.low = moved.high = moved.position.front();
  const std::size_t n = moved.position.size();
  for (std::size_t v = 0; v < n; ++v) {
    const Vec<2> chord = moved.position[(v + 1) % n] - moved.position[(v + n - 1) % n];
    moved.normal.push_back((-1 / norm(chord)) * perpendicular(chord));  // of a counter-clockwise outline
    for (int d = 0; d < 2; ++d) {
      moved.low[d] = std::min(moved.low[d], moved.position[v][d]);
      moved.high[d] = std::max(moved.high[d], moved.position[v][d]);
    }
  }
  return moved;
}

/// Where a vertex faces the nearest segment of an outline.
struct Facing {
  std::size_t a = 0, b = 0;  // ends of the segment
  double share = 0;          // it faces (1 - share) x_a + share x_b
  Vec<2> normal{};           // interpolated
  double gap = 0;            // [m]
};

Facing facing(const MovedOutline& outline, const Vec<2>& x) {
  Facing nearest;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = outline.position.size();
  for (std::size_t a = 0; a < n; ++a) {
    const std::size_t b = (a + 1) % n;
    const Vec<2> along = outline.position[b] - outline.position[a], d = x - outline.position[a];
    const double share = std::clamp(dot(d, along) / dot(along, along), 0.0, 1.0);
    const Vec<2> apart = d - share * along;
    if (dot(apart, apart) >= least) continue;
    least = dot(apart, apart);
    const Vec<2> normal = (1 - share) * outline.normal[a] + share * outline.normal[b];
    nearest = {a, b, share, (1 / norm(normal)) * normal, 0};
    nearest.gap = dot(apart, nearest.normal);
  }
  return nearest;
}

bool near_box(const MovedOutline& outline, const Vec<2>& x, double reach) {
  for (int d = 0; d < 2; ++d)
    if (x[d] < outline.low[d] - reach || x[d] > outline.high[d] + reach) return false;
  return true;
}

void append(std::vector<NodeWeight>& sum, double factor, std::span<const NodeWeight> weights) {
  for (const NodeWeight& w : weights) sum.push_back({w.node, factor * w.weight});
}

}  // namespace

Vec<2> velocity_of(const Lattice& lattice, std::span<const NodeWeight> weights) {
  Vec<2> v;
  for (const NodeWeight& w : weights) v += w.weight * lattice.velocity[w.node];
  return v;
}

void LatticeContacts::add(const LatticeContact& contact, std::span<const NodeWeight> weights) {
  contacts_.push_back(contact);
  const auto first = static_cast<std::ptrdiff_t>(weights_.size());
  weights_.insert(weights_.end(), weights.begin(), weights.end());
  std::stable_sort(weights_.begin() + first, weights_.end(),
                   [](const NodeWeight& a, const NodeWeight& b) { return a.node < b.node; });
  auto last = weights_.begin() + first;  // the two ends of a segment share nodes
  for (auto w = weights_.begin() + first + 1; w < weights_.end(); ++w) {
    if (w->node == last->node)
      last->weight += w->weight;
    else
      *++last = *w;
  }
  weights_.erase(last + 1, weights_.end());
  begin_.push_back(static_cast<int>(weights_.size()));
  double W = 0;
  for (const NodeWeight& w : weights_of(size() - 1)) W += w.weight * w.weight / lattice_.mass[w.node];
  delassus_.push_back(W);
}

Vec<2> LatticeContacts::relative_velocity(int contact) const {
  const LatticeContact& c = contacts_[contact];
  const Vec<2> u = velocity_of(lattice_, weights_of(contact)) - c.wall_velocity;
  return {dot(c.normal, u) + c.gap_rate, dot(perpendicular(c.normal), u)};
}

Vec<2> LatticeContacts::combined(int contact, std::span<const Vec<2>> node_velocity) const {
  Vec<2> sum;
  for (const NodeWeight& w : weights_of(contact)) sum += w.weight * node_velocity[w.node];
  return sum;
}

void LatticeContacts::add_impulses(std::span<const Vec<2>> impulse, std::span<Vec<2>> of_nodes) const {
  for (int c = 0; c < size(); ++c) {
    const Vec<2>& n = contacts_[c].normal;
    const Vec<2> P = impulse[c][0] * n + impulse[c][1] * perpendicular(n);
    for (const NodeWeight& w : weights_of(c)) of_nodes[w.node] += w.weight * P;
  }
}

void LatticeContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const Vec<2>& n = contacts_[contact].normal;
  const Vec<2> P = dp[0] * n + dp[1] * perpendicular(n);
  for (const NodeWeight& w : weights_of(contact))
    lattice_.velocity[w.node] += w.weight / lattice_.mass[w.node] * P;
}

void add_node_contacts(const Lattice& lattice, int grains, std::span<const Wall<2>> walls, double least_mass,
                       double wall_reach, LatticeContacts& contacts) {
  for (int g = 0; g < grains; ++g) {
    lattice.for_each_node(g, [&](int i, const Vec<2>& x) {
      if (lattice.mass[i] <= least_mass) return;
      for (int w = 0; w < static_cast<int>(walls.size()); ++w)
        if (!walls[w].open && dot(x - walls[w].point, walls[w].normal) < wall_reach)
          contacts.add({.grain = g,
                        .wall = w,
                        .normal = walls[w].normal,
                        .wall_velocity = walls[w].velocity,
                        .node = x},
                       std::vector<NodeWeight>{{i, 1}});
    });
    for (int other = 0; other < g; ++other)
      lattice.for_each_common_node(g, other, [&](int i, int j, const Vec<2>& x) {
        if (lattice.mass[i] <= least_mass || lattice.mass[j] <= least_mass) return;
        const Vec<2> n = lattice.inward[i] - lattice.inward[j];
        if (norm(n) > 0)
          contacts.add({.grain = g, .other = other, .normal = (1 / norm(n)) * n, .node = x},
                       std::vector<NodeWeight>{{i, 1}, {j, -1}});
      });
  }
}

void add_outline_contacts(std::span<const PointGrain> grains, const Lattice& lattice,
                          const OutlineWeights& outline, std::span<const Wall<2>> walls, double dt,
                          LatticeContacts& contacts) {
  const double reach = margin * lattice.cell();
  const int count = static_cast<int>(grains.size());
  std::vector<MovedOutline> moved;
  for (int g = 0; g < count; ++g)
    moved.push_back(
        move_outline(grains[g], std::span(outline.weights).subspan(outline.first_vertex[g]), lattice, dt));
  for (int g = 0; g < count; ++g)
    for (int v = 0; v < static_cast<int>(grains[g].outline.size()); ++v) {
      const Vec<2>& x = moved[g].position[v];
      const std::vector<NodeWeight>& slave = outline.weights[outline.first_vertex[g] + v];
      for (int w = 0; w < static_cast<int>(walls.size()); ++w) {
        const Vec<2>& n = walls[w].normal;
        const double gap = dot(x - walls[w].point, n);  // the wall stands where the step ends
        if (walls[w].open || gap > reach) continue;
        const double free_rate = dot(n, velocity_of(lattice, slave) - walls[w].velocity);
        contacts.add({.grain = g,
                      .wall = w,
                      .vertex = v,
                      .normal = n,
                      .gap_rate = gap / dt - free_rate,
                      .wall_velocity = walls[w].velocity},
                     slave);
      }
      for (int other = 0; other < count; ++other) {
        const bool is_slave = std::pair(grains[g].radius, g) < std::pair(grains[other].radius, other);
        if (!is_slave || !near_box(moved[other], x, reach)) continue;
        const Facing f = facing(moved[other], x);
        if (std::abs(f.gap) > reach) continue;
        std::vector<NodeWeight> both = slave;
        append(both, f.share - 1, outline.weights[outline.first_vertex[other] + f.a]);
        append(both, -f.share, outline.weights[outline.first_vertex[other] + f.b]);
        const double free_rate = dot(f.normal, velocity_of(lattice, both));
        contacts.add(
            {.grain = g, .other = other, .vertex = v, .normal = f.normal, .gap_rate = f.gap / dt - free_rate},
            both);
      }
    }
}

}  // namespace softgrain
