#pragma once
#include <array>
#include <limits>
#include <string_view>

namespace softgrain {

/// The laws that a grain can be made of; law_choices() (any_law.hpp) holds one entry for each, in this order.
enum class MaterialLaw {
  neo_hookean,
  neo_hookean_quadratic,
  hencky,
  corotated,
  small_strain_hooke,
  st_venant_kirchhoff,
  yeoh,
  von_mises,
};

/// The numbers that laws are made from, in SI. Each law takes those that its LawChoice names.
struct MaterialParameters {
  double young_modulus = 10e6;   ///< E [Pa]
  double poisson_ratio = 0.45;   ///< nu [-]
  double c20 = 0;                ///< Yeoh's second coefficient [Pa]
  double c30 = 0;                ///< and the third [Pa]
  double yield_stress = 0;       ///< sigma_y [Pa]; what flows needs one
  double hardening_modulus = 0;  ///< H [Pa]
  double saturation_stress = 0;  ///< Q of Voce's hardening [Pa]
  double saturation_rate = 0;    ///< and its b [-]
  double viscosity = 0;          ///< eta of Perzyna's flow [Pa s]
};

/// One of them, as case files know it: keys mpm.NAME and kind.law.NAME.
struct MaterialParameter {
  double MaterialParameters::*value;
  std::string_view name;
  std::string_view unit;  ///< in which people write it
  double low, high;       ///< it lies between them; `high` is excluded
  bool from_low;          ///< `low` itself is allowed
  std::string_view text;
};

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

inline constexpr std::array material_parameters{
    MaterialParameter{&MaterialParameters::young_modulus, "young_modulus", "MPa", 0, unbounded, false,
                      "Young's modulus E"},
    MaterialParameter{&MaterialParameters::poisson_ratio, "poisson_ratio", "", -1, 0.5, false,
                      "Poisson's ratio nu"},
    MaterialParameter{&MaterialParameters::c20, "c20", "MPa", -unbounded, unbounded, false,
                      "coefficient C_20 of (I_1 - 3)^2; C_10 is E/(4 (1 + nu))"},
    MaterialParameter{&MaterialParameters::c30, "c30", "MPa", -unbounded, unbounded, false,
                      "coefficient C_30 of (I_1 - 3)^3"},
    MaterialParameter{&MaterialParameters::yield_stress, "yield_stress", "MPa", 0, unbounded, true,
                      "yield stress in tension; a law that flows needs one"},
    MaterialParameter{&MaterialParameters::hardening_modulus, "hardening_modulus", "MPa", 0, unbounded, true,
                      "rise H of the yield stress per plastic strain alpha; 0: perfect plasticity"},
    MaterialParameter{
        &MaterialParameters::saturation_stress, "saturation_stress", "MPa", 0, unbounded, true,
        "Voce's Q: the yield stress rises by Q (1 - exp(-saturation_rate alpha)) too; 0: it does not"},
    MaterialParameter{&MaterialParameters::saturation_rate, "saturation_rate", "", 0, unbounded, true,
                      "of Voce's hardening, over plastic strain"},
    MaterialParameter{
        &MaterialParameters::viscosity, "viscosity", "Pa s", 0, unbounded, true,
        "stress beyond the yield stress over the rate of plastic strain; 0: the rate does not matter"},
};

}  // namespace softgrain
