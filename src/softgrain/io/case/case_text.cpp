#include "softgrain/io/case/case_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_kinds.hpp"
#include "softgrain/io/case/case_stages.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/schema.hpp"

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

/// One grain of the paper, unloaded at its two strains.
Case diametral(GrainModel model) {
  Case c;
  c.experiment.model = model;
  c.loading.unload_at = {0.1, 0.3};
  return c;
}

/// Speed and packing fraction of the paper's packings, fewer grains.
Case compaction(GrainModel model) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = model};
  c.sample.grains = 25;
  c.loading.wall_velocity = 5;
  c.loading.max_strain = model == GrainModel::mpm ? 0.3 : 0.42;
  if (model == GrainModel::mpm) return c;
  c.loading.max_stress = 5e6;  // ten times the cohesive pressure: close packed
  c.bpm.primaries = 200;
  c.time.step = 0.1e-6;
  return c;
}

/// 25 elastic grains of coarse grids with friction, and what `path` says.
Case elastic_grains(const std::string& path) {
  return parse_case(R"(
experiment.model = "mpm"
mpm.cells = 6
sample.grains = 25
contact.friction = 0.3
)" + path,
                    "template");
}

Case shear() {
  return elastic_grains(R"(
experiment.loading = "shear"
box = { x = "periodic", y = "periodic" }
loading = { wall_velocity = 0.2, confining_stress = 1e5, max_strain = 0.4, hold = 0.02, shear_rate = 5, max_shear = 0.5 }
)");
}

/// Elastic grains to 0.5 MPa; plastic ones to three times their yield stress.
Case die(bool plastic) {
  return elastic_grains(std::string(R"(
experiment.loading = "die"
contact.wall_friction = 0.3
loading = { wall_velocity = 0.05, max_strain = 0.5, hold = 2e-3, eject = true, max_stress = )") +
                        (plastic ? R"(3e5 }
mpm.law = "von_mises"
mpm.poisson_ratio = 0.3
mpm.yield_stress = 1e5
mpm.tolerance = 3e-5
)"
                                 : "5e5 }\n"));
}

Case sphere() {
  return parse_case(R"(
experiment = { model = "mpm", dimension = 3 }
grain.radius = 1e-3
mpm.cells = 6
loading = { wall_velocity = 1, max_strain = 0.3, unload_at = [] }
)",
                    "template");
}

Case spheres() {
  return parse_case(R"(
experiment = { model = "mpm", dimension = 3, loading = "isotropic" }
mpm.cells = 4
sample = { grains = 27, packing_fraction = 0.45 }
loading = { wall_velocity = 3, max_strain = 0.24 }
)",
                    "template");
}

/// How to go from a template to the paper's packings.
constexpr std::string_view more_grains =
    "# 25 grains show how a packing behaves, in seconds. Statistics of forces and contacts need the 300 of "
    "the paper:\n"
    "# write grains = 300 below. `softgrain check` says first how long that takes and how much disk it "
    "needs.\n";

}  // namespace

std::string resolved_case_text(const Case& the_case) {
  std::string text = "# Resolved case: every default filled in, SI units.\n";
  for_each_key([&](const TableOfKeys& table) { text += fmt::format("\n[{}]\n", table.name); },
               [&](const Key& key) {
                 if (!the_case.kinds.empty() && is_key_of_kind(the_case, key.name)) return;
                 const std::string unit = si_unit_of(key);
                 text += fmt::format("{} = {}{}\n", key.short_name(), value_in_si(the_case, key),
                                     unit.empty() ? "" : "  # " + unit);
               });
  return text + kinds_text(the_case) + stages_text(the_case);
}

std::string case_json(const Case& the_case) {
  Json tables = Json::object();
  for_each_key([&](const TableOfKeys& table) { tables[table.name] = Json::object(); },
               [&](const Key& key) {
                 tables[key.table()][key.short_name()] = Json::parse(value_in_si(the_case, key));
               });
  tables.update(Json::parse(kinds_json(the_case)));
  if (!the_case.stages.empty()) tables["stage"] = Json::parse(stages_json(the_case));
  return tables.dump(2);
}

std::string commented_case_text(const Case& the_case, Keys keys, std::string_view advice) {
  std::string text =
      "#:schema ./case.schema.json\n"
      "# A softgrain case. Quantities are written with their unit, or as plain numbers in SI. What is left "
      "out keeps its\n"
      "# default. Check it with `softgrain check`, run it with `softgrain run`. 2D: per metre of depth.\n";
  text += advice;
  std::string heading;
  for_each_key(
      [&](const TableOfKeys& table) { heading = fmt::format("\n# {}\n[{}]\n", table.text, table.name); },
      [&](const Key& key) {
        if (keys == Keys::that_act && !key.acts.covers(the_case)) return;
        text += std::exchange(heading, "");
        text += fmt::format("# {} ({})\n{} = {}\n", key.text, accepted(key), key.short_name(),
                            written_value(the_case, key));
      });
  return text + stages_text(the_case);
}

const std::vector<CaseTemplate>& case_templates() {
  static const std::vector<CaseTemplate> templates{
      {"diametral-bpm", "one grain of rigid primary particles between two walls",
       [] { return diametral(GrainModel::bpm); }},
      {"diametral-mpm", "one elastic grain between two walls", [] { return diametral(GrainModel::mpm); }},
      {"compaction-bpm", "25 grains of 200 primary particles in a box whose top wall comes down",
       [] { return compaction(GrainModel::bpm); }, std::string(more_grains)},
      {"compaction-mpm", "25 elastic grains in a box whose top wall comes down",
       [] { return compaction(GrainModel::mpm); }, std::string(more_grains)},
      {"shear-mpm", "25 elastic grains in a periodic cell: compressed to a stress, then sheared under it",
       shear},
      {"die-mpm", "25 elastic grains in a die: pressed to a stress, held, unloaded, ejected",
       [] { return die(false); }},
      {"tablet-mpm", "the same of plastic grains, which stay dense: a tablet", [] { return die(true); }},
      {"sphere-mpm", "one elastic sphere between two walls, in space", sphere},
      {"spheres-mpm", "27 elastic spheres in a box whose six walls come in", spheres},
  };
  return templates;
}

}  // namespace softgrain
