#include "softgrain/observe/packing_measures.hpp"

#include <vector>

#include "softgrain/observe/energy.hpp"
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
                           .stress = contact_stress(packing.contacts, packing.centre, area) + motion,
                           .numbers = {}};
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
  const double pressure = touching ? trace(measures.stress) / 2 : 0;
  measures.numbers = {
      {"sides", mean_sides(network, perimeter)},
      {"stress_kinetic", trace(motion) / 2},
      {"inertial_number", inertial_number(packing.strain_rate, diameter, packing.density, pressure)},
      {"circularity", circularity},
      {"aspect_ratio", aspect_ratio}};
  return measures;
}

}  // namespace softgrain
