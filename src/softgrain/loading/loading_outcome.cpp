#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "softgrain/core/error.hpp"
#include "softgrain/loading/loading.hpp"

namespace softgrain {
namespace {

/// "stage 'press': stress_yy of 5e+06 Pa or packing_fraction 0.9", whatever ends a stage but times.
std::string asked_of(const Stage& stage, std::size_t number, int dimension) {
  const Until& until = stage.until;
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : " or ") + what; };
  for (std::size_t p = 0; p < parts_with_stress; ++p)
    if (until.stress[p])
      add(fmt::format("stress_{} of {:.3g} Pa", name_of(static_cast<Part>(p), dimension), *until.stress[p]));
  constexpr std::array<Part, 3> pairs{Part::yy, Part::xx, Part::xy};
  for (std::size_t c = 0; c < pairs.size(); ++c)
    if (until.strain[c])
      add(c == 0 ? fmt::format("strain {:.4g}", *until.strain[c])
                 : fmt::format("strain_{} {:.4g}", name_of(pairs[c], dimension), *until.strain[c]));
  if (until.packing_fraction) add(fmt::format("packing_fraction {:.4g}", *until.packing_fraction));
  if (until.overlap) add(fmt::format("overlap {:.3g}", *until.overlap));
  if (until.rest) add(fmt::format("rest {:.3g}", *until.rest));
  return fmt::format("{}: {}", stage.key.empty() ? stage.title(number) : std::string(stage.key), text);
}

/// Of a stage that ended as it began.
std::string past_of(const Stage& stage, int number) {
  const Until& until = stage.until;
  std::string ends;
  const auto add = [&](std::string_view what, const std::optional<double>& value) {
    if (value) ends += fmt::format("{}{} {:.4g}", ends.empty() ? "" : " or ", what, *value);
  };
  for (const std::optional<double>& strain : until.strain) add("strain", strain);
  add("packing_fraction", until.packing_fraction);
  return fmt::format(
      "{} ended as it began: its walls move away from {}, which was past already; turn its velocity round, "
      "or "
      "give another end",
      stage.title(static_cast<std::size_t>(number)), ends);
}

}  // namespace

/// Keeps the first stress that was not kept.
template <int Dim>
void LoadingOf<Dim>::note_unkept() {
  if (unkept_stage_ >= 0) return;
  const Stage& stage = stage_now();
  for (std::size_t d = 0; d < stage.drives.size() && unkept_stage_ < 0; ++d) {
    if (held_[d].windows == 0 || held_[d].kept()) continue;
    unkept_ = held_[d];
    unkept_stage_ = static_cast<int>(stage_);
    unkept_part_ = static_cast<int>(stage.drives[d].part);
  }
}

/// Keeps the first stress that was to end its stage, and did not.
template <int Dim>
void LoadingOf<Dim>::note_unreached() {
  const auto& stress = stage_now().until.stress;
  for (std::size_t p = 0; p < parts_with_stress && unreached_stage_ < 0; ++p) {
    if (!stress[p] || is_at_stress(p, *stress[p])) continue;
    unreached_stage_ = static_cast<int>(stage_);
    unreached_part_ = static_cast<int>(p);
  }
}

template <int Dim>
std::string LoadingOf<Dim>::where() const {
  const std::size_t now = std::min(stage_, stages_.size() - 1);
  if (!stages_[now].towards) return "in " + stages_[now].title(now);
  double last = 0;
  for (const Stage& stage : stages_)
    if (stage.towards) last = stage.until.strain[0].value_or(0);
  return fmt::format("before loading.max_strain {:.4g}", last);
}

template <int Dim>
std::string LoadingOf<Dim>::not_reached(std::string_view what, double stress, std::size_t part) const {
  return fmt::format("{} of {:.3g} Pa was not reached: the largest stress was {:.3g} Pa", what, stress,
                     largest_[part]);
}

