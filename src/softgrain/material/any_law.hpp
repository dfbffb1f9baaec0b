#pragma once
#include <algorithm>
#include <array>
#include <string_view>
#include <variant>

#include "softgrain/material/corotated.hpp"
#include "softgrain/material/hencky.hpp"
#include "softgrain/material/material_law.hpp"
#include "softgrain/material/mooney_rivlin.hpp"
#include "softgrain/material/neo_hookean.hpp"
#include "softgrain/material/ogden.hpp"
#include "softgrain/material/prony.hpp"
#include "softgrain/material/small_strain_hooke.hpp"
#include "softgrain/material/st_venant_kirchhoff.hpp"
#include "softgrain/material/von_mises.hpp"
#include "softgrain/material/von_mises_kinematic.hpp"
#include "softgrain/material/yeoh.hpp"

namespace softgrain {

/// A law chosen at run time: std::visit it once outside the loop over points.
using AnyLaw =
    std::variant<NeoHookean<LogVolume>, NeoHookean<QuadraticVolume>, Hencky, Corotated, SmallStrainHooke,
                 StVenantKirchhoff, Yeoh, MooneyRivlin, Ogden, VonMises, VonMisesKinematic, Prony>;

/// A law and its name in case files.
struct LawChoice {
  using Parameter = double MaterialParameters::*;

  MaterialLaw law;
  std::string_view name;
  std::string_view text;     ///< what it is, for the documentation of the key
  std::string_view caution;  ///< what the program tells the user who chooses it; empty: nothing
  /// Raises UsageError for parameters that the law cannot have.
  AnyLaw (*make)(const MaterialParameters&);
  std::array<Parameter, 8> more{};  ///< what it takes beside E and nu

