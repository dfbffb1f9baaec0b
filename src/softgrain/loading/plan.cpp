#include "softgrain/loading/plan.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Of the way of a stage: less is no step more.
constexpr double rounding = 1e-9;

/// Strain at which walls stop that come together for a stress that does not come.
constexpr double last_strain_together = 3;

/// Goes through the stages as they are foreseen.
class Planner {
 public:
  Planner(const LoadingFrame& frame, std::array<double, 3> travel) : frame_(frame), travel_(travel) {}

  PlannedStage go(const Stage& stage) {
    set_speeds(stage);
    PlannedStage planned{stage.until.time.value_or(infinite), stage.until.time.has_value()};
    const auto sooner = [&](double time) {
      if (time < planned.time) planned = {time, false};
    };
    for (int c = 0; c < 3; ++c)
      if (const auto& strain = stage.until.strain[c]) sooner(time_to(c, *strain, stage.towards));
    if (stage.until.packing_fraction) sooner(time_to_fraction(*stage.until.packing_fraction));
    if (const auto limit = limit_of(stage, strains()); limit)
      sooner(time_to(limit->component, limit->strain, false));
    if (!std::isfinite(planned.time)) planned.time = 0;
    advance(planned.time);
    return planned;
  }

 private:
  double length(int c) const { return frame_.start[c] - travel_[c]; }
  std::array<double, 3> strains() const {
    return {frame_.strain(0, length(0)), frame_.strain(1, length(1)), frame_.strain(2, length(2))};
  }

  void set_speeds(const Stage& stage) {
    speed_ = rate_ = {};
    for (const Drive& drive : stage.drives)
      for (int c = 0; c < 3; ++c) {
        const double share = frame_.closing_share(drive.part, c);
        if (drive.control == Control::velocity) speed_[c] += share * drive.value;
        if (drive.control == Control::rate) (frame_.is_shear(c) ? speed_ : rate_)[c] += share * drive.value;
      }
  }

  double time_to(int c, double strain, bool towards) {
    const double way = frame_.travel(c, strain) - travel_[c];
    if (towards)
      for (double& speed : speed_) speed = std::copysign(speed, way);
    const double speed = speed_[c] != 0 ? speed_[c] + rate_[c] * length(c) : 0;
    if (speed != 0) return way * speed < 0 ? 0 : std::abs(way) / std::abs(speed);
    const double way_of_strain = strain - frame_.strain(c, length(c));
    if (rate_[c] == 0) return infinite;
    return way_of_strain * rate_[c] < 0 ? 0 : way_of_strain / rate_[c];
  }

  /// All strain is taken to fall to the components as at the start.
  double time_to_fraction(double packing_fraction) {
    const std::array<double, 3> now = strains();
    double way = std::log(packing_fraction / frame_.packing_fraction), all = 0;
    std::array<double, 3> rate{};
    for (int k = 0; k < frame_.dimension; ++k) {
      way -= now[k];
      all += rate[k] = rate_[k] + speed_[k] / length(k);
    }
    if (!(way > 0) || all <= 0) return way > 0 ? infinite : 0;
    const int c = static_cast<int>(std::max_element(rate.begin(), rate.end()) - rate.begin());
    return time_to(c, now[c] + way * rate[c] / all, false);
  }

  void advance(double time) {
    for (int c = 0; c < 3; ++c) {
      travel_[c] += speed_[c] * time;
      if (rate_[c] != 0) travel_[c] += length(c) * -std::expm1(-rate_[c] * time);
    }
  }

  const LoadingFrame& frame_;
  std::array<double, 3> travel_;
  std::array<double, 3> speed_{}, rate_{};  // at which walls come together [m/s], [1/s]
};

/// Does a strain end the stage that walls bring about whatever the grains do?
bool ends_at_strain(const Stage& stage) {
  for (int c = 0; c < 3; ++c) {
    bool moves = false, gives_way = false;
    for (const Drive& drive : stage.drives) {
      if (drive.part != Part::all && component_of(drive.part) != c) continue;
      moves = moves || stage.towards || (drive.is_given() && drive.value != 0);
      gives_way = gives_way || drive.control == Control::stress;
    }
    if (stage.until.strain[c] && moves && !gives_way) return true;
  }
  return false;
}

}  // namespace

double LoadingFrame::strain(int component, double length) const {
  if (is_shear(component)) return start[2] - length;
  return component == 0 ? measure.strain(start[0], length) : std::log(start[component] / length);
}

double LoadingFrame::travel(int component, double strain) const {
  if (is_shear(component)) return strain;
  return component == 0 ? measure.travel(strain) : -start[component] * std::expm1(-strain);
}

std::int64_t PlannedStage::steps(double dt) const {
  if (is_rest) return whole_steps(time, dt);
  constexpr double most = 1e15;
  const double steps = std::ceil(std::min(time / dt, most) * (1 - rounding));
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
}

std::vector<PlannedStage> plan(std::span<const Stage> stages, const LoadingFrame& frame,
                               std::array<double, 3> travel) {
  Planner planner(frame, travel);
  std::vector<PlannedStage> planned;
  for (const Stage& stage : stages) planned.push_back(planner.go(stage));
  return planned;
}

std::optional<StrainLimit> limit_of(const Stage& stage, const std::array<double, 3>& strain_at_start) {
  if (stage.until.time || ends_at_strain(stage)) return std::nullopt;
  for (const Drive& drive : stage.drives) {
    if (!drive.is_given() || drive.value == 0) continue;
    const int component = component_of(drive.part);
    const double start = strain_at_start[component];
    if (drive.value > 0) return StrainLimit{component, stage.limit.value_or(last_strain_together)};
    return StrainLimit{component, stage.limit.value_or(start > 0 ? 0 : start - 1)};
  }
  return std::nullopt;
}

double LoadingFrame::closing_share(Part part, int component) const {
  if (dimension == 3) {
    const auto share = shares<3>(part);
    return share[2 * static_cast<std::size_t>(component)] +
           share[2 * static_cast<std::size_t>(component) + 1];
  }
  if (component == 2) return part == Part::xy ? 1 : 0;
  const auto share = share_of(part, aspect);
  return component == 0 ? share[0] + share[1] : share[2] + share[3];
}

}  // namespace softgrain
