#pragma once
#include <array>
#include <span>

#include "softgrain/math/padded_vec.hpp"
#include "softgrain/soft/contact_of.hpp"
#include "softgrain/soft/surface_sum.hpp"

namespace softgrain {

/// One contact of LumpedSystem: u = (n, t) . sum weight v + offset, and what an impulse P does to the
/// vertices that take part, v += weight/m P.
template <int Dim>
struct LumpedRow;

// per contact and sweep: reads 160 B in the order of memory, and five velocities
template <>
struct LumpedRow<2> {
  int contact = 0;
  int vertices = 0;                  // 5; at a wall 3 or 1
  std::array<int, 5> vertex{};       // the slave, then the master's; or those of a place at a wall
  std::array<double, 5> weight{};    // 1, -w_k; or w_k
  std::array<double, 5> mobility{};  // weight/m: velocity by a unit impulse
  Vec<2> normal, offset;
  double W = 0, inverse_delassus = 0;

  LumpedRow() = default;
  LumpedRow(const OutlineContact& met, std::span<const double> inverse_mass) : normal(met.normal) {
    std::size_t count = 0;
    met.for_each_vertex([&](int v, double w) {
      vertex[count] = v;
      weight[count] = w;
      mobility[count] = w * inverse_mass[v];
      W += w * mobility[count++];
    });
    vertices = static_cast<int>(count);
    inverse_delassus = 1 / W;
  }
  double delassus() const { return W; }

  /// sum weight v
  [[gnu::always_inline]] Vec<2> velocity(const Vec<2>* v) const {
    Vec<2> u = weight[0] * v[vertex[0]];
    if (vertices == 1) return u;
    Vec<2> others = weight[1] * v[vertex[1]] + weight[2] * v[vertex[2]];
    if (vertices == 5) others += weight[3] * v[vertex[3]] + weight[4] * v[vertex[4]];
    return u += others;
  }
  [[gnu::always_inline]] void push(const Vec<2>& P, Vec<2>* v, const double*) const {
    v[vertex[0]] += mobility[0] * P;
    if (vertices == 1) return;
    for (std::size_t k = 1; k < 3; ++k) v[vertex[k]] += mobility[k] * P;
    if (vertices == 3) return;
    for (std::size_t k = 3; k < 5; ++k) v[vertex[k]] += mobility[k] * P;
  }
};

// per contact and sweep: reads 152 B in the order of memory, and the velocities and masses of 16 vertices, or
// none, and of those of the point: 1, or 4 to 6 or 16 of a middle. Which they are all grains of a shape
// share.
template <>
struct LumpedRow<3> {
  int contact = 0;
  int wall = -1;                      // or -1
  const SurfacePoint* own = nullptr;  // this middle, of the grain that begins at `begin`; or the point there
  const PatchNet* patch = nullptr;    // of another grain, which begins at `facing_begin`; none at a wall
  int begin = 0, facing_begin = 0;
  PatchWeights weight{};
  Vec<3> normal, offset;
  double inverse_delassus = 0;

  /// Asks for a row whose turn is some turns ahead, since it comes from far: the rows of hundreds of grains
  /// fill no cache.
  static constexpr int turns_ahead = 4;
  [[gnu::always_inline]] static void fetch(const LumpedRow& row) {
    constexpr std::size_t line = 64;
    for (std::size_t at = 0; at < sizeof(LumpedRow); at += line)
      __builtin_prefetch(reinterpret_cast<const char*>(&row) + at);
  }

  LumpedRow() = default;
  LumpedRow(const SurfaceContact& met, std::span<const double> inverse_mass)
      : wall(met.wall),
        own(met.own),
        patch(met.patch),
        begin(met.own != nullptr ? met.own_begin : met.vertex),
        facing_begin(met.facing_begin),
        weight(met.weight),
        normal(met.normal) {
    double W = 0;
    met.for_each_vertex([&](int v, double w) { W += w * w * inverse_mass[v]; });
    inverse_delassus = 1 / W;
  }
  double delassus() const { return 1 / inverse_delassus; }

  /// sum weight v; with places it is the way from the patch to the point.
  [[gnu::always_inline]] Vec<3> velocity(const PaddedVec* v) const {
    return first_three(point_less_patch(own, begin, patch, facing_begin, weight,
                                        [v](int vertex) { return load_lanes(v[vertex]); }));
  }
  [[gnu::always_inline]] void push(const Vec<3>& P, PaddedVec* v, const double* inverse_mass) const {
    const Lanes by{P[0], P[1], P[2], 0};
    if (own == nullptr)
      store_lanes(load_lanes(v[begin]) + inverse_mass[begin] * by, v[begin]);
    else
      push(own->count, own->vertex, own->weight, by, v + begin, inverse_mass + begin);
    if (patch != nullptr) push(16, patch->vertex, weight, -by, v + facing_begin, inverse_mass + facing_begin);
  }

 private:
  template <class Weights>
  [[gnu::always_inline]] static void push(int count, const std::array<int, 16>& at, const Weights& w, Lanes P,
                                          PaddedVec* v, const double* inverse_mass) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      store_lanes(load_lanes(v[at[k]]) + (static_cast<double>(w[k]) * inverse_mass[at[k]]) * P, v[at[k]]);
  }
};

}  // namespace softgrain
