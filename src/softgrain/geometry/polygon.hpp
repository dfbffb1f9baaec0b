#pragma once
#include <span>
#include <vector>

#include "softgrain/math/vec.hpp"

namespace softgrain {

/// Area of a closed polygon [m^2], positive if counter-clockwise: A = 1/2 sum x_k x x_k+1.
double polygon_area(std::span<const Vec<2>> vertices);

/// Length of the closed outline [m].
double polygon_perimeter(std::span<const Vec<2>> vertices);

/// Centre of area [m].
Vec<2> polygon_centroid(std::span<const Vec<2>> vertices);

/// Do the edges from the vertices i and j cross or touch? Neighbours do where one runs back on the other.
bool edges_meet(std::span<const Vec<2>> vertices, int i, int j);

/// True if no two edges meet so. O(n^2): for outlines given by users.
bool is_simple_polygon(std::span<const Vec<2>> vertices);

/// `count` points along the outline, about equally spaced, every vertex of the polygon among them (so count
/// must be at least the number of vertices), counter-clockwise.
std::vector<Vec<2>> resample_polygon(std::span<const Vec<2>> vertices, int count);

}  // namespace softgrain
