#include "softgrain/io/case/case_extension.hpp"

#include <fmt/core.h>

#include "softgrain/io/case/case_kinds.hpp"
#include "softgrain/io/case/case_stages.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/schema.hpp"

namespace softgrain {

namespace {

/// Is this limit further away than that one? 0: none.
bool is_further(double wanted, double begun) { return wanted == 0 || (begun != 0 && wanted >= begun); }

}  // namespace

std::string why_no_extension(const Case& begun, const Case& wanted) {
  bool end_moved = false;
  for (const Key& key : case_keys()) {
    if (value_in_si(begun, key) == value_in_si(wanted, key) || key.table() == "output") continue;
    const bool is_end = key.name == "loading.max_strain" || key.name == "loading.max_packing_fraction" ||
                        key.name == "loading.max_stress";
    if (!is_end)
      return fmt::format("{} was {}, not {}", key.name, written_value(begun, key),
                         written_value(wanted, key));
    end_moved = true;
  }
  if (kinds_text(begun) != kinds_text(wanted)) return "its kinds of grains were others";
  if (stages_text(begun) != stages_text(wanted)) return "its stages were others";
  const Case::Loading &before = begun.loading, &now = wanted.loading;
  if (now.max_strain < before.max_strain ||
      !is_further(now.max_packing_fraction, before.max_packing_fraction) ||
      !is_further(now.max_stress, before.max_stress))
    return "its end was further away";
  if (end_moved && before.hold > 0)
    return "at its end it rests for loading.hold, which another end would not have";
  return "";
}

std::string why_other_grains(const Case& begun, const Case& wanted) {
  for (const char* name :
       {"experiment.model", "experiment.dimension", "sample.grains", "mpm.cells", "mpm.formulation",
        "mpm.law", "bpm.primaries", "grain.shape", "grain.sides", "box.x", "box.y", "box.z"}) {
    const Key& key = *find_key(name);
    if (value_in_si(begun, key) != value_in_si(wanted, key))
      return fmt::format("{} was {}, not {}", name, written_value(begun, key), written_value(wanted, key));
  }
  return kinds_text(begun) != kinds_text(wanted) ? "its kinds of grains were others" : "";
}

}  // namespace softgrain
