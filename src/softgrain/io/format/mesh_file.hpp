#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/geometry/star_surface.hpp"

namespace softgrain {

/// A mesh as a file has it, and where in the file each triangle stands: "line 12", or "byte 184".
struct MeshText {
  TriangleMesh mesh;
  std::vector<std::string> place;
};

/// The most triangles that a file may have: a run keeps them in its case file.
inline constexpr std::size_t most_triangles = 10000;

/// Reads STL and PLY, text or binary, of either byte order. Vertices in one place are one; polygons become
/// fans of triangles; triangles with two corners in one place are left out, as are colours and all else.
/// Safe on any bytes: raises UsageError with the line or byte, what is wrong there and what to do.
MeshText read_mesh(std::string_view bytes);

}  // namespace softgrain
