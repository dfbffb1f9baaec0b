#include "softgrain/io/case/case_schema.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "softgrain/io/case/case_forms.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/schema.hpp"
#include "softgrain/io/case/units.hpp"

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

void add_bounds(Json& number, const Range& range) {
  if (std::isfinite(range.low)) number[range.without_low ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) number[range.without_high ? "exclusiveMaximum" : "maximum"] = range.high;
}

/// A number in SI, or a text with a unit; which unit fits is checked by the program. Or the word for 0.
Json number_schema(const Key& key) {
  Json number{{"type", "number"}};
  add_bounds(number, key.range);
  const Json quantity{{"type", "string"},
                      {"pattern", R"(^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*[^\d\s].*$)"}};
  Json choices = Json::array({number, quantity});
  if (!key.zero_word.empty()) choices.push_back({{"const", key.zero_word}});
  return {{"anyOf", choices}};
}

Json value_schema(const Key& key) {
  if (std::holds_alternative<MemberOf<bool>>(key.member)) return {{"type", "boolean"}};
  if (const auto* enumerated = std::get_if<WordMember>(&key.member)) return {{"enum", enumerated->words()}};
  if (std::holds_alternative<MemberOf<double>>(key.member)) return number_schema(key);
  if (std::holds_alternative<MemberOf<std::vector<double>>>(key.member))
    return {{"type", "array"}, {"items", number_schema(key)}};
  if (std::holds_alternative<MemberOf<std::vector<PlacedGrain>>>(key.member))
    return {{"type", "array"}, {"items", {{"type", "array"}, {"items", {{"type", "number"}}}}}};
  if (std::holds_alternative<MemberOf<std::vector<OutlinePoint>>>(key.member))
    return {{"anyOf", Json::array({{{"type", "string"}},
                                   {{"type", "array"},
                                    {"items", {{"type", "array"}, {"items", {{"type", "number"}}}}}}})}};
  if (std::holds_alternative<MemberOf<TriangleMesh>>(key.member))
    return {{"anyOf", Json::array({{{"type", "string"}}, {{"type", "array"}}})}};
  Json whole{{"type", "integer"}};
  add_bounds(whole, key.range);
  return whole;
}

/// The keys of a table or of a table within it.
Json object_schema() {
  return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
}

/// Key{...} of a form that takes a number.
Key as_key(const FormKey& form) {
  return {form.name, MemberOf<double>(nullptr), form.unit, form.range, form.text};
}

/// "a stress, > 0 Pa".
std::string accepted(const FormKey& form) {
  if (form.takes == Takes::as_key) return accepted(*find_key(form.keys.front()));
  if (form.takes == Takes::number) return accepted(as_key(form));
  if (form.takes == Takes::text) return "a text";
  if (form.takes == Takes::texts) return "a list of two texts";
  return fmt::format("\"{}\"{}", fmt::join(form.words, "\", \""),
                     form.later.empty() ? "" : fmt::format("; later {}", fmt::join(form.later, ", ")));
}

Json form_value_schema(const FormKey& form) {
  Json value;
  if (form.takes == Takes::as_key) value = value_schema(*find_key(form.keys.front()));
  if (form.takes == Takes::number) value = number_schema(as_key(form));
  if (form.takes == Takes::text) value = {{"type", "string"}};
  if (form.takes == Takes::texts) value = {{"type", "array"}, {"items", {{"type", "string"}}}};
  if (form.takes == Takes::word) value = {{"enum", form.words}};
  value["description"] = fmt::format("{} ({})", form.text, accepted(form));
  return value;
}

/// Adds the forms whose names begin with `prefix.` to an object's properties.
void add_forms(Json& object, const std::string& prefix) {
  std::set<std::string> done;
  for (const FormKey& form : form_keys()) {
    if (!form.name.starts_with(prefix + ".")) continue;
    const std::string rest = form.name.substr(prefix.size() + 1), own = rest.substr(0, rest.find('.'));
    if (!done.insert(own).second) continue;
    const std::string name = fmt::format("{}.{}", prefix, own);
    Json inner = object_schema();
    add_forms(inner, name);
    const FormKey* whole = find_form(name);
    const bool has_inner = !inner["properties"].empty();
    object["properties"][own] = whole == nullptr ? inner
                                : has_inner ? Json{{"anyOf", Json::array({form_value_schema(*whole), inner})}}
                                            : form_value_schema(*whole);
  }
}

std::string reference_of_forms() {
  std::string text;
  for (const TableOfKeys& table : form_tables()) {
    text += fmt::format("\n## [[{}]]\n\n{}\n\n| key | takes | stands for | meaning |\n|---|---|---|---|\n",
                        table.name, table.text);
    for (const FormKey& form : form_keys()) {
      if (!form.name.starts_with(table.name + ".")) continue;
      text +=
          fmt::format("| `{}` | {} | {} | {} |\n", form.name.substr(table.name.size() + 1), accepted(form),
                      form.keys.empty() ? "" : fmt::format("`{}`", fmt::join(form.keys, "`, `")), form.text);
    }
  }
  return text;
}

constexpr std::string_view introduction =
    "# Case file: every key\n\n"
    "<!-- Written by `softgrain schema --markdown`; do not edit. -->\n\n"
    "A case is a TOML file. A quantity is written with its unit, as in `\"0.2 m/s\"`, or as a plain number "
    "in SI.\n"
    "A key that is left out keeps its default. In two dimensions everything is per metre of depth.\n\n"
    "The short form has one kind of grains and one path: `[grain]`, `[sample]`, `[contact]`, `[loading]`. "
    "The long\n"
    "form says the same with `[[kind]]`, `[[pair]]` and `[[stage]]`, at the end of this page, and more: "
    "several kinds and\n"
    "stages of one's own. A run writes every value to its `case.toml`, of one kind in the short form.\n";

