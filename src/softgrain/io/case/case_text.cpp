#include "softgrain/io/case/case_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

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
                 if (!the_case.kinds.empty() && is_key_of_kind(key.name)) return;
                 const std::string unit = si_unit_of(key);
                 text += fmt::format("{} = {}{}\n", key.short_name(), si_value(the_case, key),
                                     unit.empty() ? "" : "  # " + unit);
               });
  return text + kinds_text(the_case) + stages_text(the_case);
}

std::string case_json(const Case& the_case) {
  Json tables = Json::object();
  for_each_key(
      [&](const TableOfKeys& table) { tables[table.name] = Json::object(); },
      [&](const Key& key) { tables[key.table()][key.short_name()] = Json::parse(si_value(the_case, key)); });
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
      {"diametral-bpm", "one grain of rigid primary particles between two walls", diametral(GrainModel::bpm)},
      {"diametral-mpm", "one elastic grain between two walls", diametral(GrainModel::mpm)},
      {"compaction-bpm", "25 grains of 200 primary particles in a box whose top wall comes down",
       compaction(GrainModel::bpm), std::string(more_grains)},
      {"compaction-mpm", "25 elastic grains in a box whose top wall comes down", compaction(GrainModel::mpm),
       std::string(more_grains)},
  };
  return templates;
}

}  // namespace softgrain
