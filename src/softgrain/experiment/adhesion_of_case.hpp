#pragma once
#include <vector>

#include "softgrain/contact/adhesion.hpp"
#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// Adhesion of all pairs of kinds of a case, and of kinds and walls, that have a surface energy. Without a
/// range of its own a pair gets
///   delta = 4 sqrt(n h w/(pi E*)),  n = 3,
/// at which the cohesive zone pi/4 E* w/sigma_0^2 (theory (81)) spans n segments h of the outline of its
/// largest grains; rigid grains among themselves and at walls get h/4, bonded ones <a0>/4 of their smallest.
std::vector<PairAdhesion> adhesion_of(const Case& the_case);

/// How well a case resolves its adhesion: the worst of all pairs. Infinite where nothing adheres, or only
/// rigid grains do.
struct AdhesionAdvice {
  double zone = 0;   ///< length of the cohesive zone over a segment of the outline
  double reach = 0;  ///< radius of the smallest grain over the range
};
AdhesionAdvice advise_on_adhesion(const Case& the_case);

}  // namespace softgrain
