#pragma once
#include <span>
#include <vector>

#include "softgrain/soft/facing_surface.hpp"
#include "softgrain/soft/surface_lists.hpp"

namespace softgrain {

/// The vertex of another grain nearest to vertex `of`, or to a middle.
struct NearestVertex {
  int of, grain, vertex;
  double distance_squared;
};

/// True of the vertices at which outlines meet: not of rigid spheres, nor of centres.
bool is_of_surface(const SolidGrains& grains, int v);

/// For each vertex those within `reach` of it, of the grains to which its own brings its points, sorted by
/// (vertex, grain). Keeps a reference to the surfaces.
class NearVertices {
 public:
  NearVertices(const Surfaces& surfaces, double reach);
  std::span<const NearestVertex> of(int vertex) const {
    return std::span(near_).subspan(begin_[vertex], begin_[vertex + 1] - begin_[vertex]);
  }
  /// Those nearest to the middle of a patch or edge, which is at x, of all grains that are near one of its
  /// corners. Where the middle touches a grain, this has a vertex within reach of a corner.
  void find_for_middle(const SurfacePoint& middle, int first_vertex, const Vec<3>& x,
                       std::vector<NearestVertex>& near) const;

 private:
  double distance_squared(const Vec<3>& x, int vertex) const;
  void walk(const Vec<3>& x, NearestVertex& n) const;
  void find(double reach, int v, std::vector<NearestVertex>& all) const;

  const Surfaces& surfaces_;
  std::vector<Vec<3>> place_;  // of the vertices
  ImagedGrid grid_;
  std::vector<NearestVertex> near_;
  std::vector<int> begin_;  // (vertices + 1) where in near_ those of each begin
};

}  // namespace softgrain
