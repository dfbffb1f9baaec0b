#include "softgrain/io/case/case_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "softgrain/experiment/kinds.hpp"
#include "softgrain/io/case/case_forms.hpp"
#include "softgrain/io/case/case_value.hpp"
#include "softgrain/io/case/words.hpp"

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

/// Keys that act on one grain alone, which has no kinds.
bool is_between_walls(const std::string& key) { return key == "bpm.attraction" || key == "bpm.force"; }

/// Keys of a kind, each with the one key of the schema for which it stands. kind.model is that of all kinds,
/// and kind.diameter stands for two that have keys of their own.
const std::vector<FormKey>& written_keys() {
  static const std::vector<FormKey> keys = [] {
    std::vector<FormKey> written;
    for (const FormKey& form : form_keys())
      if (form.name.starts_with("kind.") && form.takes == Takes::as_key && form.keys.size() == 1 &&
          form.name != "kind.model" && !is_between_walls(form.keys.front()))
        written.push_back(form);
    return written;
  }();
  return keys;
}

/// "law.young_modulus".
std::string name_within(const FormKey& form) { return form.name.substr(std::string_view("kind.").size()); }

bool is_of_shape(const std::string& key) {
  return key == "grain.shape" || key == "grain.aspect" || key == "grain.sides";
}

/// Does a kind of the case have such a key? Rigid grains among bonded ones are disks without vertices.
bool is_written(const Case& c, const Case& kind, const std::string& key) {
  if (has_bonded(c) && is_rigid(kind) && (is_of_shape(key) || key == "mpm.cells")) return false;
  if (key == "grain.surface") return kind.grain.shape == ShapeOfGrain::surface;
  if (key == "grain.outline") return kind.grain.shape == ShapeOfGrain::outline;
  if (key.starts_with(is_bonded(kind) ? "mpm." : "bpm.")) return false;
  if (is_rigid(kind)) return !key.starts_with("mpm.") || key == "mpm.cells";
  return !is_of_shape(key) || kind.grain.shape != ShapeOfGrain::disk;
}

/// visit(name, value) of all keys of the k-th kind. Of placed grains their places say number and diameters.
template <class Visit>
void for_each_value(const Case& c, int k, const Visit& visit) {
  const Case kind = case_of_kind(c, k);
  if (const GrainModel model = kind.experiment.model; is_rigid(kind) || model != c.experiment.model)
    visit("model", fmt::format("\"{}\"", word_of(model)));
  for (const FormKey& form : written_keys()) {
    const std::string& key = form.keys.front();
    if (is_written(c, kind, key) && (c.sample.placed.empty() || !key.starts_with("sample.")))
      visit(name_within(form), value_in_si(kind, *find_key(key)));
  }
}

/// visit(name, value) of what a pair says.
template <class Visit>
void for_each_number(const Case::Pair& pair, const Visit& visit) {
  if (pair.friction) visit("friction", *pair.friction);
  if (pair.surface_energy) visit("surface_energy", *pair.surface_energy);
  if (pair.adhesion_range) visit("adhesion_range", *pair.adhesion_range);
}

std::string side_of(const Case& c, int kind) {
  return kind == Case::Pair::wall ? "wall" : c.kinds[kind].name;
}

}  // namespace

bool is_key_of_kind(const Case& c, const std::string& name) {
  if (!is_mixed(c) && name.starts_with(is_bonded(c) ? "mpm." : "bpm.")) return false;
  return std::ranges::any_of(written_keys(), [&](const FormKey& form) { return form.keys.front() == name; });
}

std::string kinds_text(const Case& c) {
  std::string text;
  for (int k = 0; k < static_cast<int>(c.kinds.size()); ++k) {
    text += fmt::format("\n[[kind]]\nname = {}\n", Json(c.kinds[k].name).dump());
    for_each_value(c, k, [&](const std::string& name, const std::string& value) {
      text += fmt::format("{} = {}\n", name, value);
    });
  }
  for (const Case::Pair& pair : c.pairs) {
    text += fmt::format("\n[[pair]]\nbetween = [{}, {}]\n", Json(side_of(c, pair.kind)).dump(),
                        Json(side_of(c, pair.other)).dump());
    for_each_number(pair,
                    [&](const char* name, double value) { text += fmt::format("{} = {}\n", name, value); });
  }
  return text;
}

std::string kinds_json(const Case& c) {
  Json json = Json::object();
  for (int k = 0; k < static_cast<int>(c.kinds.size()); ++k) {
    Json kind{{"name", c.kinds[k].name}};
    for_each_value(c, k, [&](const std::string& name, const std::string& value) {
      const auto dot = name.find('.');
      (dot == std::string::npos ? kind[name] : kind[name.substr(0, dot)][name.substr(dot + 1)]) =
          Json::parse(value);
    });
    json["kind"].push_back(kind);
  }
  for (const Case::Pair& pair : c.pairs) {
    Json one{{"between", {side_of(c, pair.kind), side_of(c, pair.other)}}};
    for_each_number(pair, [&](const char* name, double value) { one[name] = value; });
    json["pair"].push_back(one);
  }
  return json.dump();
}

}  // namespace softgrain
