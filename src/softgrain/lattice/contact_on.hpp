#pragma once

namespace softgrain {

/// Where grains of points meet.
enum class ContactOn {
  outline,     ///< vertices of an outline against segments and walls
  grid_nodes,  ///< nodes where two grains, or a grain and a wall, have mass
};

}  // namespace softgrain
