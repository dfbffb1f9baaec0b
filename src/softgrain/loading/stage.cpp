#include "softgrain/loading/stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

constexpr std::size_t most_stages = 100'000;

/// Do two parts move one wall?
bool share_a_wall(Part a, Part b) {
  if (a == b) return true;
  const auto of_a = share_of(a, 1), of_b = share_of(b, 1);
  for (std::size_t w = 0; w < of_a.size(); ++w)
    if (of_a[w] != 0 && of_b[w] != 0) return true;
  return false;
}

/// What a stage lacks or has too much of, or "".
std::string contradiction(const Stage& stage, int dimension) {
  const auto& drives = stage.drives;
  for (std::size_t a = 0; a < drives.size(); ++a)
    for (std::size_t b = a + 1; b < drives.size(); ++b)
      if (share_a_wall(drives[a].part, drives[b].part))
        return fmt::format("{} and {} both move one wall: give one of them",
                           name_of(drives[a].part, dimension), name_of(drives[b].part, dimension));
  for (const Drive& drive : drives) {
    const bool swings = drive.control == Control::strain || drive.amplitude > 0;
    if (swings && drive.period <= 0)
      return fmt::format("{} swings, so it needs a period > 0", name_of(drive.part, dimension));
    const bool shears = drive.part == Part::xy && dimension == 2;
    if (drive.control == Control::stress && !shears && drive.amplitude >= drive.value)
      return fmt::format("{} would pull the grains: stress_amplitude must be below stress",
                         name_of(drive.part, dimension));
  }
  return "";
}

bool moves_by_itself(const Stage& stage) {
  return std::any_of(stage.drives.begin(), stage.drives.end(),
                     [](const Drive& drive) { return drive.is_given() && drive.value != 0; });
}

/// Does a stage move a component, or may a stress?
bool moves(const Stage& stage, int component) {
  return std::any_of(stage.drives.begin(), stage.drives.end(), [&](const Drive& drive) {
    const bool rests = drive.control == Control::rest || (drive.is_given() && drive.value == 0);
    return !rests && (drive.part == Part::all || component_of(drive.part) == component);
  });
}

std::string endless(const Stage& stage, int dimension) {
  if (stage.until == Until{}) return "it never ends: give until, as in until = { time = \"1 ms\" }";
  if (stage.until.time) return "";
  if (!moves_by_itself(stage))
    return "its walls rest or keep a stress, so it may never end: give until.time too";
  if (stage.until != Until{.strain = stage.until.strain}) return "";
  constexpr std::array<Part, 3> pairs{Part::yy, Part::xx, Part::xy};
  std::string_view still;
  for (int c = 0; c < 3; ++c) {
    if (!stage.until.strain[c]) continue;
    if (moves(stage, c)) return "";
    still = name_of(pairs[c], dimension);
  }
  return fmt::format(
      "it never ends, as nothing moves {} to the strain that it waits for: move {} too, or give "
      "the strain of what moves",
      still, still);
}

/// As often as they are asked for, the stages from `first` to the end of the list once more.
void repeat(std::vector<Stage>& all, std::size_t first, int times) {
  const std::vector<Stage> group(all.begin() + static_cast<std::ptrdiff_t>(first), all.end());
  for (int k = 1; k < times; ++k) {
    require(all.size() + group.size() <= most_stages, "repeat = {} makes more than {} stages", times,
            most_stages);
    all.insert(all.end(), group.begin(), group.end());
  }
}

}  // namespace

std::array<double, 4> share_of(Part part, double aspect) {
  switch (part) {
    case Part::yy:
      return {0.5, 0.5, 0, 0};
    case Part::xx:
      return {0, 0, 0.5, 0.5};
    case Part::bottom:
      return {1, 0, 0, 0};
    case Part::top:
      return {0, 1, 0, 0};
    case Part::left:
      return {0, 0, 1, 0};
    case Part::right:
      return {0, 0, 0, 1};
    case Part::xy:
      return {};
    case Part::all:
      break;
  }
  return {0.5, 0.5, 0.5 * aspect, 0.5 * aspect};
}

