#include "softgrain/soft/surface_patch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "softgrain/soft/curve_weights.hpp"

namespace softgrain {
namespace {

using Quad = std::array<int, 4>;

bool holds(const Quad& quad, int vertex) { return std::find(quad.begin(), quad.end(), vertex) != quad.end(); }

/// Finds the quads beside another one.
class QuadNeighbours {
 public:
  QuadNeighbours(std::span<const Quad> quads, std::span<const Quad> round) : quads_(quads), round_(round) {}

  bool has_valence_3(int vertex) const { return round_[static_cast<std::size_t>(vertex)][3] < 0; }
  /// Beyond the edge from a to b of a quad: the neighbour of a there, then that of b.
  std::array<int, 2> across(const Quad& quad, int a, int b) const {
    for (const int q : round_[static_cast<std::size_t>(a)]) {
      if (q < 0) continue;
      const Quad& other = quads_[static_cast<std::size_t>(q)];
      if (other == quad || !holds(other, b)) continue;
      // counter-clockwise there: b, a, the neighbour of a, that of b
      const auto k = static_cast<std::size_t>(std::find(other.begin(), other.end(), b) - other.begin());
      return {other[(k + 2) % 4], other[(k + 3) % 4]};
    }
    assert(false);
    return {a, b};
  }
  /// Opposite to `vertex` in the quad round it that holds neither of its two neighbours in `quad`.
  int opposite(int vertex, int before, int after) const {
    for (const int q : round_[static_cast<std::size_t>(vertex)]) {
      if (q < 0) continue;
      const Quad& other = quads_[static_cast<std::size_t>(q)];
      if (holds(other, before) || holds(other, after)) continue;
      const auto k = static_cast<std::size_t>(std::find(other.begin(), other.end(), vertex) - other.begin());
      return other[(k + 2) % 4];
    }
    assert(false);
    return vertex;
  }

