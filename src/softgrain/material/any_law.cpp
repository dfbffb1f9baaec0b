#include "softgrain/material/any_law.hpp"

#include <cassert>

#include "softgrain/material/elastic_law.hpp"

namespace softgrain {

namespace {
template <class... Laws>
constexpr bool all_elastic(const std::variant<Laws...>*) {
  return ((SplitLaw<Laws, 2> && ElasticLaw<Laws, 3>)&&...);
}
static_assert(all_elastic(static_cast<const AnyLaw*>(nullptr)));

template <auto Factory>
AnyLaw make(double E, double nu) {
  return Factory(E, nu);
}
}  // namespace

const std::array<LawChoice, 6>& law_choices() {
  static constexpr std::array<LawChoice, 6> choices{{
      {MaterialLaw::neo_hookean, "neo_hookean", "neo-Hookean, lambda/2 (ln J)^2 for the volume", "",
       make<neo_hookean>},
      {MaterialLaw::neo_hookean_quadratic, "neo_hookean_quadratic",
       "neo-Hookean, lambda/2 (J - 1)^2 for the volume: faster, softer when crushed", "",
       make<neo_hookean_quadratic>},
      {MaterialLaw::hencky, "hencky", "Hooke's law in logarithmic strains", "", make<hencky>},
      {MaterialLaw::corotated, "corotated", "Hooke's law in the turned frame", "", make<corotated>},
      {MaterialLaw::small_strain_hooke, "small_strain_hooke", "Hooke's law in the small strain",
       "small_strain_hooke takes what a grain turns during the run for a strain of 1 - cos(angle), 1.5 % at "
       "10 "
       "degrees: only for grains that hardly turn and deform little",
       make<small_strain_hooke>},
      {MaterialLaw::st_venant_kirchhoff, "st_venant_kirchhoff", "Hooke's law in Green's strain",
       "st_venant_kirchhoff softens under compression and turns points inside out in dense packings: only to "
       "compare with the paper's Fig. 1",
       make<st_venant_kirchhoff>},
  }};
  return choices;
}

const LawChoice& law_choice(MaterialLaw law) {
  const LawChoice& choice = law_choices()[static_cast<std::size_t>(law)];
  assert(choice.law == law);
  return choice;
}

AnyLaw make_law(MaterialLaw law, double E, double nu) { return law_choice(law).make(E, nu); }

}  // namespace softgrain
