#include "softgrain/observe/contact_network.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace softgrain {
namespace {

template <int Dim>
ContactPointOf<Dim> seen_from_first(const ContactPointOf<Dim>& p) {
  if (p.b < 0 || p.a < p.b) return p;
  return {.a = p.b,
          .b = p.a,
          .force = -p.force,
          .normal = -p.normal,
          .position = p.position - p.image,
          .length = p.length,
          .image = -p.image};
}

/// Means are weighted by |f_n|. Returns the weight.
template <int Dim>
double add(GrainPairOf<Dim>& pair, const ContactPointOf<Dim>& point) {
  const double f_n = dot(point.force, point.normal), weight = std::abs(f_n);
  ++pair.points;
  pair.normal_force += f_n;
  pair.force += point.force;
  pair.normal += weight * point.normal;
  pair.position += weight * point.position;
  pair.length += point.length;
  return weight;
}

/// What is left of a network without grains of fewer than `least` contacts, one after the other.
struct Held {
  int grains = 0, pairs = 0;
  double z() const { return grains > 0 ? 2.0 * pairs / grains : 0; }
};

template <int Dim>
Held held_by(int least, const ContactNetworkOf<Dim>& network) {
  std::vector<int> loose(network.grains, 0);
  Held held{.grains = network.grains, .pairs = 0};
  for (bool found = true; found;) {
    found = false;
    std::vector<int> contacts(network.grains, 0);
    held.pairs = 0;
    for (const auto& pair : network.walls) ++contacts[pair.a];
    for (const auto& pair : network.pairs) {
      if (loose[pair.a] || loose[pair.b]) continue;
      ++contacts[pair.a], ++contacts[pair.b];
      ++held.pairs;
    }
    for (int g = 0; g < network.grains; ++g) {
      if (loose[g] || contacts[g] >= least) continue;
      loose[g] = 1;
      --held.grains;
      found = true;
    }
  }
  return held;
}

template <int Dim>
void take_means(std::vector<GrainPairOf<Dim>>& pairs, std::span<const double> weight) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k].position *= 1 / weight[k];
    const double size = norm(pairs[k].normal);
    if (size > 0) pairs[k].normal *= 1 / size;
  }
}

template <int Dim>
ContactNetworkOf<Dim> network_of(std::span<const ContactPointOf<Dim>> points, int grains) {
  using Point = ContactPointOf<Dim>;
  std::vector<Point> sorted;
  for (const Point& point : points)
    if (point.a != point.b && dot(point.force, point.normal) != 0) sorted.push_back(seen_from_first(point));
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Point& p, const Point& q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); });
  ContactNetworkOf<Dim> network{.grains = grains, .pairs = {}, .walls = {}};
  std::vector<double> weight_of_pairs, weight_of_walls;
  for (const Point& point : sorted) {
    auto& list = point.b < 0 ? network.walls : network.pairs;
    auto& weight = point.b < 0 ? weight_of_walls : weight_of_pairs;
    if (list.empty() || list.back().a != point.a || list.back().b != point.b) {
      weight.push_back(0);
      list.push_back({.a = point.a,
                      .b = point.b,
                      .points = 0,
                      .normal_force = 0,
                      .force = {},
                      .normal = {},
                      .position = {},
                      .image = point.image});
    }
    weight.back() += add(list.back(), point);
  }
  take_means<Dim>(network.pairs, weight_of_pairs);
  take_means<Dim>(network.walls, weight_of_walls);
  return network;
}

template <int Dim>
Coordination coordination_of(const ContactNetworkOf<Dim>& network) {
  const int n = network.grains;
  if (n == 0) return {};
  const Held no_rattlers = held_by(Dim, network), backbone = held_by(Dim + 1, network);
  const auto pairs = static_cast<double>(network.pairs.size()),
             with_walls = pairs + static_cast<double>(network.walls.size());
  return {.z = 2 * pairs / n,
          .z_no_rattlers = no_rattlers.z(),
          .rattlers = 1 - static_cast<double>(no_rattlers.grains) / n,
          .z_backbone = backbone.z(),
          .backbone = static_cast<double>(backbone.grains) / n,
          .z_with_walls = 2 * with_walls / n};
}

}  // namespace

ContactNetworkOf<2> contact_network(std::span<const ContactPointOf<2>> points, int grains) {
  return network_of(points, grains);
}
ContactNetworkOf<3> contact_network(std::span<const ContactPointOf<3>> points, int grains) {
  return network_of(points, grains);
}

Coordination coordination(const ContactNetworkOf<2>& network) { return coordination_of(network); }
Coordination coordination(const ContactNetworkOf<3>& network) { return coordination_of(network); }

double mean_sides(const ContactNetwork& network, std::span<const double> perimeter, double least_share) {
  if (network.grains == 0) return 0;
  int sides = 0;
  const auto is_side = [&](const GrainPair& pair, int grain) {
    return pair.length >= least_share * perimeter[grain] ? 1 : 0;
  };
  for (const GrainPair& pair : network.pairs) sides += is_side(pair, pair.a) + is_side(pair, pair.b);
  for (const GrainPair& pair : network.walls) sides += is_side(pair, pair.a);
  return static_cast<double>(sides) / network.grains;
}

}  // namespace softgrain
