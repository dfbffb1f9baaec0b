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

PartOfCase part_of(const Case& whole, GrainModel model) {
  PartOfCase part{.the_case = whole, .kinds = {}, .number = {}};
  Case& c = part.the_case;
  c.experiment.model = model;
  c.sample.grains = 0;
  c.kinds.clear();
  c.pairs.clear();
  for (const Case::Kind& kind : whole.kinds) {
    const bool here = (kind.model == GrainModel::mpm) == (model == GrainModel::mpm);
    part.number.push_back(here ? static_cast<int>(c.kinds.size()) : -1);
    if (!here) continue;
    part.kinds.push_back(static_cast<int>(part.number.size()) - 1);
    c.kinds.push_back(kind);
    c.sample.grains += kind.grains;
  }
  const auto number = [&](int kind) { return kind == Case::Pair::wall ? kind : part.number[kind]; };
  for (Case::Pair pair : whole.pairs) {
    const bool at_wall = pair.other == Case::Pair::wall;
    pair.kind = number(pair.kind);
    pair.other = number(pair.other);
    if (pair.kind >= 0 && (at_wall || pair.other >= 0)) c.pairs.push_back(pair);
  }
  return part;
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
