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
                           .stress = contact_stress(packing.contacts, packing.centre, area) + motion,
                           .stress_kinetic = trace(motion) / 2};
  const ContactNetwork& network = measures.network;
  measures.coordination = coordination(network);
  std::vector<double> perimeter;
  double diameter = 0;
  for (int g = 0; g < grains; ++g) {
    const int begin = packing.outline_begin[g];
    const GrainShape shape =
        grain_shape(packing.outline.subspan(begin, packing.outline_begin[g + 1] - begin));
    perimeter.push_back(shape.perimeter);
    measures.circularity += shape.circularity / grains;
    measures.aspect_ratio += shape.aspect_ratio / grains;
    diameter += 2 * packing.radius[g] / grains;
  }
  measures.sides = mean_sides(network, perimeter);
  const bool touching = !network.pairs.empty() || !network.walls.empty();
  measures.inertial_number = inertial_number(packing.strain_rate, diameter, packing.density,
                                             touching ? trace(measures.stress) / 2 : 0);
  return measures;
}

}  // namespace softgrain
