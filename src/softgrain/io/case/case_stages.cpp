#include "softgrain/io/case/case_stages.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/loading/stage.hpp"

namespace softgrain {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array parts{Part::yy, Part::xx, Part::bottom, Part::top, Part::left, Part::right, Part::xy};

/// What a part may do, in the words of a file.
struct Manner {
  const char* word;
  Control control;
};
constexpr std::array manners{Manner{"velocity", Control::velocity}, Manner{"rate", Control::rate},
                             Manner{"stress", Control::stress}, Manner{"strain_amplitude", Control::strain}};

/// What a stage may set, by the names of the keys.
struct Setting {
  const char* key;
  std::optional<double> Settings::*value;
};
constexpr std::array all_settings{Setting{"contact.friction", &Settings::friction},
                                  Setting{"contact.wall_friction", &Settings::wall_friction},
                                  Setting{"solver.tolerance", &Settings::solver_tolerance},
                                  Setting{"mpm.tolerance", &Settings::newton_tolerance},
                                  Setting{"mpm.damping", &Settings::damping}};

/// What is wrong with a stage, and where.
struct StageFault {
  Origin at;
  std::string what;
};

/// Where anything is said of a part first.
Origin place_of(const StageText& text, const std::string& name) {
  for (const auto& [key, value] : text.numbers)
    if (key.starts_with(name + ".")) return value.second;
  const auto word = text.words.find(name);
  return word == text.words.end() ? text.at : word->second.second;
}

/// What needs something else beside it.
void check_company(const StageText& text, const std::string& name, const Drive& drive) {
  const auto fault = [&](const char* key, const char* needed) {
    throw StageFault{place_of(text, name), fmt::format("{}.{} needs {}", name, key, needed)};
  };
  const bool keeps = drive.control == Control::stress, swings = drive.amplitude > 0;
  if (text.number(name + ".speed") && !keeps) fault("speed", "stress: the one that the walls keep");
  if (text.number(name + ".stress_amplitude") && !keeps)
    fault("stress_amplitude", "stress: the one about which it swings");
  if (text.number(name + ".period") && !swings) fault("period", "strain_amplitude, or stress_amplitude");
  if (!text.word(name + ".wave").empty() && !swings) fault("wave", "strain_amplitude, or stress_amplitude");
}

/// Nothing where the stage says nothing of the part.
std::optional<Drive> drive_of(const StageText& text, Part part) {
  const std::string name = fmt::format("stage.{}", name_of(part));
  std::vector<std::string> said;
  Drive drive{.part = part};
  for (const Manner& manner : manners)
    if (const auto value = text.number(fmt::format("{}.{}", name, manner.word))) {
      said.push_back(manner.word);
      drive.control = manner.control;
      (manner.control == Control::strain ? drive.amplitude : drive.value) = *value;
    }
  if (const std::string word = text.word(name); !word.empty()) {
    said.push_back(fmt::format("\"{}\"", word));
    drive.quasi_static = word != "rest";
    if (drive.quasi_static) drive.control = Control::rate, drive.value = 1;  // until the sample is known
  }
  if (said.size() > 1)
    throw StageFault{
        place_of(text, name),
        fmt::format(
            "{} takes one of velocity, rate, stress, strain_amplitude, \"quasi-static\" and \"rest\"; got {}",
            name, fmt::join(said, " and "))};
  if (const auto amplitude = text.number(name + ".stress_amplitude")) drive.amplitude = *amplitude;
  drive.period = text.number(name + ".period").value_or(0);
  drive.speed = text.number(name + ".speed").value_or(0);
  check_company(text, name, drive);
  drive.wave = value_of<Wave>(text.word(name + ".wave")).value_or(Wave::sine);
  return said.empty() ? std::nullopt : std::optional(drive);
}

std::string stress_word(std::size_t part) {
  return fmt::format("stress_{}", name_of(static_cast<Part>(part)));
}

Until until_of(const StageText& text) {
  const auto number = [&](const std::string& name) { return text.number("stage.until." + name); };
  Until until{.time = number("time")};
  until.strain = {number("strain"), number("strain_xx"), number("strain_xy")};
  for (std::size_t p = 0; p < parts_with_stress; ++p) until.stress[p] = number(stress_word(p));
  until.packing_fraction = number("packing_fraction");
  until.overlap = number("overlap");
  until.rest = number("rest");
  return until;
}

int repeat_of(const StageText& text) {
  const auto repeat = text.number("stage.repeat");
  if (!repeat) return 1;
  if (*repeat != std::floor(*repeat) || *repeat > 1e5)
    throw StageFault{text.numbers.at("stage.repeat").second,
                     fmt::format("stage.repeat takes a whole number up to 100000, got {}", *repeat)};
  return static_cast<int>(*repeat);
}

Stage stage_of(const StageText& text) {
  Stage stage{.name = text.word("stage.name"), .until = until_of(text)};
  for (const Part part : parts)
    if (const auto drive = drive_of(text, part)) stage.drives.push_back(*drive);
  for (const Setting& setting : all_settings)
    stage.set.*setting.value = text.number(fmt::format("stage.set.{}", setting.key));
  stage.repeat = repeat_of(text);
  stage.repeat_from = text.word("stage.repeat_from");
  return stage;
}

/// Between two walls, one grain takes what needs no sides of a box.
bool fits_one_grain(const Stage& stage) {
  const Until& until = stage.until;
  for (const Drive& drive : stage.drives)
    if (axis_of(drive.part) == 0 || (drive.control != Control::velocity && drive.control != Control::rest))
      return false;
  for (const auto& stress : until.stress)
    if (stress) return false;
  return !until.strain[1] && !until.strain[2] && !until.packing_fraction;
}

/// What a stage asks of walls or of a cell that the box does not have; "" if nothing.
std::string missing_in(const Case& c, const Stage& stage) {
  const auto repeats = repeats_of(c);
  const auto is_missing = [&](Part part) -> std::string {
    if (part == Part::xy)
      return repeats[0] && repeats[1] ? "" : "xy shears a cell: it needs box.x and box.y \"periodic\"";
    const auto axis = static_cast<std::size_t>(axis_of(part));
    if (part == Part::yy || part == Part::xx || !repeats[axis]) return "";
    return fmt::format("box.{} is \"periodic\", there is no {} wall: write {}", axis == 0 ? "x" : "y",
                       name_of(part), axis == 0 ? "xx" : "yy");
  };
  for (const Drive& drive : stage.drives)
    if (std::string what = is_missing(drive.part); !what.empty()) return what;
  for (std::size_t p = 0; p < parts_with_stress; ++p)
    if (stage.until.stress[p])
      if (std::string what = is_missing(static_cast<Part>(p)); !what.empty()) return what;
  return stage.until.strain[2] ? is_missing(Part::xy) : "";
}

void check_stage(const Stage& stage, const StageText& text, const CaseDraft& draft) {
  if (const std::string fault = fault_of(stage); !fault.empty())
    throw StageFault{text.at, "[[stage]]: " + fault};
  if (const std::string missing = missing_in(draft.the_case, stage); !missing.empty())
    throw StageFault{text.at, "[[stage]]: " + missing};
  if (draft.the_case.experiment.loading == LoadingPath::diametral && !fits_one_grain(stage))
    throw StageFault{text.at,
                     "[[stage]]: one grain between two walls (experiment.loading = \"diametral\") takes "
                     "velocity and \"rest\" of yy, top and bottom until a time, strain, overlap or rest; for "
                     "all else write experiment.loading = \"stages\""};
}

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

Json json_of(const Until& until) {
  Json json = Json::object();
  const auto add = [&](const std::string& name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  };
  add("time", until.time);
  add("strain", until.strain[0]);
  add("strain_xx", until.strain[1]);
  add("strain_xy", until.strain[2]);
  for (std::size_t p = 0; p < parts_with_stress; ++p) add(stress_word(p), until.stress[p]);
  add("packing_fraction", until.packing_fraction);
  add("overlap", until.overlap);
  add("rest", until.rest);
  return json;
}

Json json_of(const Stage& stage) {
  Json json = Json::object();
  if (!stage.name.empty()) json["name"] = stage.name;
  for (const Drive& drive : stage.drives) json[std::string(name_of(drive.part))] = json_of(drive);
  json["until"] = json_of(stage.until);
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

std::optional<double> StageText::number(const std::string& name) const {
  const auto found = numbers.find(name);
  return found == numbers.end() ? std::nullopt : std::optional(found->second.first);
}

std::string StageText::word(const std::string& name) const {
  const auto found = words.find(name);
  return found == words.end() ? "" : found->second.first;
}

void read_stages(const std::vector<StageText>& texts, CaseDraft& draft) {
  Case& c = draft.the_case;
  if (!draft.origins.contains("experiment.loading")) c.experiment.loading = LoadingPath::stages;
  for (const StageText& text : texts) {
    try {
      c.stages.push_back(stage_of(text));
      check_stage(c.stages.back(), text, draft);
      without_repeats(c.stages);
    } catch (const StageFault& fault) {
      draft.add(fault.at, fault.what);
    } catch (const UsageError& error) {
      draft.add(text.at, fmt::format("[[stage]]: {}", error.what()));
      c.stages.back().repeat_from.clear();  // what comes next is checked without it
      return;
    }
  }
}

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
    const Json json = json_of(stage);
    for (const auto& [key, value] : json.items()) text += fmt::format("{} = {}\n", key, toml_of(value));
  }
  return text;
}

std::string stages_json(const Case& the_case) {
  Json list = Json::array();
  for (const Stage& stage : the_case.stages) list.push_back(json_of(stage));
  return list.dump();
}

}  // namespace softgrain
