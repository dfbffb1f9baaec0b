#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "softgrain/geometry/outline_curve.hpp"
#include "softgrain/geometry/star_surface.hpp"
#include "softgrain/sample/placed_grain.hpp"

// Lists of a case file as they are written, one item to a line; write_number(double) -> text.

namespace softgrain {

template <class WriteNumber>
std::string list_text(const std::vector<PlacedGrain>& grains, const WriteNumber& write_number) {
  std::string list;
  for (const PlacedGrain& grain : grains)
    list += fmt::format("{}\n  [{}, {}, {}, {}{}]", list.empty() ? "" : ",", write_number(grain.centre[0]),
                        write_number(grain.centre[1]), write_number(grain.radius), write_number(grain.angle),
                        grain.kind == 0 ? "" : fmt::format(", {}", grain.kind));
  return fmt::format("[{}{}]", list, list.empty() ? "" : "\n");
}

template <class WriteNumber>
std::string list_text(const std::vector<OutlinePoint>& outline, const WriteNumber& write_number) {
  std::string list;
  for (const OutlinePoint& point : outline)
    list += fmt::format("{}\n  [{}, {}{}]", list.empty() ? "" : ",", write_number(point.x[0]),
                        write_number(point.x[1]), point.corner ? ", 1" : "");
  return fmt::format("[{}{}]", list, list.empty() ? "" : "\n");
}

template <class WriteNumber>
std::string list_text(const TriangleMesh& mesh, const WriteNumber& write_number) {
  if (mesh.triangle.empty()) return "[]";
  std::string vertices, triangles;
  for (const Vec<3>& x : mesh.vertex)
    vertices += fmt::format("{}\n  [{}, {}, {}]", vertices.empty() ? "" : ",", write_number(x[0]),
                            write_number(x[1]), write_number(x[2]));
  for (const auto& t : mesh.triangle)
    triangles += fmt::format("{}\n  [{}]", triangles.empty() ? "" : ",", fmt::join(t, ", "));
  return fmt::format("[[{}], [{}]]", vertices, triangles);
}

}  // namespace softgrain
