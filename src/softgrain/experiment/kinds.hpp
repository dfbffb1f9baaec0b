#pragma once
#include <algorithm>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// How many kinds of grains a case has: one, unless it lists them.
inline int kinds_of(const Case& c) { return c.kinds.empty() ? 1 : static_cast<int>(c.kinds.size()); }

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
