#pragma once
#include <array>
#include <string_view>
#include <variant>

#include "softgrain/material/corotated.hpp"
#include "softgrain/material/hencky.hpp"
#include "softgrain/material/material_law.hpp"
#include "softgrain/material/neo_hookean.hpp"
#include "softgrain/material/small_strain_hooke.hpp"
#include "softgrain/material/st_venant_kirchhoff.hpp"

namespace softgrain {

/// A law chosen at run time: std::visit it once outside the loop over points.
using AnyLaw = std::variant<NeoHookean<LogVolume>, NeoHookean<QuadraticVolume>, Hencky, Corotated,
                            SmallStrainHooke, StVenantKirchhoff>;

/// A law and its name in case files.
struct LawChoice {
  MaterialLaw law;
  std::string_view name;
  std::string_view text;     ///< what it is, for the documentation of the key
  std::string_view caution;  ///< what the program tells the user who chooses it; empty: nothing
  AnyLaw (*make)(double E, double nu);
};

/// All laws, in the order of MaterialLaw: the default first.
const std::array<LawChoice, 6>& law_choices();

const LawChoice& law_choice(MaterialLaw law);

/// The law from Young's modulus E [Pa] and Poisson's ratio nu; UsageError as lame.
AnyLaw make_law(MaterialLaw law, double E, double nu);

}  // namespace softgrain
