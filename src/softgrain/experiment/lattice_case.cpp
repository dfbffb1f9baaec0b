#include "softgrain/experiment/lattice_case.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace softgrain {
namespace {

bool keeps_a_stress(const Stage& stage) {
  return std::any_of(stage.drives.begin(), stage.drives.end(),
                     [](const Drive& drive) { return drive.control == Control::stress; });
}

}  // namespace

std::string lattice_cannot(const Case& c) {
  if (!is_lattice(c)) return "";
  const auto cannot = [](std::string_view what) {
    return fmt::format("mpm.formulation \"updated_lagrangian\" {}", what);
  };
  if (c.box.x == BoxEnd::periodic || c.box.y == BoxEnd::periodic)
    return cannot("needs walls: leave out box.x and box.y \"periodic\"");
  if (!c.kinds.empty()) return cannot("takes grains of one material: leave out [[kind]]");
  switch (c.experiment.loading) {
    case LoadingPath::biaxial:
    case LoadingPath::triaxial:
    case LoadingPath::shear:
    case LoadingPath::die:
      return cannot(
          "moves walls at given speeds, none that keeps a stress: it needs experiment.loading \"diametral\", "
          "\"compaction\", \"isotropic\", \"relaxation\" or tables [[stage]] without stress");
    default:
      break;
  }
  if (c.loading.hold_stress > 0)
    return cannot(
        "has no walls that keep a stress: leave out loading.hold_stress, and end at loading.max_stress");
  if (std::any_of(c.stages.begin(), c.stages.end(), keeps_a_stress))
    return cannot("has no walls that keep a stress: a [[stage]] gives them a velocity or a rate");
  return "";
}

}  // namespace softgrain