constexpr std::string_view sample_files =
    "\n## The file of a sample\n\n"
    "`sample.file` names a table of grains, for both models. Values stand between commas. The first line "
    "names\n"
    "the columns and, in brackets, their units; without brackets they are in SI:\n\n"
    "```\n# three grains\nx [mm], y [mm], radius [mm], angle [deg], kind\n1.0, 1.0, 1.0, 0, copper\n"
    "3.1, 1.2, 0.9, 45, copper\n2.0, 2.9, 1.0, 0, copper\n```\n\n"
    "`x`, `y` and `radius` must be there. `angle` turns a grain and is 0 where it is left out. `kind` is the "
    "name of\n"
    "the `[[kind]]`; of several kinds the column must be there.\nLines that begin with `#` are skipped. "
    "Columns stand in any order.\n\n"
    "The box has its corner at (0, 0), and `box.width` and `box.height`. A side that the case leaves out is "
    "that of\n"
    "the bounding box of all grains, and all grains are moved along it so that the first touches the wall at "
    "0.\n"
    "A grain may reach out of the box by 1 % of its radius, and overlap another by 1 % of the smaller "
    "radius.\n"
    "A file holds at most 10 000 grains. The run keeps them in its `case.toml` as `sample.placed`, so that "
    "it needs\n"
    "the file no more.\n";

constexpr std::string_view outline_files =
    "\n## The file of an outline\n\n"
    "`grain.outline` and `kind.outline` name a table of points in their order along a closed outline, in any "
    "unit:\n\n"
    "```\nx, y, corner\n1.414, 0, 1\n0.707, 0.707, 0\n0.5, 0.866, 0\n```\n\n"
    "`x` and `y` must be there. `corner` is 1 where the outline has a corner, and 0 where it is smooth; "
    "without that\n"
    "column a corner is where the polygon of the points turns by more than 30 degrees. The first point may "
    "stand\n"
    "again at the end. The grain's diameter is that of the circle about its centre of area that holds it. "
    "The "
    "run\n"
    "keeps the points in its `case.toml`.\n";

constexpr std::string_view surface_files =
    "\n## The file of a surface\n\n"
    "`grain.surface` and `kind.surface` name an STL or PLY file, text or binary, in any unit, with a closed "
    "surface of "
    "at\n"
    "most 10 000 triangles. Each point of it must be seen from its centre of mass. The grain's diameter is "
    "that of the "
    "sphere\n"
    "about that centre that holds it; its axes are those of the file before the grain is turned. The run "
    "keeps "
    "vertices and\n"
    "triangles in its `case.toml`. What is wrong is told with the line of the file, or its byte.\n";

constexpr std::string_view stages =
    "\nStages follow one another. Compression is positive, and strain counts from the start of the run. Of "
    "each\n"
    "part a stage says one of `velocity`, `rate`, `stress`, `strain_amplitude` and `\"rest\"`. The first end "
    "that\n"
    "holds ends it. [The guide of loading](../guide/loading.md) has examples.\n";

}  // namespace

std::string case_json_schema() {
  Json tables = Json::object();
  for_each_key(
      [&](const TableOfKeys& table) {
        tables[table.name] = object_schema();
        tables[table.name]["description"] = table.text;
      },
      [&](const Key& key) {
        Json value = value_schema(key);
        value["description"] = fmt::format("{} ({})", key.text, accepted(key));
        value["default"] = Json::parse(written_value(Case{}, key));
        tables[key.table()]["properties"][key.short_name()] = value;
      });
  for (const TableOfKeys& table : case_tables()) add_forms(tables[table.name], table.name);
  for (const OldKey& old : old_keys()) {
    const auto dot = old.name.find('.');
    tables[old.name.substr(0, dot)]["properties"][old.name.substr(dot + 1)] = {
        {"deprecated", true}, {"description", "an old name: write " + old.now}};
  }
  for (const TableOfKeys& table : form_tables()) {
    Json items = object_schema();
    add_forms(items, table.name);
    tables[table.name] = {{"type", "array"}, {"description", table.text}, {"items", items}};
  }
  const Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                    {"title", "softgrain case"},
                    {"type", "object"},
                    {"additionalProperties", false},
                    {"properties", tables}};
  return schema.dump(2) + "\n";
}

std::string case_reference_page() {
  std::string text(introduction), table_of_forms;
  const auto add_forms_of = [&](const std::string& table) {
    for (const FormKey& form : form_keys())
      if (form.name.starts_with(table + "."))
        text += fmt::format("| `{}` | {} | | {} |\n", form.name.substr(table.size() + 1), accepted(form),
                            form.text);
  };
  for_each_key(
      [&](const TableOfKeys& table) {
        if (!table_of_forms.empty()) add_forms_of(table_of_forms);
        table_of_forms = table.name;
        text += fmt::format("\n## [{}]\n\n{}\n\n| key | takes | default | meaning |\n|---|---|---|---|\n",
                            table.name, table.text);
      },
      [&](const Key& key) {
        text += fmt::format("| `{}` | {} | `{}` | {} |\n", key.short_name(), accepted(key),
                            written_value(Case{}, key), key.text);
      });
  add_forms_of(table_of_forms);
  return text + std::string(sample_files) + std::string(outline_files) + std::string(surface_files) +
         reference_of_forms() + std::string(stages);
}

}  // namespace softgrain
