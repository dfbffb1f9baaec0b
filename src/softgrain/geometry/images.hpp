#pragma once
#include <span>
#include <vector>

#include "softgrain/geometry/cell_grid.hpp"
#include "softgrain/geometry/periodic_cell.hpp"

namespace softgrain {

/// Points of a periodic cell, moved into it, and those of their images that lie within a reach of it: every
/// pair of points closer than the reach, whatever their images, is a pair of one of the first `points` and
/// another of all of these. The reach must be below half of the cell.
template <int Dim>
struct Images {
  using Image = typename PeriodicCell<Dim>::Image;

  Images(std::span<const Vec<Dim>> points, const PeriodicCell<Dim>& cell, double reach) {
    const Mat<Dim> to_share = inverse(cell.edges);
    Vec<Dim> margin;
    for (int k = 0; k < Dim; ++k) {
      Vec<Dim> row;
      for (int j = 0; j < Dim; ++j) row[j] = to_share(k, j);
      margin[k] = reach * norm(row);
    }
    std::vector<Vec<Dim>> shares;
    for (std::size_t i = 0; i < points.size(); ++i) {
      Image n{};
      Vec<Dim> share = to_share * points[i];
      for (int k = 0; k < Dim; ++k) {
        if (!cell.repeats[static_cast<std::size_t>(k)]) continue;
        const double whole = std::floor(share[k]);
        n[static_cast<std::size_t>(k)] = -static_cast<int>(whole);
        share[k] -= whole;
      }
      add(points[i], cell, static_cast<int>(i), n);
      shares.push_back(share);
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      add_images(points[i], cell, static_cast<int>(i), shares[i], margin);
  }

  std::vector<Vec<Dim>> position;  ///< [m]
  std::vector<int> point;          ///< whose image each is
  std::vector<Image> image;        ///< n: it lies at x + H n

  /// The image of point b that is at `other`, for one of a that is at `one`.
  Image between(int one, int other) const {
    Image n = image[static_cast<std::size_t>(other)];
    for (std::size_t k = 0; k < Dim; ++k) n[k] -= image[static_cast<std::size_t>(one)][k];
    return n;
  }

 private:
  void add(const Vec<Dim>& x, const PeriodicCell<Dim>& cell, int i, const Image& n) {
    position.push_back(x + cell.shift(n));
    point.push_back(i);
    image.push_back(n);
  }

  /// Neighbours of the point's image in the cell that lie within the margin of it.
  void add_images(const Vec<Dim>& x, const PeriodicCell<Dim>& cell, int i, const Vec<Dim>& share,
                  const Vec<Dim>& margin) {
    int count = 1;
    for (int k = 0; k < Dim; ++k) count *= 3;
    for (int code = 0; code < count; ++code) {
      Image n = image[static_cast<std::size_t>(i)];
      bool near = true, moved = false;
      for (int k = 0, rest = code; k < Dim; ++k, rest /= 3) {
        const int step = rest % 3 - 1;
        if (step == 0) continue;
        moved = true;
        const double place = share[k] + step;
        near =
            near && cell.repeats[static_cast<std::size_t>(k)] && place > -margin[k] && place < 1 + margin[k];
        n[static_cast<std::size_t>(k)] += step;
      }
      if (near && moved) add(x, cell, i, n);
    }
  }
};

/// Calls visit(i, j, d, n) once, i < j, for every pair of points closer than the reach, and others: d is the
/// way from i to the image n of j. All images are met; without a cell that repeats, as CellGrid has them.
template <int Dim, class Visit>
void for_each_close_pair(std::span<const Vec<Dim>> points, const PeriodicCell<Dim>& cell, double reach,
                         const Visit& visit) {
  if (!cell.any()) {
    CellGrid<Dim>(points, reach).for_each_close_pair([&](int i, int j) {
      visit(i, j, points[static_cast<std::size_t>(j)] - points[static_cast<std::size_t>(i)],
            typename Images<Dim>::Image{});
    });
    return;
  }
  const Images<Dim> images(points, cell, reach);
  const CellGrid<Dim> grid(images.position, reach);
  for (int i = 0; i < static_cast<int>(points.size()); ++i)
    grid.for_each_neighbour(i, [&](int at) {
      const int j = images.point[static_cast<std::size_t>(at)];
      if (i >= j) return;
      visit(i, j,
            images.position[static_cast<std::size_t>(at)] - images.position[static_cast<std::size_t>(i)],
            images.between(i, at));
    });
}

}  // namespace softgrain
