#include "softgrain/io/format/stored_scene.hpp"

#include <string>
#include <utility>

#include "softgrain/io/format/snapshot_groups.hpp"

namespace softgrain {

StoredScene::StoredScene(const std::filesystem::path& snapshot) : file_(snapshot) {
  for (const std::string& path : file_.datasets()) {
    for (const auto& [group, arrays] : {std::pair(&contact_group, &scene_.contacts),
                                        {&outline_group, &scene_.outlines},
                                        {&surface_group, &scene_.surface}})
      if (path.starts_with(*group)) (*arrays)[path.substr(group->size())] = file_.read(path);
    if (path.starts_with(particle_group)) particles_[path.substr(particle_group.size())] = file_.shape(path);
    if (path == walls_path) scene_.wall_segments = file_.read_reals(path);
    if (path == cell_path) scene_.cell = file_.read_reals(path);
  }
}

ParticleRows StoredScene::particles() const {
  return {.arrays = particles_,
          .rows = [this](const std::string& name, std::size_t first, std::size_t count) {
            return file_.read_rows(particle_group + name, first, count);
          }};
}

}  // namespace softgrain