  constexpr bool flows() const { return takes(&MaterialParameters::yield_stress); }
  /// It flows, creeps or relaxes: has_history of what is made.
  constexpr bool remembers() const {
    return flows() || takes(&MaterialParameters::creep_rate) || takes(&MaterialParameters::relaxation_time_1);
  }
  constexpr bool takes(Parameter parameter) const {
    return parameter == &MaterialParameters::young_modulus ||
           parameter == &MaterialParameters::poisson_ratio ||
           std::count(more.begin(), more.end(), parameter) > 0;
  }
};

/// From E and nu alone.
template <auto Factory>
AnyLaw made_by(const MaterialParameters& p) {
  return Factory(p.young_modulus, p.poisson_ratio);
}

/// All laws, in the order of MaterialLaw: the default first.
inline constexpr std::array law_table{
    LawChoice{MaterialLaw::neo_hookean, "neo_hookean", "neo-Hookean, lambda/2 (ln J)^2 for the volume", "",
              made_by<neo_hookean>},
    LawChoice{MaterialLaw::neo_hookean_quadratic, "neo_hookean_quadratic",
              "neo-Hookean, lambda/2 (J - 1)^2 for the volume: faster, softer when crushed", "",
              made_by<neo_hookean_quadratic>},
    LawChoice{MaterialLaw::hencky, "hencky", "Hooke's law in logarithmic strains", "", made_by<hencky>},
    LawChoice{MaterialLaw::corotated, "corotated", "Hooke's law in the turned frame", "", made_by<corotated>},
    LawChoice{
        MaterialLaw::small_strain_hooke, "small_strain_hooke", "Hooke's law in the small strain",
        "small_strain_hooke takes what a grain turns during the run for a strain of 1 - cos(angle), 1.5 "
        "% at 10 degrees: only for grains that hardly turn and deform little",
        made_by<small_strain_hooke>},
    LawChoice{MaterialLaw::st_venant_kirchhoff, "st_venant_kirchhoff", "Hooke's law in Green's strain",
              "st_venant_kirchhoff softens under compression and turns points inside out in dense packings: "
              "only to compare with the paper's Fig. 1",
              made_by<st_venant_kirchhoff>},
    LawChoice{MaterialLaw::yeoh,
              "yeoh",
              "Yeoh's law of filled rubber: neo-Hookean, with c20 and c30",
              "",
              [](const MaterialParameters& p) -> AnyLaw {
                return yeoh(p.young_modulus, p.poisson_ratio, p.c20, p.c30);
              },
              {&MaterialParameters::c20, &MaterialParameters::c30}},
    LawChoice{MaterialLaw::von_mises,
              "von_mises",
              "metal: elastic as hencky, flows at von Mises' stress yield_stress, hardens, resists a rate",
              "",
              [](const MaterialParameters& p) -> AnyLaw {
                const FlowRule rule{.yield_stress = p.yield_stress,
                                    .hardening = p.hardening_modulus,
                                    .saturation = p.saturation_stress,
                                    .rate = p.saturation_rate,
                                    .viscosity = p.viscosity};
                if (p.kinematic_modulus == 0) return von_mises(p.young_modulus, p.poisson_ratio, rule);
                return von_mises_kinematic(p.young_modulus, p.poisson_ratio, p.kinematic_modulus, rule);
              },
              {&MaterialParameters::yield_stress, &MaterialParameters::hardening_modulus,
               &MaterialParameters::kinematic_modulus, &MaterialParameters::saturation_stress,
               &MaterialParameters::saturation_rate, &MaterialParameters::viscosity}},
    LawChoice{MaterialLaw::mooney_rivlin,
              "mooney_rivlin",
              "Mooney and Rivlin's law of rubber: neo-Hookean, with c01 of the second invariant",
              "",
              [](const MaterialParameters& p) -> AnyLaw {
                return mooney_rivlin(p.young_modulus, p.poisson_ratio, p.c01);
              },
              {&MaterialParameters::c01}},
    LawChoice{MaterialLaw::ogden,
              "ogden",
              "Ogden's law of rubber: up to three powers of the stretches",
              "",
              [](const MaterialParameters& p) -> AnyLaw {
                return ogden(p.young_modulus, p.poisson_ratio,
                             {p.ogden_exponent_1, p.ogden_exponent_2, p.ogden_exponent_3}, p.ogden_share_2,
                             p.ogden_share_3);
              },
              {&MaterialParameters::ogden_exponent_1, &MaterialParameters::ogden_exponent_2,
               &MaterialParameters::ogden_exponent_3, &MaterialParameters::ogden_share_2,
               &MaterialParameters::ogden_share_3}},
    LawChoice{MaterialLaw::norton,
              "norton",
              "creeps: elastic as hencky, flows at the rate creep_rate (stress/creep_stress)^creep_exponent",
              "",
              [](const MaterialParameters& p) -> AnyLaw {
                const Lame elastic = lame(p.young_modulus, p.poisson_ratio);
                return VonMises{elastic.lambda + 2.0 / 3.0 * elastic.mu, elastic.mu,
                                creep_rule(p.creep_rate, p.creep_stress, p.creep_exponent)};
              },
              {&MaterialParameters::creep_rate, &MaterialParameters::creep_stress,
               &MaterialParameters::creep_exponent}},
    LawChoice{
        MaterialLaw::prony,
        "prony",
        "relaxes: elastic as hencky at once, of which shares of the shear modulus fade with their times",
        "",
        [](const MaterialParameters& p) -> AnyLaw {
          return prony(
              p.young_modulus, p.poisson_ratio,
              {p.relaxation_share_1, p.relaxation_share_2, p.relaxation_share_3, p.relaxation_share_4},
              {p.relaxation_time_1, p.relaxation_time_2, p.relaxation_time_3, p.relaxation_time_4});
        },
        {&MaterialParameters::relaxation_share_1, &MaterialParameters::relaxation_time_1,
         &MaterialParameters::relaxation_share_2, &MaterialParameters::relaxation_time_2,
         &MaterialParameters::relaxation_share_3, &MaterialParameters::relaxation_time_3,
         &MaterialParameters::relaxation_share_4, &MaterialParameters::relaxation_time_4}},
};

constexpr const auto& law_choices() { return law_table; }
constexpr const LawChoice& law_choice(MaterialLaw law) { return law_table[static_cast<std::size_t>(law)]; }

/// True for laws that remember: they flow, creep or relax.
bool has_history(const AnyLaw& law);

/// Of pressure waves in the unstrained material [m/s].
double wave_speed(const AnyLaw& law, double density);

/// Raises UsageError for parameters that the law cannot have.
inline AnyLaw make_law(MaterialLaw law, const MaterialParameters& parameters) {
  return law_choice(law).make(parameters);
}
/// Of E [Pa] and nu, the other parameters as they are where nothing is said of them.
inline AnyLaw make_law(MaterialLaw law, double E, double nu) {
  return make_law(law, {.young_modulus = E, .poisson_ratio = nu});
}

}  // namespace softgrain