template <int Dim>
std::string LoadingOf<Dim>::early_end() const {
  if (!finished()) return "";
  if (ended_ == End::exit) return fmt::format("{} is reached", stage_now().exits[exit_].key);
  if (ended_ == End::limit) return outcome().shortfall;
  if (!kept_last_) return "";
  const bool kept = unkept_stage_ < 0;
  return fmt::format("{} was {} for loading.hold: over the second half {}", stages_.back().key,
                     kept ? "kept" : "asked for, but not kept,", (kept ? held_.front() : unkept_).text());
}

template <int Dim>
LoadingOutcome LoadingOf<Dim>::outcome() const {
  if (!finished()) return {};
  LoadingOutcome outcome = outcome_of_limit();
  if (outcome.shortfall.empty()) outcome = outcome_of_exits();
  if (outcome.shortfall.empty() && ended_ == End::none) outcome = outcome_of_stresses();
  return outcome;
}

template <int Dim>
LoadingOutcome LoadingOf<Dim>::outcome_of_limit() const {
  if (ended_ != End::limit) return {};
  const Stage& stage = stage_now();
  const auto& strain = stage.until.strain;
  const bool gave_way =
      std::any_of(strain.begin(), strain.end(), [](const auto& end) { return end.has_value(); });
  std::string text = fmt::format("{} was not reached {} strain {:.3g}{}", asked_of(stage, stage_, Dim),
                                 gave_way ? "while walls moved as far as" : "by",
                                 limit_of(stage, strains_at_stage())->strain,
                                 gave_way ? ", as walls that keep a stress gave way" : "");
  for (std::size_t p = 0; p < parts_with_stress; ++p)
    if (stage.until.stress[p]) text += fmt::format(": the largest stress was {:.3g} Pa", largest_[p]);
  return {.completed = false, .shortfall = text};
}

template <int Dim>
LoadingOutcome LoadingOf<Dim>::outcome_of_exits() const {
  if (kept_last_) return {};
  std::vector<Exit> exits;
  for (const Stage& stage : stages_) exits.insert(exits.end(), stage.exits.begin(), stage.exits.end());
  for (const Exit& exit : exits)
    if (exit.to_last)
      return {.completed = ended_ != End::none,
              .shortfall = not_reached(exit.key, exit.stress, 0) + ", so nothing was held"};
  for (const Exit& exit : exits)
    if (exit.overlap > 0 && ended_ == End::none)
      return {.completed = true,
              .shortfall = fmt::format("{} of {:.3g} was not reached", exit.key, exit.overlap)};
  for (const Exit& exit : exits)
    if (exit.stress > 0 && ended_ == End::none)
      return {.completed = true, .shortfall = not_reached(exit.key, exit.stress, 0)};
  return {};
}

template <int Dim>
LoadingOutcome LoadingOf<Dim>::outcome_of_stresses() const {
  if (unkept_stage_ >= 0) {
    const Stage& stage = stages_[unkept_stage_];
    const std::string what = stage.key.empty()
                                 ? fmt::format("{}: the stress of {}", stage.title(unkept_stage_),
                                               name_of(static_cast<Part>(unkept_part_), Dim))
                                 : std::string(stage.key);
    return {.completed = false,
            .shortfall = fmt::format("{} was not kept: over the second half of {} the stress was {}", what,
                                     stage.key.empty() || !stage.until.time ? "the stage" : "loading.hold",
                                     unkept_.text())};
  }
  if (unreached_stage_ < 0) return {};
  const Stage& stage = stages_[unreached_stage_];
  if (!stage.until.stress[unreached_part_])
    return {.completed = false, .shortfall = past_of(stage, unreached_stage_)};
  const std::string what = stage.key.empty() ? fmt::format("{}: stress_{}", stage.title(unreached_stage_),
                                                           name_of(static_cast<Part>(unreached_part_), Dim))
                                             : std::string(stage.key);
  return {.completed = true,
          .shortfall = not_reached(what, *stage.until.stress[unreached_part_], unreached_part_)};
}

template class LoadingOf<2>;
template class LoadingOf<3>;

}  // namespace softgrain