int axis_of(Part part) { return part == Part::xx || part == Part::left || part == Part::right ? 0 : 1; }

int component_of(Part part) { return part == Part::xy ? 2 : 1 - axis_of(part); }

std::string_view name_of(Part part, int dimension) {
  constexpr std::array<std::string_view, number_of_parts> names{"yy",   "xx",    "bottom", "top",
                                                                "left", "right", "xy",     "all walls"};
  constexpr std::array<std::string_view, 3> in_space{"zz", "yy", "xx"};
  const bool is_pair = part == Part::yy || part == Part::xx || part == Part::xy;
  return dimension == 3 && is_pair ? in_space[static_cast<std::size_t>(component_of(part))]
                                   : names[static_cast<std::size_t>(part)];
}

double Drive::target(double time) const {
  return amplitude == 0 ? value : value + amplitude * wave_at(wave, time, period);
}

bool Stage::is_driven(Control control) const {
  return std::any_of(drives.begin(), drives.end(),
                     [&](const Drive& drive) { return drive.control == control; });
}

std::string Stage::title(std::size_t number) const {
  return name.empty() ? fmt::format("stage {}", number) : fmt::format("stage '{}'", name);
}

bool Stage::repeats_in_vain() const {
  const bool alone = repeat > 1 && (repeat_from.empty() || repeat_from == name);
  const Until place{.strain = until.strain, .packing_fraction = until.packing_fraction};
  return alone && until == place &&
         std::all_of(drives.begin(), drives.end(), [](const Drive& drive) { return drive.is_given(); });
}

std::vector<Stage> without_repeats(const std::vector<Stage>& stages) {
  std::vector<Stage> all;
  std::vector<std::pair<std::string, std::size_t>> begins;  // of the names, in `all`
  for (const Stage& stage : stages) {
    begins.emplace_back(stage.name, all.size());
    all.push_back(stage);
    if (stage.repeat == 1) continue;
    std::size_t first = all.size() - 1;
    if (!stage.repeat_from.empty()) {
      const auto found = std::find_if(begins.begin(), begins.end(),
                                      [&](const auto& b) { return b.first == stage.repeat_from; });
      require(found != begins.end(), "repeat_from = \"{}\": no stage before has this name",
              stage.repeat_from);
      first = found->second;
    }
    repeat(all, first, stage.repeat);
  }
  return all;
}

std::string fault_of(const Stage& stage, int dimension) {
  if (std::string why = contradiction(stage, dimension); !why.empty()) return why;
  if (std::string why = endless(stage, dimension); !why.empty()) return why;
  if (stage.repeat < 1) return "repeat must be 1 or more";
  if (!stage.repeat_from.empty() && stage.repeat == 1) return "repeat_from needs repeat = 2 or more";
  return "";
}

void check_stages(const std::vector<Stage>& stages, int dimension) {
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const std::string why = fault_of(stages[k], dimension);
    require(why.empty(), "{}: {}", stages[k].title(k), why);
  }
  without_repeats(stages);
}

double StrainMeasure::travel(double strain) const {
  return kind == Kind::of_grain ? length * (1 - std::exp(-strain)) : -length * std::expm1(-strain);
}

double StrainMeasure::strain(double start, double now) const {
  return kind == Kind::of_grain ? -std::log1p(-(start - now) / length) : std::log(start / now);
}

double wave_at(Wave wave, double time, double period) {
  const double turns = time / period;
  if (wave == Wave::sine) return std::sin(2 * std::numbers::pi * turns);
  const double phase = turns - std::floor(turns);  // 0: rises from 0
  return phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4;
}

std::int64_t whole_steps(double time, double dt) {
  constexpr double most = 1e15;  // that a double counts one by one
  return std::max<std::int64_t>(1, std::llround(std::min(time / dt, most)));
}

}  // namespace softgrain
