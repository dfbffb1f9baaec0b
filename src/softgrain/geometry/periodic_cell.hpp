#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "softgrain/math/tensor.hpp"

namespace softgrain {

/// A cell that repeats itself along some axes, and deforms: the image n of what is at x is at x + H n, and
/// moves faster than it by (dH/dt) n. Bodies never wrap: they go where they go, and each pair meets through
/// the images that are nearest.
///
/// H is upper triangular: the first lattice vector stays along x, so that the tilt H_xy shears the cell
/// without a turn. With the velocity gradient L = (dH/dt) H^-1 a packing that follows the cell moves at
/// v = L x; L_xy > 0 carries what lies higher to +x.
template <int Dim>
struct PeriodicCell {
  using Image = std::array<int, Dim>;

  std::array<bool, Dim> repeats{};
  /// H [m], lattice vectors as columns; unit vectors along axes that do not repeat
  Mat<Dim> edges = identity<Dim>();
  Mat<Dim> rate{};  ///< dH/dt [m/s]
  int remaps = 0;   ///< how often other lattice vectors were taken for the same lattice

  bool any() const {
    for (const bool along : repeats)
      if (along) return true;
    return false;
  }
  /// L [1/s]
  Mat<Dim> gradient() const { return rate * inverse(edges); }

  Vec<Dim> shift(const Image& n) const { return edges * as_vector(n); }    ///< H n [m]
  Vec<Dim> velocity(const Image& n) const { return rate * as_vector(n); }  ///< (dH/dt) n [m/s]

  /// The image n of b that is nearest to a, for d = b - a [m]: right where |d + H n| is below a third of the
  /// cell.
  Image nearest(const Vec<Dim>& d) const {
    if (is_within(d)) return {};
    const Vec<Dim> share = inverse(edges) * d;
    Image n{};
    for (int k = 0; k < Dim; ++k)
      if (repeats[static_cast<std::size_t>(k)])
        n[static_cast<std::size_t>(k)] = -static_cast<int>(std::lround(share[k]));
    return n;
  }

  void advance(double dt) { edges += dt * rate; }

  /// Takes the least tilted lattice vectors of the same lattice, so that |H_xy| <= H_xx/2. Images have other
  /// numbers then. True if it did.
  bool remap() {
    bool changed = false;
    for (int column = Dim - 1; column > 0; --column)
      for (int row = column - 1; row >= 0; --row) {
        if (!repeats[static_cast<std::size_t>(row)] || !repeats[static_cast<std::size_t>(column)]) continue;
        const double turns = std::round(edges(row, column) / edges(row, row));
        if (std::abs(edges(row, column)) <= (0.5 + 1e-9) * edges(row, row)) continue;
        for (int k = 0; k < Dim; ++k) {
          edges(k, column) -= turns * edges(k, row);
          rate(k, column) -= turns * rate(k, row);
        }
        changed = true;
      }
    remaps += changed ? 1 : 0;
    return changed;
  }

 private:
  /// Is d so short that no image is nearer? No lattice vector is shorter than the shortest edge.
  bool is_within(const Vec<Dim>& d) const {
    double shortest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < Dim; ++k)
      if (repeats[static_cast<std::size_t>(k)]) shortest = std::min(shortest, edges(k, k));
    return dot(d, d) < 0.16 * shortest * shortest;
  }

  static Vec<Dim> as_vector(const Image& n) {
    Vec<Dim> v;
    for (int k = 0; k < Dim; ++k) v[k] = n[static_cast<std::size_t>(k)];
    return v;
  }
};

/// How far what follows the cell has gone since another state of it, over its place then: H H_then^-1 - 1.
template <int Dim>
Mat<Dim> stretch_since(const PeriodicCell<Dim>& then, const PeriodicCell<Dim>& now) {
  Mat<Dim> stretch = now.edges * inverse(then.edges);
  for (int k = 0; k < Dim; ++k) stretch(k, k) -= 1;
  return stretch;
}

}  // namespace softgrain
