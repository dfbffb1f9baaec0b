#include "softgrain/experiment/diametral_path.hpp"

#include <cmath>

namespace softgrain {

double plate_travel(double strain, double grain_radius) { return 2 * grain_radius * (1 - std::exp(-strain)); }

double grain_strain(double travel, double grain_radius) { return -std::log1p(-travel / (2 * grain_radius)); }

DiametralPath::DiametralPath(const Case::Loading& loading, double grain_radius, double dt)
    : radius_(grain_radius), legs_(loading, dt, loading.max_strain, [&](double strain) {
        return plate_travel(strain, grain_radius);
      }) {}

}  // namespace softgrain
