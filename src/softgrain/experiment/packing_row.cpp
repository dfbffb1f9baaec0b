#include "softgrain/experiment/packing_row.hpp"

#include "softgrain/math/tensor.hpp"
#include "softgrain/observe/energy.hpp"
#include "softgrain/observe/fabric.hpp"
#include "softgrain/observe/grain_shape.hpp"
#include "softgrain/observe/packing.hpp"
#include "softgrain/observe/stress.hpp"

namespace softgrain {

std::vector<Quantity> packing_row(const PackingView& packing) {
  const double area = packing.width * packing.height;
  const auto grains = static_cast<int>(packing.radius.size());
  const PackingFraction phi = packing_fraction(packing.radius, packing.grain_area, area);
  const ContactNetwork network = contact_network(packing.contacts, grains);
  const Coordination neighbours = coordination(network);
  const Mat<2> motion = kinetic_stress(packing.mass, packing.velocity, area);
  const Mat<2> sigma = contact_stress(packing.contacts, packing.centre, area) + motion;
  const bool touching = !network.pairs.empty() || !network.walls.empty();
  std::vector<double> perimeter;
  double circularity = 0, aspect_ratio = 0, diameter = 0;
  for (int g = 0; g < grains; ++g) {
    const int begin = packing.outline_begin[g];
    const GrainShape shape =
        grain_shape(packing.outline.subspan(begin, packing.outline_begin[g + 1] - begin));
    perimeter.push_back(shape.perimeter);
    circularity += shape.circularity / grains;
    aspect_ratio += shape.aspect_ratio / grains;
    diameter += 2 * packing.radius[g] / grains;
  }
  return {
      {"phi_0", "", phi.undeformed},
      {"phi", "", phi.deformed},
      {"area_ratio", "", phi.deformed / phi.undeformed},
      {"z", "", neighbours.z},
      {"z_no_rattlers", "", neighbours.z_no_rattlers},
      {"rattlers", "", neighbours.rattlers},
      {"z_with_walls", "", neighbours.z_with_walls},
      {"z_backbone", "", neighbours.z_backbone},
      {"backbone", "", neighbours.backbone},
      {"sides", "", mean_sides(network, perimeter)},
      {"stress_xx", "Pa", sigma(0, 0)},
      {"stress_yy", "Pa", sigma(1, 1)},
      {"stress_xy", "Pa", (sigma(0, 1) + sigma(1, 0)) / 2},
      {"stress_kinetic", "Pa", trace(motion) / 2},
      {"inertial_number", "",
       inertial_number(packing.strain_rate, diameter, packing.density, touching ? trace(sigma) / 2 : 0)},
      {"anisotropy", "", fabric(network.pairs).anisotropy},
      {"force_mean", "N/m", force_distribution(network.pairs).mean},
      {"circularity", "", circularity},
      {"aspect_ratio", "", aspect_ratio},
  };
}

}  // namespace softgrain
