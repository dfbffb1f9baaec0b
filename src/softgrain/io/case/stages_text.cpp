#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "softgrain/io/case/case_stages.hpp"
#include "softgrain/io/case/stage_words.hpp"
#include "softgrain/io/case/words.hpp"

// Stages as a case file or a JSON has them.

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Drive& drive) {
  if (drive.control == Control::rest) return "rest";
  Json json = Json::object();
  for (const Manner& manner : manners)
    if (manner.control == drive.control)
      json[manner.word] = drive.control == Control::strain ? drive.amplitude : drive.value;
  if (drive.speed > 0) json["speed"] = drive.speed;
  if (drive.control == Control::stress && drive.amplitude > 0) json["stress_amplitude"] = drive.amplitude;
  if (drive.amplitude > 0) json.update({{"period", drive.period}, {"wave", word_of(drive.wave)}});
  return json;
}

Json json_of(const Until& until, int dimension) {
  Json json = Json::object();
  const auto add = [&](const std::string& name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  };
  add("time", until.time);
  const auto strains = strain_words(dimension);
  for (std::size_t k = 0; k < strains.size(); ++k) add(strains[k], until.strain[k]);
  for (std::size_t p = 0; p < parts_with_stress; ++p) add(stress_word(p, dimension), until.stress[p]);
  add("packing_fraction", until.packing_fraction);
  add("overlap", until.overlap);
  add("rest", until.rest);
  return json;
}

Json json_of(const Stage& stage, int dimension) {
  Json json = Json::object();
  if (!stage.name.empty()) json["name"] = stage.name;
  for (const Drive& drive : stage.drives) json[std::string(name_of(drive.part, dimension))] = json_of(drive);
  json["until"] = json_of(stage.until, dimension);
  for (const Setting& setting : all_settings)
    if (const auto& value = stage.set.*setting.value) json["set"][setting.key] = *value;
  if (stage.repeat != 1) json["repeat"] = stage.repeat;
  if (!stage.repeat_from.empty()) json["repeat_from"] = stage.repeat_from;
  return json;
}

/// A number or text as TOML writes it too, a table on one line.
std::string toml_of(const Json& json) {
  if (!json.is_object()) return json.dump();
  std::vector<std::string> entries;
  for (const auto& [key, value] : json.items())
    entries.push_back(fmt::format("{} = {}", key, toml_of(value)));
  return fmt::format("{{ {} }}", fmt::join(entries, ", "));
}

}  // namespace

std::vector<std::string> keys_set_by_stages(const Case& the_case) {
  std::vector<std::string> keys;
  for (const Setting& setting : all_settings)
    for (const Stage& stage : the_case.stages)
      if (stage.set.*setting.value && (keys.empty() || keys.back() != setting.key))
        keys.emplace_back(setting.key);
  return keys;
}

std::string stages_text(const Case& the_case) {
  std::string text;
  for (const Stage& stage : the_case.stages) {
    text += "\n[[stage]]\n";
    const Json json = json_of(stage, the_case.experiment.dimension);
    for (const auto& [key, value] : json.items()) text += fmt::format("{} = {}\n", key, toml_of(value));
  }
  return text;
}

std::string stages_json(const Case& the_case) {
  Json list = Json::array();
  for (const Stage& stage : the_case.stages) list.push_back(json_of(stage, the_case.experiment.dimension));
  return list.dump();
}

}  // namespace softgrain
