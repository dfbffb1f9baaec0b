#pragma once
#include <string>

namespace softgrain {

// Where the datasets of a snapshot stand (docs/format.md).
inline const std::string checkpoint_group = "/checkpoint/", scene_group = "/scene/",
                         particle_group = "/scene/particles/", contact_group = "/scene/contacts/",
                         outline_group = "/scene/outlines/", surface_group = "/scene/surface/",
                         walls_path = "/scene/walls", cell_path = "/scene/cell", run_group = "/run/";

}  // namespace softgrain
