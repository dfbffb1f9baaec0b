#pragma once

namespace softgrain {

/// The laws that a grain can be made of; law_choices() (any_law.hpp) holds one entry for each, in this order.
enum class MaterialLaw {
  neo_hookean,
  neo_hookean_quadratic,
  hencky,
  corotated,
  small_strain_hooke,
  st_venant_kirchhoff,
};

}  // namespace softgrain
