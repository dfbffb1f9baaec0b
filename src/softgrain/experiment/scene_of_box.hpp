#pragma once
#include <utility>
#include <vector>

#include "softgrain/geometry/box.hpp"
#include "softgrain/model/model.hpp"

namespace softgrain {

/// The faces of a box or a cell in space, a row of four corners for each, in the order of BoxWall; of walls
/// without sides as far as they are drawn.
inline void add_faces(const Box<3>& box, const std::pair<double, double>& reach, Scene& scene) {
  Vec<3> low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = box.bounded(k) ? box.low(k).point[k] : box.repeats(k) ? 0 : reach.first;
    high[k] = box.bounded(k) ? box.high(k).point[k] : box.repeats(k) ? box.length(k) : reach.second;
  }
  std::vector<double> corners;
  for (std::size_t w = 0; w < box.faces(); ++w) {
    const int axis = 2 - static_cast<int>(w / 2), a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int corner = 0; corner < 4; ++corner) {
      Vec<3> x;
      x[axis] = w % 2 == 0 ? low[axis] : high[axis];
      x[a] = corner == 1 || corner == 2 ? high[a] : low[a];
      x[b] = corner >= 2 ? high[b] : low[b];
      corners.insert(corners.end(), x.c.begin(), x.c.end());
    }
  }
  scene.surface["walls"] = {12, std::move(corners)};
}

}  // namespace softgrain
