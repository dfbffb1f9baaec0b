#pragma once
#include <vector>

#include "softgrain/soft/surface_contacts.hpp"

namespace softgrain {

/// Adds the contacts of rigid spheres with gap < margin [m]: with walls, with each other, and with the
/// vertices and the middles of the patches and edges of soft grains, as walls have them; normals go from
/// centre to centre, or to the point. Keeps the list sorted by point.
void add_sphere_contacts(const SolidGrains& grains, const OutlineStateOf<3>& state, double margin,
                         std::vector<SurfaceContact>& contacts);

}  // namespace softgrain
