#include <algorithm>

#include "softgrain/core/error.hpp"
#include "softgrain/loading/loading.hpp"

namespace softgrain {

template <int Dim>
void LoadingOf<Dim>::visit_start(StateVisitor& visit) {
  std::vector<double> start(frame_.start.begin(), frame_.start.end());
  visit({"box_start", "m", Owner::run, Role::state,
         "height and width of the box where strains count from, and 0"},
        start);
  std::copy(start.begin(), start.end(), frame_.start.begin());
  if (frame_.measure.kind == StrainMeasure::Kind::of_box) frame_.measure.length = frame_.start[0];
}

namespace {

/// An array of fixed length.
template <std::size_t N>
void visit_numbers(StateVisitor& visit, const Field& field, std::array<double, N>& numbers) {
  std::vector<double> values(numbers.begin(), numbers.end());
  visit(field, values);
  std::copy(values.begin(), values.end(), numbers.begin());
}

}  // namespace

template <int Dim>
void LoadingOf<Dim>::visit_stage(StateVisitor& visit) {
  const auto number = [&](const char* name, std::string_view unit, std::string_view text, auto& value) {
    visit({name, unit, Owner::run, Role::state, text}, value);
  };
  number("stage", "", "of the coming step", stage_);
  number("stage_start", "s", "when it began", stage_start_);
  visit_numbers(visit,
                {"stage_box", "m", Owner::run, Role::state,
                 "height and width of the box then, and minus its shear strain"},
                length_at_stage_);
  number("stage_number", "", "how many stages came before it", number_);
  number("stage_number_of_last", "", "before that of the last step", number_of_last_);
  number("stage_progress", "", "share of the loading that was over when the stage began", progress_at_stage_);
  number("loading_end", "",
         "0: none, 1: an end of the case, 2: a stage without its end, 3: the grains are exhausted", ended_);
  number("loading_exit", "", "which end of the case; -1: none", exit_);
  number("holds_stress", "", "1 from where loading.hold_stress was met on", kept_last_);
}

template <int Dim>
void LoadingOf<Dim>::visit_stresses(StateVisitor& visit) {
  const auto stresses = [&](const char* name, std::string_view text, OfParts& values) {
    visit_numbers(visit, {name, "Pa", Owner::run, Role::state, text}, values);
  };
  stresses("stress_mean", "over 0.1 % of strain, of yy, xx, bottom, top, left, right, xy", stress_);
  stresses("stress_mean_of_mean", "the same mean of that mean", stress_twice_);
  stresses("stress_largest", "so far", largest_);
  stresses("stress_at_stage", "that mean where the stage began", stress_at_stage_);
  const auto press = [&](const char* name, std::string_view unit, std::string_view text, OfParts& values) {
    visit_numbers(visit, {name, unit, Owner::run, Role::state, text}, values);
  };
  press("press_speed", "m/s", "of walls that keep a stress: yy, xx, bottom, top, left, right, xy",
        press_speed_);
  press("press_mean_speed", "m/s", "its mean over ten times the time of the press", press_mean_speed_);
  press("press_mean_force", "N/m", "the mean of what grains press them with", press_force_);
  press("press_waiting", "s", "for how long that has been too small, or too large", press_waiting_);
}

template <int Dim>
void LoadingOf<Dim>::visit_held(StateVisitor& visit) {
  const auto declare = [&](const char* name, std::string_view text, double HeldStress::*member) {
    std::array<double, 5> values{};
    for (std::size_t d = 0; d < held_.size(); ++d) values[d] = held_[d].*member;
    values.back() = unkept_.*member;
    visit_numbers(visit, {name, "", Owner::run, Role::sum, text}, values);
    for (std::size_t d = 0; d < held_.size(); ++d) held_[d].*member = values[d];
    unkept_.*member = values.back();
  };
  declare("held_windows",
          "of each part that keeps a stress: equal times of the second half of its stage that are over; "
          "last: of the first that was not kept",
          &HeldStress::windows);
  declare("held_sum", "of their mean stresses over the stress asked for", &HeldStress::sum);
  declare("held_squares", "of the squares of these", &HeldStress::squares);
  declare("held_largest", "the largest of these", &HeldStress::largest);
  declare("held_window", "of the present time so far", &HeldStress::window);
  const auto number = [&](const char* name, std::string_view text, int& value) {
    visit({name, "", Owner::run, Role::sum, text}, value);
  };
  number("unkept_stage", "the first whose stress was not kept; -1: none", unkept_stage_);
  number("unkept_part", "which of its stresses", unkept_part_);
  number("unreached_stage", "the first that ended before its stress was reached; -1: none", unreached_stage_);
  number("unreached_part", "which of its stresses", unreached_part_);
}

template <int Dim>
void LoadingOf<Dim>::visit(StateVisitor& visit) {
  visit_start(visit);
  visit_numbers(visit,
                {"travel_start", "m", Owner::run, Role::state,
                 "of the walls where the first stage began: yy, xx; xy: shear strain"},
                travel_start_);
  visit_stage(visit);
  visit_stresses(visit);
  visit_held(visit);
  if (visit.reads() && !motion_.velocity) {
    plan_stages();
    if (number_ > 0 && stage_ < stages_.size()) plan_rest();
  }
  const int stages = static_cast<int>(stages_.size());
  if (stage_ > stages_.size() || ended_ < End::none || ended_ > End::exhausted || unkept_stage_ >= stages ||
      unreached_stage_ >= stages || unkept_part_ < 0 || unkept_part_ >= static_cast<int>(number_of_parts) ||
      unreached_part_ < 0 || unreached_part_ >= static_cast<int>(parts_with_stress))
    throw IoError("the snapshot's arrays 'stage' or 'loading_end' belong to no stage of this case");
}

template class LoadingOf<2>;
template class LoadingOf<3>;

}  // namespace softgrain
