#include "softgrain/soft/solid_equilibrium.hpp"

#include <limits>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/brick_in_lanes.hpp"

namespace softgrain {
namespace {

using WideSolid = Mat<3, Wide>;

/// Laws that work in space and in grains that turn.
template <class Law>
constexpr bool is_solid() {
  if constexpr (SplitLaw<Law, 3>)
    return Law::objective;
  else
    return false;
}

/// Laws with P = mu F + h(J) cof F.
template <class Law>
concept HasBrickFactors = requires(const Law& law, const std::array<Wide, 8>& J) {
  { law.mu } -> std::convertible_to<double>;
  { law.cofactor_factors(J, J[0]) } -> std::same_as<std::array<Wide, 8>>;
  { law.cofactor_factors(J) } -> std::same_as<std::array<Wide, 8>>;
};

/// The lanes in which a number was not positive.
unsigned lanes_without(const Wide& positive) {
  unsigned found = 0;
  for (int lane = 0; lane < Wide::size; ++lane)
    if (!(positive[lane] > 0)) found |= 1u << lane;
  return found;
}

/// f_i = scale sum_j L_ij x_j = scale sum_(j != i) L_ij (x_j - x_i)
[[gnu::flatten]] void set_to_laplace(const LaplaceRows& L, const Wide& scale, const WidePlaces<3>& x,
                                     WidePlaces<3>& force) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec<3, Wide>& x_i = x[i];
    Vec<3, Wide> sum{};
    for (int k = L.begin[i]; k < L.begin[i + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      sum += Wide(L.weight[at]) * (x[static_cast<std::size_t>(L.column[at])] - x_i);
    }
    force[i] = scale * sum;
  }
}

/// The eight J of a cell, from 8 V_p J_p.
[[gnu::always_inline]] inline std::array<Wide, 8> dilatations(const std::array<Wide, 8>& det,
                                                              const BrickShape& shape,
                                                              const Wide& inverse_cube) {
  std::array<Wide, 8> J;
  for (std::size_t p = 0; p < 8; ++p) J[p] = det[p] * (shape.inverse_volume[p] * inverse_cube);
  return J;
}

template <HasBrickFactors Law>
[[gnu::flatten]] unsigned force_of(const Law& law, bool mean_dilatation, const SolidBatch& batch,
                                   WidePlaces<3>& force) {
  const SolidTopology& topology = *batch.topology;
  const Wide inverse_cube = 1.0 / body_unit<3>(batch.radius);
  set_to_laplace(topology.laplace, law.mu * batch.radius, batch.position, force);
  Wide least = 1.0;
  for (std::size_t c = 0; c < topology.grid.cell.size(); ++c) {
    const auto& nodes = topology.grid.cell[c];
    const BrickShape& shape = topology.cell_shapes[c];
    const BrickInLanes cell(batch.position, nodes);
    const std::array<Wide, 8> det = cell.determinants(), J = dilatations(det, shape, inverse_cube);
    for (const Wide& of_point : J)
      least = select(of_point < least, of_point, select(of_point > 0.0, least, of_point));
    if (mean_dilatation) {
      Wide sum = det[0];
      for (std::size_t p = 1; p < 8; ++p) sum += det[p];
      cell.add_force(law.cofactor_factors(J, sum * (shape.inverse_of_all * inverse_cube)), nodes, force);
    } else {
      cell.add_force(law.cofactor_factors(J), nodes, force);
    }
  }
  return lanes_without(least);
}

/// F of the eight points of a cell.
struct BrickState {
  BrickState(const SolidBatch& batch, std::size_t index)
      : nodes(batch.topology->grid.cell[index]), points(&batch.topology->points[8 * index]) {
    // F = sum_(a > 0) (x_a - x_0) (x) dN_a/dX, as sum_a N_a = 1
    const Wide inverse_radius = 1.0 / batch.radius;
    const auto x = [&](std::size_t a) { return batch.position[static_cast<std::size_t>(nodes[a])]; };
    for (std::size_t a = 1; a < 8; ++a) {
      const Vec<3, Wide> edge = inverse_radius * (x(a) - x(0));
      for (std::size_t p = 0; p < 8; ++p)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) F[p](i, j) += edge[i] * points[p].gradient[a][j];
    }
    for (std::size_t p = 0; p < 8; ++p) volume += points[p].volume;
  }

