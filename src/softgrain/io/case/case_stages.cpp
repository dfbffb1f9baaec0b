#include "softgrain/io/case/case_stages.hpp"

#include <fmt/core.h>

#include <cmath>

#include "softgrain/io/case/words.hpp"

namespace softgrain {
namespace {

/// A stage no path of today has; what() says why.
struct NotYet {
  Origin at;
  std::string why;
};

[[noreturn]] void not_yet_at(const StageText& stage, const std::string& why) { throw NotYet{stage.at, why}; }

/// Walls together (1), apart (-1) or at rest (0), and how fast [m/s].
struct Motion {
  int direction;
  double speed;
  bool isotropic;
};

Motion motion_of(const StageText& stage) {
  const auto vertical = stage.number("stage.yy.velocity"), sideways = stage.number("stage.xx.velocity");
  if (stage.number("stage.yy.stress")) {
    if (vertical || sideways) not_yet_at(stage, "a stage keeps a stress or moves at a velocity, not both");
    return {0, 0, false};
  }
  if (stage.rests.contains("stage.yy") && !vertical && !sideways) return {0, 0, false};
  if (!vertical) not_yet_at(stage, "a stage says what yy does: a velocity, a stress or \"rest\"");
  if (sideways && *sideways != *vertical)
    not_yet_at(stage, "the side walls come in as fast as top and bottom wall, or not at all");
  if (*vertical == 0) not_yet_at(stage, "a velocity of 0 is yy = \"rest\"");
  return {*vertical > 0 ? 1 : -1, std::abs(*vertical), sideways.has_value()};
}

/// What stages say in the words of [loading].
struct Path {
  std::optional<Motion> moving;
  std::vector<double> ends;  // strains: of the first turn, where the wall comes back, of the second turn, ...
  std::optional<double> hold, hold_stress;
  int rests = 0;

  void add(const StageText& stage, bool last);
  void add_rest(const StageText& stage, bool last);
};

void Path::add_rest(const StageText& stage, bool last) {
  const auto time = stage.number("stage.until.time"), stress = stage.number("stage.yy.stress");
  if (!time) not_yet_at(stage, "a rest or a stress that is kept needs until = { time = ... }");
  if (ends.empty()) not_yet_at(stage, "the first stage moves the walls");
  if (hold && *hold != *time) not_yet_at(stage, "all rests last the same time");
  if (stress && !last) not_yet_at(stage, "a stress is kept in the last stage only");
  hold = time;
  hold_stress = stress;
  ++rests;
}

void Path::add(const StageText& stage, bool last) {
  const Motion motion = motion_of(stage);
  if (motion.direction == 0) return add_rest(stage, last);
  if (moving && (moving->speed != motion.speed || moving->isotropic != motion.isotropic))
    not_yet_at(stage, "all stages move the same walls at the same speed");
  if (motion.direction != (ends.size() % 2 == 0 ? 1 : -1))
    not_yet_at(stage, "walls come together, go apart, come together, ...");
  const auto strain = stage.number("stage.until.strain");
  if (!strain)
    not_yet_at(stage,
               "a stage that moves walls ends at until.strain; the last one may end earlier, at "
               "until.stress_yy, until.packing_fraction or until.overlap");
  ends.push_back(*strain);
  moving = motion;
}

/// 0.1 - 0.08 = 0.02, as who wrote the strains means it.
double as_decimals(double difference) { return std::stod(fmt::format("{:.12g}", difference)); }

/// Strains at which the wall turns back, and how far it goes each time.
void give_turns(const Path& path, const StageText& last, CaseDraft& draft) {
  if (path.ends.size() % 2 == 0) not_yet_at(last, "the last way is one together");
  std::vector<double> turns;
  std::optional<double> back;
  for (std::size_t k = 0; k + 1 < path.ends.size(); k += 2) {
    const double way = as_decimals(path.ends[k] - path.ends[k + 1]);
    if (back && std::abs(way - *back) > 1e-9 * std::abs(*back))
      not_yet_at(last, "all ways apart have the same length in strain");
    back = way;
    turns.push_back(path.ends[k]);
  }
  const std::size_t stops = turns.size() * 2 + 1;
  if (path.rests != 0 && static_cast<std::size_t>(path.rests) != stops)
    not_yet_at(last, fmt::format("walls rest after every one of the {} ways, or after none", stops));
  if (!back) return;
  TomlValue::Array list(turns.size());
  for (std::size_t k = 0; k < turns.size(); ++k) list[k].content = turns[k];
  draft.give(*find_key("loading.unload_at"), "stage.until.strain of ways together", {list, {}}, last.at);
  draft.give_number("loading.unload_by", *back, "way of the stages that go apart", last.at);
}

/// What ends the last way before its strain does.
void give_ends(const std::vector<StageText>& stages, const Path& path, CaseDraft& draft) {
  const std::pair<const char*, const char*> limits[] = {
      {"stage.until.stress_yy", "loading.max_stress"},
      {"stage.until.packing_fraction", "loading.max_packing_fraction"},
      {"stage.until.overlap", "loading.max_overlap"}};
  const StageText* last_way = nullptr;
  for (const StageText& stage : stages)
    if (motion_of(stage).direction != 0) last_way = &stage;
  for (const StageText& stage : stages)
    for (const auto& [name, key] : limits) {
      const auto found = stage.numbers.find(name);
      if (found == stage.numbers.end()) continue;
      const auto& [limit, origin] = found->second;
      if (&stage != last_way) throw NotYet{origin, fmt::format("only the last way ends at {}", name)};
      const bool kept = path.hold_stress && std::string_view(key) == "loading.max_stress";
      if (kept && limit != *path.hold_stress)
        throw NotYet{origin, "the stress that is kept is the one at which the way before it ends"};
      if (!kept) draft.give_number(key, limit, name, origin);
    }
}

void give_loading(const Motion& motion, const StageText& first, CaseDraft& draft) {
  LoadingPath& loading = draft.the_case.experiment.loading;
  const bool given = draft.origins.contains("experiment.loading");
  if (motion.isotropic && given && loading != LoadingPath::isotropic)
    throw NotYet{first.at, fmt::format("experiment.loading \"{}\" moves no side walls", word_of(loading))};
  if (!motion.isotropic && loading == LoadingPath::isotropic)
    throw NotYet{first.at, "experiment.loading \"isotropic\" moves the side walls too: say xx"};
  if (motion.isotropic) loading = LoadingPath::isotropic;
  draft.give_number("loading.wall_velocity", motion.speed, "stage.yy.velocity", first.at);
}

}  // namespace

std::optional<double> StageText::number(const std::string& name) const {
  const auto found = numbers.find(name);
  return found == numbers.end() ? std::nullopt : std::optional(found->second.first);
}

void read_stages(const std::vector<StageText>& stages, CaseDraft& draft) {
  try {
    Path path;
    for (const StageText& stage : stages) path.add(stage, &stage == &stages.back());
    give_loading(*path.moving, stages.front(), draft);
    give_turns(path, stages.back(), draft);
    give_ends(stages, path, draft);
    draft.give_number("loading.max_strain", path.ends.back(), "stage.until.strain", stages.back().at);
    if (path.hold) draft.give_number("loading.hold", *path.hold, "stage.until.time", stages.back().at);
    if (path.hold_stress)
      draft.give_number("loading.hold_stress", *path.hold_stress, "stage.yy.stress", stages.back().at);
  } catch (const NotYet& reason) {
    draft.add(reason.at, fmt::format("not yet: this [[stage]]: {}", reason.why));
  }
}

}  // namespace softgrain
