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
  mooney_rivlin,
  ogden,
  norton,
  prony,
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
  double kinematic_modulus = 0;  ///< H_k [Pa]
  double c01 = 0;                ///< Mooney and Rivlin's second coefficient [Pa]
  double ogden_exponent_1 = 2, ogden_exponent_2 = 4, ogden_exponent_3 = -2;  ///< alpha_p [-]
  double ogden_share_2 = 0, ogden_share_3 = 0;  ///< of the shear modulus; the first term has the rest
  double creep_rate = 0;                        ///< A of Norton's creep [1/s]
  double creep_stress = 0;                      ///< sigma_0 [Pa]
  double creep_exponent = 1;                    ///< n [-]
  double relaxation_share_1 = 0, relaxation_share_2 = 0;  ///< g_i of Prony's series [-]
  double relaxation_share_3 = 0, relaxation_share_4 = 0;
  double relaxation_time_1 = 0, relaxation_time_2 = 0;  ///< tau_i [s]
  double relaxation_time_3 = 0, relaxation_time_4 = 0;
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
    MaterialParameter{
        &MaterialParameters::kinematic_modulus, "kinematic_modulus", "MPa", 0, unbounded, true,
        "rise H_k of the back stress per plastic strain; 0: the material hardens alike both ways"},
    MaterialParameter{&MaterialParameters::c01, "c01", "MPa", 0, unbounded, true,
                      "coefficient C_01 of (I_2 - 3); C_10 is E/(4 (1 + nu)) - C_01"},
    MaterialParameter{&MaterialParameters::ogden_exponent_1, "ogden_exponent_1", "", -20, 20, true,
                      "exponent alpha_1 of Ogden's term 1"},
    MaterialParameter{&MaterialParameters::ogden_exponent_2, "ogden_exponent_2", "", -20, 20, true,
                      "exponent alpha_2 of Ogden's term 2"},
    MaterialParameter{&MaterialParameters::ogden_exponent_3, "ogden_exponent_3", "", -20, 20, true,
                      "exponent alpha_3 of Ogden's term 3"},
    MaterialParameter{&MaterialParameters::ogden_share_2, "ogden_share_2", "", 0, 1, true,
                      "share of Ogden's term 2 in the shear modulus; the first term has the rest"},
    MaterialParameter{&MaterialParameters::ogden_share_3, "ogden_share_3", "", 0, 1, true,
                      "share of Ogden's term 3 in the shear modulus; the first term has the rest"},
    MaterialParameter{&MaterialParameters::creep_rate, "creep_rate", "1/s", 0, unbounded, true,
                      "rate of plastic strain at the von Mises stress creep_stress; what creeps needs one"},
    MaterialParameter{&MaterialParameters::creep_stress, "creep_stress", "MPa", 0, unbounded, true,
                      "von Mises stress at which the material creeps with creep_rate; what creeps needs one"},
    MaterialParameter{&MaterialParameters::creep_exponent, "creep_exponent", "", 1, 100, true,
                      "n: the rate of creep grows as the stress to the power of n; 1: a Maxwell fluid"},
    MaterialParameter{&MaterialParameters::relaxation_share_1, "relaxation_share_1", "", 0, 1, true,
                      "share of the shear modulus that relaxes with relaxation_time_1"},
    MaterialParameter{&MaterialParameters::relaxation_time_1, "relaxation_time_1", "s", 0, unbounded, true,
                      "time in which the stress of that share falls to 1/e at rest"},
    MaterialParameter{&MaterialParameters::relaxation_share_2, "relaxation_share_2", "", 0, 1, true,
                      "share of the shear modulus that relaxes with relaxation_time_2"},
    MaterialParameter{&MaterialParameters::relaxation_time_2, "relaxation_time_2", "s", 0, unbounded, true,
                      "time in which the stress of that share falls to 1/e at rest"},
    MaterialParameter{&MaterialParameters::relaxation_share_3, "relaxation_share_3", "", 0, 1, true,
                      "share of the shear modulus that relaxes with relaxation_time_3"},
    MaterialParameter{&MaterialParameters::relaxation_time_3, "relaxation_time_3", "s", 0, unbounded, true,
                      "time in which the stress of that share falls to 1/e at rest"},
    MaterialParameter{&MaterialParameters::relaxation_share_4, "relaxation_share_4", "", 0, 1, true,
                      "share of the shear modulus that relaxes with relaxation_time_4"},
    MaterialParameter{&MaterialParameters::relaxation_time_4, "relaxation_time_4", "s", 0, unbounded, true,
                      "time in which the stress of that share falls to 1/e at rest"},
};

}  // namespace softgrain
