#include "softgrain/experiment/kinds.hpp"

#include <utility>

namespace softgrain {

Case case_of_kind(Case c, int k) {
  if (c.kinds.empty()) return c;
  const Case::Kind kind = std::move(c.kinds[k]);
  c.kinds.clear();
  c.pairs.clear();
  c.experiment.model = kind.model;
  c.grain = {.radius = c.grain.radius,
             .density = kind.grain.density,
             .shape = kind.grain.shape,
             .aspect = kind.grain.aspect,
             .sides = kind.grain.sides,
             .outline = kind.grain.outline,
             .surface = kind.grain.surface};
  c.bpm = kind.bpm;
  c.mpm.law = kind.law;
  c.mpm.material = kind.material;
  c.mpm.cells = kind.cells;
  static_cast<Case::Sizes&>(c.sample) = kind.sizes;
  c.sample.grains = kind.grains;
  return c;
}

Case with_bonded_kinds(Case c) {
  std::erase_if(c.kinds, [](const Case::Kind& kind) { return kind.model == GrainModel::rigid; });
  return c;
}

Case::Kind kind_of(const Case& c) {
  return {.name = {},
          .grains = c.sample.grains,
          .model = c.experiment.model,
          .grain = c.grain,
          .bpm = c.bpm,
          .law = c.mpm.law,
          .material = c.mpm.material,
          .cells = c.mpm.cells,
          .sizes = c.sample};
}

}  // namespace softgrain