  /// U' belongs to the mean of theta, or to that of the point.
  template <class Law>
  std::array<Wide, 8> thetas(const Law& law, bool mean_dilatation) const {
    std::array<Wide, 8> theta;
    Wide mean = 0.0;
    for (std::size_t p = 0; p < 8; ++p) {
      theta[p] = law.dilatation().value(F[p]);
      mean += Wide(points[p].volume / volume) * theta[p];
    }
    if (mean_dilatation) theta.fill(mean);
    return theta;
  }

  const std::array<int, 8>& nodes;
  const SolidPoint* points;
  double volume = 0;  ///< [R^3]
  std::array<WideSolid, 8> F{};
};

template <class Law>
[[gnu::flatten]] unsigned force_of(const Law& law, bool mean_dilatation, const SolidBatch& batch,
                                   WidePlaces<3>& force) {
  std::fill(force.begin(), force.end(), Vec<3, Wide>{});
  const Wide square = batch.radius * batch.radius;
  Wide least = 1.0;
  for (std::size_t c = 0; c < batch.topology->grid.cell.size(); ++c) {
    const BrickState cell(batch, c);
    const std::array<Wide, 8> theta = cell.thetas(law, mean_dilatation);
    for (std::size_t p = 0; p < 8; ++p) {
      const WideSolid& F = cell.F[p];
      const Wide J = determinant(F);
      least = select(J > 0.0, least, J);
      const WideSolid P =
          law.deviatoric().stress(F) + law.volume().derivative(theta[p]) * law.dilatation().gradient(F);
      for (std::size_t a = 0; a < 8; ++a) {
        const Vec<3> g = cell.points[p].volume * cell.points[p].gradient[a];
        Vec<3, Wide>& f = force[static_cast<std::size_t>(cell.nodes[a])];
        for (int i = 0; i < 3; ++i) f[i] += square * (P(i, 0) * g[0] + P(i, 1) * g[1] + P(i, 2) * g[2]);
      }
    }
  }
  return lanes_without(least);
}

template <class Law>
[[gnu::flatten]] Wide energy_of(const Law& law, bool mean_dilatation, const SolidBatch& batch) {
  Wide sum = 0.0;
  for (std::size_t c = 0; c < batch.topology->grid.cell.size(); ++c) {
    const BrickState cell(batch, c);
    const std::array<Wide, 8> theta = cell.thetas(law, mean_dilatation);
    for (std::size_t p = 0; p < 8; ++p)
      sum +=
          Wide(cell.points[p].volume) * (law.deviatoric().energy(cell.F[p]) + law.volume().energy(theta[p]));
  }
  return sum * body_unit<3>(batch.radius);
}

}  // namespace

void require_solid(const GrainMaterial& material) {
  std::visit(
      []<class Law>(const Law&) {
        require(is_solid<Law>(),
                "not yet: this law of the material knows no grains in space; take neo_hookean, or another "
                "elastic and objective one");
      },
      material.law);
}

unsigned internal_force(const SolidGrains& grains, const SolidBatch& batch, WidePlaces<3>& force) {
  force.resize(batch.position.size());
  const bool mean = grains.material(batch.kind).mean_dilatation;
  return std::visit(
      [&]<class Law>(const Law& law) -> unsigned {
        if constexpr (is_solid<Law>())
          return force_of(law, mean, batch, force);
        else
          return 0xffu;
      },
      grains.law(batch));
}

Wide elastic_energy(const SolidGrains& grains, const SolidBatch& batch) {
  const bool mean = grains.material(batch.kind).mean_dilatation;
  return std::visit(
      [&]<class Law>(const Law& law) -> Wide {
        if constexpr (is_solid<Law>())
          return energy_of(law, mean, batch);
        else
          return std::numeric_limits<double>::quiet_NaN();
      },
      grains.law(batch));
}

Wide least_J(const SolidBatch& batch) {
  const Wide inverse_cube = 1.0 / body_unit<3>(batch.radius);
  Wide least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < batch.topology->grid.cell.size(); ++c) {
    const BrickInLanes cell(batch.position, batch.topology->grid.cell[c]);
    for (const Wide& J : dilatations(cell.determinants(), batch.topology->cell_shapes[c], inverse_cube))
      least = min(J, least);
  }
  return least;
}

}  // namespace softgrain
