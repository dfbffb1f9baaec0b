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
};

/// The numbers that laws are made from, in SI. Each law takes those that its LawChoice names.
struct MaterialParameters {
  double young_modulus = 10e6;  ///< E [Pa]
  double poisson_ratio = 0.45;  ///< nu [-]
  double c20 = 0;               ///< Yeoh's second coefficient [Pa]
  double c30 = 0;               ///< and the third [Pa]
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
};

}  // namespace softgrain
