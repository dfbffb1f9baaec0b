#include "softgrain/io/case_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "softgrain/io/case_value.hpp"
#include "softgrain/io/schema.hpp"
#include "softgrain/io/units.hpp"

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

/// Calls `on_table` for each table and `on_key` for each of its keys.
template <class OnTable, class OnKey>
void for_each_key(const OnTable& on_table, const OnKey& on_key) {
  for (const TableOfKeys& table : case_tables()) {
    on_table(table);
    for (const Key& key : case_keys())
      if (key.table() == table.name) on_key(key);
  }
}

std::string si_unit_of(const Key& key) { return si_unit(parse_unit(key.unit).dimension); }

/// "a length, > 0"; words and switches need no range.
std::string accepted(const Key& key) {
  const std::string range = key.range.text();
  return kind_in_words(key) + (range.empty() ? "" : ", " + range) +
         (range.empty() || key.unit.empty() ? "" : " " + si_unit_of(key));
}

void add_bounds(Json& number, const Range& range) {
  if (std::isfinite(range.low)) number[range.without_low ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) number[range.without_high ? "exclusiveMaximum" : "maximum"] = range.high;
}

/// A number in SI, or a text with a unit; which unit fits is checked by the program.
Json number_schema(const Key& key) {
  Json number{{"type", "number"}};
  add_bounds(number, key.range);
  const Json quantity{{"type", "string"},
                      {"pattern", R"(^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*[^\d\s].*$)"}};
  return {{"anyOf", Json::array({number, quantity})}};
}

Json value_schema(const Key& key) {
  if (std::holds_alternative<MemberOf<bool>>(key.member)) return {{"type", "boolean"}};
  if (const auto* enumerated = std::get_if<WordMember>(&key.member)) return {{"enum", enumerated->words()}};
  if (std::holds_alternative<MemberOf<double>>(key.member)) return number_schema(key);
  if (std::holds_alternative<MemberOf<std::vector<double>>>(key.member))
    return {{"type", "array"}, {"items", number_schema(key)}};
  Json whole{{"type", "integer"}};
  add_bounds(whole, key.range);
  return whole;
}

/// One grain of the paper, unloaded at its two strains.
Case diametral(GrainModel model) {
  Case c;
  c.experiment.model = model;
  c.loading.unload_at = {0.1, 0.3};
  return c;
}

/// Grains, speed and packing fraction of the paper's packings.
Case compaction(GrainModel model) {
  Case c;
  c.experiment = {.loading = LoadingPath::compaction, .model = model};
  c.sample.grains = 300;
  c.loading.wall_velocity = 5;
  c.loading.max_strain = model == GrainModel::mpm ? 0.3 : 0.42;
  if (model == GrainModel::mpm) return c;
  c.loading.max_stress = 5e6;  // ten times the cohesive pressure: close packed
  c.bpm.primaries = 200;
  c.time.step = 0.1e-6;
  return c;
}

}  // namespace

std::string resolved_case_text(const Case& the_case) {
  std::string text = "# Resolved case: every default filled in, SI units.\n";
  for_each_key([&](const TableOfKeys& table) { text += fmt::format("\n[{}]\n", table.name); },
               [&](const Key& key) {
                 const std::string unit = si_unit_of(key);
                 text += fmt::format("{} = {}{}\n", key.short_name(), si_value(the_case, key),
                                     unit.empty() ? "" : "  # " + unit);
               });
  return text;
}

std::string case_json(const Case& the_case) {
  Json tables = Json::object();
  for_each_key(
      [&](const TableOfKeys& table) { tables[table.name] = Json::object(); },
      [&](const Key& key) { tables[key.table()][key.short_name()] = Json::parse(si_value(the_case, key)); });
  return tables.dump(2);
}

std::string commented_case_text(const Case& the_case) {
  std::string text =
      "# A softgrain case. Quantities are written with their unit, or as plain numbers in SI. What is left "
      "out keeps its\n"
      "# default. Check it with `softgrain check`, run it with `softgrain run`. 2D: per metre of depth.\n";
  for_each_key(
      [&](const TableOfKeys& table) { text += fmt::format("\n# {}\n[{}]\n", table.text, table.name); },
      [&](const Key& key) {
        text += fmt::format("# {} ({})\n{} = {}\n", key.text, accepted(key), key.short_name(),
                            written_value(the_case, key));
      });
  return text;
}

std::string case_json_schema() {
  Json tables = Json::object();
  for_each_key(
      [&](const TableOfKeys& table) {
        tables[table.name] = {{"type", "object"},
                              {"description", table.text},
                              {"additionalProperties", false},
                              {"properties", Json::object()}};
      },
      [&](const Key& key) {
        Json value = value_schema(key);
        value["description"] = fmt::format("{} ({})", key.text, accepted(key));
        value["default"] = Json::parse(written_value(Case{}, key));
        tables[key.table()]["properties"][key.short_name()] = value;
      });
  const Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"title", "softgrain case"},
                    {"type", "object"},
                    {"additionalProperties", false},
                    {"properties", tables}};
  return schema.dump(2) + "\n";
}

std::string case_reference_page() {
  std::string text =
      "# Case file: every key\n\n"
      "<!-- Written by `softgrain schema --markdown`; do not edit. -->\n\n"
      "A case is a TOML file. A quantity is written with its unit, as in `\"0.2 m/s\"`, or as a plain number "
      "in SI. A key\n"
      "that is left out keeps its default. Everything is two-dimensional, per metre of depth.\n";
  for_each_key(
      [&](const TableOfKeys& table) {
        text += fmt::format("\n## [{}]\n\n{}\n\n| key | takes | default | meaning |\n|---|---|---|---|\n",
                            table.name, table.text);
      },
      [&](const Key& key) {
        text += fmt::format("| `{}` | {} | `{}` | {} |\n", key.short_name(), accepted(key),
                            written_value(Case{}, key), key.text);
      });
  return text;
}

const std::vector<CaseTemplate>& case_templates() {
  static const std::vector<CaseTemplate> templates{
      {"diametral-bpm", "one grain of rigid primary particles between two plates",
       diametral(GrainModel::bpm)},
      {"diametral-mpm", "one elastic grain between two plates", diametral(GrainModel::mpm)},
      {"compaction-bpm", "300 grains of 200 primary particles in a box whose lid comes down",
       compaction(GrainModel::bpm)},
      {"compaction-mpm", "300 elastic grains in a box whose lid comes down", compaction(GrainModel::mpm)},
  };
  return templates;
}

}  // namespace softgrain