 private:
  std::span<const Quad> quads_, round_;
};

PatchNet net_of(Quad quad, const QuadNeighbours& neighbours) {
  const auto first =
      std::find_if(quad.begin(), quad.end(), [&](int v) { return neighbours.has_valence_3(v); });
  const bool ghosts = first != quad.end();
  const Quad original = quad;
  if (ghosts) std::rotate(quad.begin(), first, quad.end());
  const auto [a, b, c, d] = quad;
  PatchNet net{.vertex = {}, .ghosts = ghosts};
  const auto put = [&](std::size_t i, std::size_t j, int vertex) { net.vertex[4 * i + j] = vertex; };
  put(1, 1, a), put(2, 1, b), put(2, 2, c), put(1, 2, d);
  const auto ab = neighbours.across(original, a, b), bc = neighbours.across(original, b, c),
             cd = neighbours.across(original, c, d), da = neighbours.across(original, d, a);
  put(1, 0, ghosts ? a : ab[0]), put(2, 0, ab[1]);
  put(3, 1, bc[0]), put(3, 2, bc[1]);
  put(2, 3, cd[0]), put(1, 3, cd[1]);
  put(0, 2, da[0]), put(0, 1, ghosts ? a : da[1]);
  put(0, 0, ghosts ? ab[0] : neighbours.opposite(a, d, b));
  put(3, 0, neighbours.opposite(b, a, c));
  put(3, 3, neighbours.opposite(c, b, d));
  put(0, 3, neighbours.opposite(d, c, a));
  return net;
}

constexpr std::size_t slot(std::size_t i, std::size_t j) { return 4 * i + j; }

/// Gives the weight of a row beyond a sharp side to the two rows before it.
void go_straight_on(const PatchNet& net, std::array<double, 4>& of_u, std::array<double, 4>& of_v) {
  const auto fold = [](std::array<double, 4>& w, std::size_t beyond, std::size_t edge, std::size_t inside) {
    w[edge] += 2 * w[beyond];
    w[inside] -= w[beyond];
    w[beyond] = 0;
  };
  if ((net.sharp & PatchNet::low_u) != 0) fold(of_u, 0, 1, 2);
  if ((net.sharp & PatchNet::high_u) != 0) fold(of_u, 3, 2, 1);
  if ((net.sharp & PatchNet::low_v) != 0) fold(of_v, 0, 1, 2);
  if ((net.sharp & PatchNet::high_v) != 0) fold(of_v, 3, 2, 1);
}

/// Of the edge from a corner of the patch to the next: the vertices that have weight there, one twice if need
/// be.
SurfacePoint middle_of_edge(const PatchNet& net, std::size_t from, const std::array<int, 4>& ends) {
  constexpr std::array<std::array<double, 2>, 4> place{{{0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}}};
  const auto weight = patch_weights(net, place[from][0], place[from][1]);
  SurfacePoint middle{.count = 0, .corner = ends};
  const auto add = [&](int vertex, double w) {
    const auto at = static_cast<std::size_t>(middle.count++);
    middle.vertex[at] = vertex, middle.weight[at] = w;
  };
  for (std::size_t k = 0; k < 16; ++k)
    if (weight[k] != 0) add(net.vertex[k], weight[k]);
  if (middle.count % 2 != 0) add(middle.vertex[0], 0);
  return middle;
}

/// Gives the weights of the ghosts P_01, P_10 and P_00 to the vertices of which they are made.
void spread_ghosts(std::array<double, 16>& w) {
  const double w_00 = w[slot(0, 0)], w_01 = w[slot(0, 1)] + w_00, w_10 = w[slot(1, 0)] + w_00;
  w[slot(0, 1)] = w[slot(1, 0)] = 0;
  w[slot(0, 0)] = 0.75 * (w_01 + w_10);  // C
  w[slot(1, 1)] -= 0.5 * (w_01 + w_10);
  w[slot(1, 2)] += 0.75 * w_01 - w_00;
  w[slot(2, 1)] += 0.75 * w_10 - w_00;
  w[slot(2, 2)] += w_00;
}

}  // namespace

std::vector<PatchNet> patch_nets(std::span<const Quad> quads, std::span<const Quad> quads_round) {
  const QuadNeighbours neighbours(quads, quads_round);
  std::vector<PatchNet> nets;
  for (const Quad& quad : quads) nets.push_back(net_of(quad, neighbours));
  return nets;
}

std::array<double, 16> patch_weights(const PatchNet& net, double u, double v) {
  auto of_u = curve_weights(u), of_v = curve_weights(v);
  if (net.sharp != 0) go_straight_on(net, of_u, of_v);
  std::array<double, 16> weights;
  for (std::size_t k = 0; k < 16; ++k) weights[k] = of_u[k / 4] * of_v[k % 4];
  if (net.ghosts) spread_ghosts(weights);
  return weights;
}

PatchWeights narrow_weights(const std::array<double, 16>& weights) {
  constexpr double unit = 0x1p-23;
  PatchWeights narrow;
  double rest = 1;  // exact, as all are multiples of the unit
  std::size_t largest = 0;
  for (std::size_t k = 0; k < 16; ++k) {
    const double rounded = unit * std::nearbyint(weights[k] / unit);
    narrow[k] = static_cast<float>(rounded);
    rest -= rounded;
    if (weights[k] > weights[largest]) largest = k;
  }
  narrow[largest] += static_cast<float>(rest);
  return narrow;
}

std::vector<SurfacePoint> middles_of(std::span<const PatchNet> patches) {
  std::vector<SurfacePoint> middles;
  std::map<std::pair<int, int>, SurfacePoint> of_edge;
  for (const PatchNet& net : patches) {
    std::array<int, 4> corner;
    for (std::size_t k = 0; k < 4; ++k) corner[k] = net.vertex[PatchNet::corner[k]];
    middles.push_back({.vertex = net.vertex, .weight = patch_weights(net, 0.5, 0.5), .corner = corner});
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [a, b] = std::minmax(corner[k], corner[(k + 1) % 4]);
      of_edge.try_emplace({a, b}, middle_of_edge(net, k, {a, b}));
    }
  }
  for (const auto& [ends, middle] : of_edge) middles.push_back(middle);
  return middles;
}

void SurfacePatch::put_ghosts() {
  const Lanes C = net_[slot(0, 0)], P_11 = net_[slot(1, 1)], P_21 = net_[slot(2, 1)], P_12 = net_[slot(1, 2)];
  net_[slot(0, 1)] = 0.75 * (P_12 + C) - 0.5 * P_11;
  net_[slot(1, 0)] = 0.75 * (P_21 + C) - 0.5 * P_11;
  net_[slot(0, 0)] = net_[slot(0, 1)] + net_[slot(1, 0)] - P_21 - P_12 + net_[slot(2, 2)];
}

