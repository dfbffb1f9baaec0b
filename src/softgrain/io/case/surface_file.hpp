#pragma once
#include <string>

#include "softgrain/geometry/star_surface.hpp"
#include "softgrain/io/case/case_draft.hpp"

namespace softgrain {

/// The surface in the STL or PLY file that a case names, or an empty one with an issue in the draft that
/// names the file, and its line or byte. The file lies beside the case file, or where a --set says.
TriangleMesh surface_of_file(const std::string& name, Origin origin, CaseDraft& draft);

}  // namespace softgrain
