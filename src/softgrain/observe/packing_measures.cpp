#include "softgrain/observe/packing_measures.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "softgrain/observe/energy.hpp"
#include "softgrain/observe/fabric.hpp"
#include "softgrain/observe/grain_shape.hpp"
#include "softgrain/observe/stress.hpp"

namespace softgrain {

PackingMeasures measure_packing(const PackingView& packing) {
  const double area = packing.width * packing.height;
  const auto grains = static_cast<int>(packing.radius.size());
  const Mat<2> motion = kinetic_stress(packing.mass, packing.velocity, area);
  PackingMeasures measures{.network = contact_network(packing.contacts, grains),
                           .phi = packing_fraction(packing.radius, packing.grain_area, area),
                           .coordination = {},
                           .stress = {},
                           .numbers = {}};
  const Mat<2> stress = contact_stress(packing.contacts, packing.centre, area) + motion;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) measures.stress(i, j) = stress(i, j);
  const ContactNetwork& network = measures.network;
  measures.coordination = coordination(network);
  std::vector<double> perimeter;
  double diameter = 0, circularity = 0, aspect_ratio = 0;
  for (int g = 0; g < grains; ++g) {
    const int begin = packing.outline_begin[g];
    const GrainShape shape =
        grain_shape(packing.outline.subspan(begin, packing.outline_begin[g + 1] - begin));
    perimeter.push_back(shape.perimeter);
    circularity += shape.circularity / grains;
    aspect_ratio += shape.aspect_ratio / grains;
    diameter += 2 * packing.radius[g] / grains;
  }
  const bool touching = !network.pairs.empty() || !network.walls.empty();
  const double pressure = touching ? trace(stress) / 2 : 0;
  measures.numbers = {
      {"sides", mean_sides(network, perimeter)},
      {"stress_kinetic", trace(motion) / 2},
      {"inertial_number", inertial_number(packing.strain_rate, diameter, packing.density, pressure)},
      {"circularity", circularity},
      {"aspect_ratio", aspect_ratio},
      {"anisotropy", fabric(network.pairs).anisotropy},
      {"force_mean", force_distribution(network.pairs).mean}};
  return measures;
}

PackingMeasures measure_packing(const SolidPackingView& packing) {
  const auto grains = static_cast<int>(packing.radius.size());
  const ContactNetworkOf<3> network = contact_network(packing.contacts, grains);
  const Mat<3> motion = kinetic_stress(packing.mass, packing.velocity, packing.volume);
  PackingMeasures measures{
      .network = {},
      .phi = {},
      .coordination = coordination(network),
      .stress = contact_stress(packing.contacts, packing.centre, packing.volume) + motion,
      .numbers = {}};
  double diameter = 0, sphericity = 0;
  for (int g = 0; g < grains; ++g) {
    const double R = packing.radius[g];
    const auto [volume, area] = packing.surface[g];
    diameter += 2 * R / grains;
    sphericity += std::cbrt(36 * std::numbers::pi * volume * volume) / area / grains;
    measures.phi.undeformed += 4 * std::numbers::pi / 3 * R * R * R / packing.volume;
    measures.phi.deformed += volume / packing.volume;
  }
  double force = 0;
  for (const auto& pair : network.pairs) force += pair.normal_force;
  const bool touching = !network.pairs.empty() || !network.walls.empty();
  const double pressure = touching ? trace(measures.stress) / 3 : 0;
  measures.numbers = {
      {"stress_kinetic", trace(motion) / 3},
      {"inertial_number", inertial_number(packing.strain_rate, diameter, packing.density, pressure)},
      {"sphericity", sphericity},
      {"force_mean", network.pairs.empty() ? 0 : force / static_cast<double>(network.pairs.size())}};
  return measures;
}

}  // namespace softgrain