/// Rows beyond sharp sides.
void SurfacePatch::go_straight_on(const PatchNet& net) {
  const auto row = [&](std::size_t beyond, std::size_t edge, std::size_t inside) {
    for (std::size_t j = 0; j < 4; ++j)
      net_[slot(beyond, j)] = 2 * net_[slot(edge, j)] - net_[slot(inside, j)];
  };
  const auto column = [&](std::size_t beyond, std::size_t edge, std::size_t inside) {
    for (std::size_t i = 0; i < 4; ++i)
      net_[slot(i, beyond)] = 2 * net_[slot(i, edge)] - net_[slot(i, inside)];
  };
  if ((net.sharp & PatchNet::low_u) != 0) row(0, 1, 2);
  if ((net.sharp & PatchNet::high_u) != 0) row(3, 2, 1);
  if ((net.sharp & PatchNet::low_v) != 0) column(0, 1, 2);
  if ((net.sharp & PatchNet::high_v) != 0) column(3, 2, 1);
}

Vec<3> SurfacePatch::Point::normal() const {
  const Vec<3> n = cross(along_u, along_v);
  return (1 / norm(n)) * n;
}

SurfacePatch::Point SurfacePatch::at(double u, double v) const {
  const auto w_u = curve_weights(u), w_v = curve_weights(v), s_u = curve_slopes(u), s_v = curve_slopes(v);
  Lanes place{}, along_u{}, along_v{};
  for (std::size_t i = 0; i < 4; ++i) {
    Lanes row{}, slope{};
    for (std::size_t j = 0; j < 4; ++j) {
      row += w_v[j] * net_[slot(i, j)];
      slope += s_v[j] * net_[slot(i, j)];
    }
    place += w_u[i] * row;
    along_u += s_u[i] * row;
    along_v += w_u[i] * slope;
  }
  return {first_three(place), first_three(along_u), first_three(along_v)};
}

/// Newton's method without the curvature, of which the gap takes a share of some per cent: as fast near the
/// patch, and always downhill. A coordinate that would leave the patch stays on its border.
SurfacePatch::Nearest SurfacePatch::nearest(const Vec<3>& x, double u, double v) const {
  constexpr int most_passes = 30;
  constexpr double enough = 1e-9;
  Nearest found{.u = u, .v = v, .inside = true};
  for (int pass = 0; pass < most_passes; ++pass) {
    const Point c = at(found.u, found.v);
    const Vec<3> d = x - c.place;
    const double g_u = dot(d, c.along_u), g_v = dot(d, c.along_v);
    const double uu = dot(c.along_u, c.along_u), uv = dot(c.along_u, c.along_v),
                 vv = dot(c.along_v, c.along_v);
    const double det = uu * vv - uv * uv;
    double du = (vv * g_u - uv * g_v) / det, dv = (uu * g_v - uv * g_u) / det;
    const auto leaves = [](double place, double step) {
      return (place <= 0 && step < 0) || (place >= 1 && step > 0);
    };
    const bool out_u = leaves(found.u, du), out_v = leaves(found.v, dv);
    if (out_u) du = 0, dv = leaves(found.v, g_v) ? 0 : g_v / vv;
    if (out_v) dv = 0, du = out_u || leaves(found.u, g_u) ? 0 : g_u / uu;
    const double u_next = std::clamp(found.u + du, 0.0, 1.0), v_next = std::clamp(found.v + dv, 0.0, 1.0);
    const double moved = std::max(std::abs(u_next - found.u), std::abs(v_next - found.v));
    found = {.u = u_next, .v = v_next, .inside = !out_u && !out_v};
    if (moved < enough) break;
  }
  return found;
}

SurfaceMeasure measure_surface(std::span<const PatchNet> patches, const Vec<3>* position) {
  struct Place {
    double at, weight;
  };
  constexpr double out = 0.7745966692414834 / 2;  // sqrt(3/5)/2
  constexpr std::array gauss{Place{0.5 - out, 5.0 / 18}, Place{0.5, 8.0 / 18}, Place{0.5 + out, 5.0 / 18}};
  SurfaceMeasure measure;
  for (const PatchNet& net : patches) {
    const SurfacePatch patch(net, position);
    for (const Place& u : gauss)
      for (const Place& v : gauss) {
        const auto c = patch.at(u.at, v.at);
        const Vec<3> n = cross(c.along_u, c.along_v);
        measure.volume += u.weight * v.weight / 3 * dot(c.place - position[0], n);
        measure.area += u.weight * v.weight * norm(n);
      }
  }
  return measure;
}

}  // namespace softgrain
