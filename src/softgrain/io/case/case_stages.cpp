#include "softgrain/io/case/case_stages.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/io/case/stage_words.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/loading/stage.hpp"

namespace softgrain {
namespace {

constexpr std::array parts{Part::yy, Part::xx, Part::bottom, Part::top, Part::left, Part::right, Part::xy};

/// Words of a part or of an end of a stage that a box of this dimension does not have.
struct ForeignWord {
  int dimension;
  const char *part, *stress, *strain;  // strain: of the component, where it is one
  const char* remedy;
};
constexpr const char* pairs_alone = "in space side walls move in pairs, xx and yy, and no cell shears yet";
constexpr std::array foreign_words{
    ForeignWord{
        2, "zz", "stress_zz", "strain_yy",
        "zz belongs to experiment.dimension = 3; in the plane yy is the vertical component, and strain "
        "its strain"},
    ForeignWord{3, "xy", "stress_xy", "strain_xy", pairs_alone},
    ForeignWord{3, "left", "stress_left", "", pairs_alone},
    ForeignWord{3, "right", "stress_right", "", pairs_alone}};

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
std::optional<Drive> drive_of(const StageText& text, Part part, int dimension) {
  const std::string name = fmt::format("stage.{}", name_of(part, dimension));
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

void refuse_foreign_words(const StageText& text, int dimension) {
  const auto refuse_key = [&](const Origin& at, const char* remedy) {
    throw StageFault{at, fmt::format("[[stage]]: {}", remedy)};
  };
  for (const ForeignWord& foreign : foreign_words) {
    if (foreign.dimension != dimension) continue;
    const std::string part = fmt::format("stage.{}", foreign.part);
    const auto is_foreign = [&](const std::string& key) {
      return key == part || key.starts_with(part + ".") ||
             key == fmt::format("stage.until.{}", foreign.stress) ||
             key == fmt::format("stage.until.{}", foreign.strain);
    };
    for (const auto& [key, value] : text.numbers)
      if (is_foreign(key)) refuse_key(value.second, foreign.remedy);
    for (const auto& [key, value] : text.words)
      if (is_foreign(key)) refuse_key(value.second, foreign.remedy);
  }
}

Until until_of(const StageText& text, int dimension) {
  const auto number = [&](const std::string& name) { return text.number("stage.until." + name); };
  Until until{.time = number("time")};
  const auto strains = strain_words(dimension);
  for (std::size_t k = 0; k < strains.size(); ++k) until.strain[k] = number(strains[k]);
  for (std::size_t p = 0; p < parts_with_stress; ++p) until.stress[p] = number(stress_word(p, dimension));
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

Stage stage_of(const StageText& text, int dimension) {
  refuse_foreign_words(text, dimension);
  Stage stage{.name = text.word("stage.name"), .until = until_of(text, dimension)};
  for (const Part part : parts)
    if (const auto drive = drive_of(text, part, dimension)) stage.drives.push_back(*drive);
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
    if (component_of(drive.part) != 0 ||
        (drive.control != Control::velocity && drive.control != Control::rest))
      return false;
  for (const auto& stress : until.stress)
    if (stress) return false;
  return !until.strain[1] && !until.strain[2] && !until.packing_fraction;
}

/// What a stage asks of walls or of a cell that the box does not have; "" if nothing.
std::string missing_in(const Case& c, const Stage& stage) {
  const auto repeats = repeats_of(c);
  const int dimension = c.experiment.dimension;
  const auto is_missing = [&](Part part) -> std::string {
    if (part == Part::xy && dimension == 2)
      return repeats[0] && repeats[1] ? "" : "xy shears a cell: it needs box.x and box.y \"periodic\"";
    const auto axis = static_cast<std::size_t>(dimension == 3 ? axis_in<3>(part) : axis_of(part));
    if (part == Part::yy || part == Part::xx || part == Part::xy || !repeats[axis]) return "";
    constexpr std::array names{"x", "y", "z"};
    return fmt::format("box.{0} is \"periodic\", there is no {1} wall: write {0}{0}", names[axis],
                       name_of(part));
  };
  for (const Drive& drive : stage.drives)
    if (std::string what = is_missing(drive.part); !what.empty()) return what;
  for (std::size_t p = 0; p < parts_with_stress; ++p)
    if (stage.until.stress[p])
      if (std::string what = is_missing(static_cast<Part>(p)); !what.empty()) return what;
  return stage.until.strain[2] ? is_missing(Part::xy) : "";
}

void check_stage(const Stage& stage, const StageText& text, const CaseDraft& draft) {
  if (const std::string fault = fault_of(stage, draft.the_case.experiment.dimension); !fault.empty())
    throw StageFault{text.at, "[[stage]]: " + fault};
  if (const std::string missing = missing_in(draft.the_case, stage); !missing.empty())
    throw StageFault{text.at, "[[stage]]: " + missing};
  if (draft.the_case.experiment.loading == LoadingPath::diametral && !fits_one_grain(stage))
    throw StageFault{text.at,
                     "[[stage]]: one grain between two walls (experiment.loading = \"diametral\") takes "
                     "velocity and \"rest\" of yy (in space zz), top and bottom until a time, strain, "
                     "overlap or rest; for "
                     "all else write experiment.loading = \"stages\""};
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
      c.stages.push_back(stage_of(text, c.experiment.dimension));
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

}  // namespace softgrain
