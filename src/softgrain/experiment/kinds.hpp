#pragma once
#include <algorithm>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How many kinds of grains a case has: one, unless it lists them.
inline int kinds_of(const Case& c) { return c.kinds.empty() ? 1 : static_cast<int>(c.kinds.size()); }

inline bool has_kind_of(const Case& c, GrainModel model) {
  return std::any_of(c.kinds.begin(), c.kinds.end(),
                     [&](const Case::Kind& kind) { return kind.model == model; });
}
/// Bonded grains among elastic ones: the case's own model is mpm.
inline bool is_mixed(const Case& c) {
  return has_kind_of(c, GrainModel::bpm) && has_kind_of(c, GrainModel::mpm);
}
/// Are all grains, or some, bonded?
inline bool has_bonded(const Case& c) { return is_bonded(c) || is_mixed(c); }

/// Some of the kinds of a case, with the pairs among them, numbered anew.
struct PartOfCase {
  Case the_case;
  std::vector<int> kinds;   ///< their numbers in the whole case
  std::vector<int> number;  ///< (kinds of the whole case) of each here, or -1
};
/// Of a mixed case its elastic kinds, or (bpm) its bonded kinds and the rigid ones, which are single
/// primaries among them.
PartOfCase part_of(const Case& whole, GrainModel model);

/// The case with grains of its k-th kind alone: what `grain`, `bpm`, `mpm`, `sample` and `experiment.model`
/// say is that kind's, and the number of grains too. Of a case of one kind that case itself. Of several,
/// soft and rigid ones, the case's own model is that of the soft ones.
Case case_of_kind(Case the_case, int kind);

/// The case with its bonded kinds alone, where rigid ones are among them.
Case with_bonded_kinds(Case the_case);

/// What a case of one kind says of it.
Case::Kind kind_of(const Case& the_case);

/// The least and the largest of a quantity that each kind has: of(case of one kind) -> double.
template <class Quantity>
double least_of_kinds(const Case& c, const Quantity& of) {
  double least = of(case_of_kind(c, 0));
  for (int k = 1; k < kinds_of(c); ++k) least = std::min(least, of(case_of_kind(c, k)));
  return least;
}
template <class Quantity>
double largest_of_kinds(const Case& c, const Quantity& of) {
  return -least_of_kinds(c, [&](const Case& kind) { return -of(kind); });
}
/// Its sum over the kinds.
template <class Quantity>
double sum_of_kinds(const Case& c, const Quantity& of) {
  double sum = of(case_of_kind(c, 0));
  for (int k = 1; k < kinds_of(c); ++k) sum += of(case_of_kind(c, k));
  return sum;
}

}  // namespace softgrain
