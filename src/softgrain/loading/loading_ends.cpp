#include <algorithm>
#include <cmath>
#include <optional>

#include "softgrain/loading/loading.hpp"

namespace softgrain {
namespace {

/// Of the largest stress so far: grains that bear less are unloaded.
constexpr double no_stress = 1e-3;

}  // namespace

template <int Dim>
const Exit* LoadingOf<Dim>::exit_taken(const StepFelt& felt) const {
  for (const Exit& exit : stage_now().exits) {
    if (exit.overlap > 0 && felt.overlap_mean >= exit.overlap) return &exit;
    const bool presses = !exit.to_last || closing_[0] > 0;
    if (exit.stress > 0 && presses && present_stress(0) >= exit.stress) return &exit;
  }
  return nullptr;
}

template <int Dim>
bool LoadingOf<Dim>::is_over(const Box<Dim>& box, const StepFelt& felt) const {
  const Until& until = stage_now().until;
  for (int c = 0; c < 3 && !stage_now().towards; ++c)
    if (until.strain[c] && is_at_strain(box, c, *until.strain[c])) return true;
  for (std::size_t p = 0; p < parts_with_stress; ++p)
    if (until.stress[p] && is_at_stress(p, *until.stress[p])) return true;
  if (until.overlap && felt.overlap_mean >= *until.overlap) return true;
  if (until.rest && felt.unrest < *until.rest) return true;
  if (!until.packing_fraction) return false;
  const double now = packing_fraction({length(box, 0), length(box, 1), length(box, 2)});
  const bool from_above = opens() && *until.packing_fraction < packing_fraction(length_at_stage_);
  return from_above ? now <= *until.packing_fraction : now >= *until.packing_fraction;
}

/// Phi_0 where walls stand so far apart [m].
template <int Dim>
double LoadingOf<Dim>::packing_fraction(const std::array<double, 3>& length) const {
  double shrunk = frame_.start[0] * frame_.start[1] / (length[0] * length[1]);
  if (Dim == 3) shrunk *= frame_.start[2] / length[2];
  return frame_.packing_fraction * shrunk;
}

/// Do all walls that the stage moves go apart?
template <int Dim>
bool LoadingOf<Dim>::opens() const {
  const int last = Dim == 3 ? 3 : 2;
  return std::any_of(closing_.begin(), closing_.begin() + last, [](double speed) { return speed < 0; }) &&
         std::none_of(closing_.begin(), closing_.begin() + last, [](double speed) { return speed > 0; });
}

/// Keeps the first stage of which walls move away from the strain or packing fraction that is to end it.
template <int Dim>
void LoadingOf<Dim>::note_past() {
  constexpr double rounding = 1e-9;
  const Until& until = stage_now().until;
  if (unreached_stage_ >= 0 || stage_now().towards) return;
  bool past = false;
  for (std::size_t c = 0; c < 3; ++c)
    if (until.strain[c]) {
      const double way = *until.strain[c] - strains_at_stage()[c];
      past = past || (std::abs(way) > rounding && way * closing_[c] < 0);
    }
  if (until.packing_fraction && closing_ != std::array<double, 3>{}) {
    const double way = *until.packing_fraction - packing_fraction(length_at_stage_);
    past = past || (std::abs(way) > rounding && (way < 0) != opens());
  }
  const auto without_stress = std::find(until.stress.begin(), until.stress.end(), std::nullopt);
  if (!past || without_stress == until.stress.end()) return;
  unreached_stage_ = static_cast<int>(stage_);
  unreached_part_ = static_cast<int>(without_stress - until.stress.begin());
}

template <int Dim>
std::array<double, 3> LoadingOf<Dim>::strains_at_stage() const {
  return {frame_.strain(0, length_at_stage_[0]), frame_.strain(1, length_at_stage_[1]),
          frame_.strain(2, length_at_stage_[2])};
}

/// From the side from which the stage comes.
template <int Dim>
bool LoadingOf<Dim>::is_at_strain(const Box<Dim>& box, int component, double strain) const {
  const double now = frame_.strain(component, length(box, component));
  return strain > strains_at_stage()[component] ? now >= strain : now <= strain;
}

template <int Dim>
bool LoadingOf<Dim>::is_at_stress(std::size_t part, double stress) const {
  const double now = present_stress(part);
  if (stress > stress_at_stage_[part]) return now >= stress;
  return now <= std::max(stress, no_stress * largest_[part]);
}

template <int Dim>
bool LoadingOf<Dim>::is_at_limit(const Box<Dim>& box) const {
  const auto at_start = strains_at_stage();
  const auto limit = limit_of(stage_now(), at_start);
  if (!limit) return false;
  const double now = frame_.strain(limit->component, length(box, limit->component));
  return limit->strain > at_start[limit->component] ? now >= limit->strain : now <= limit->strain;
}

template class LoadingOf<2>;
template class LoadingOf<3>;

}  // namespace softgrain
