#include "softgrain/soft/solid_equilibrium.hpp"

#include <limits>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/brick_in_lanes.hpp"
#include "softgrain/soft/brick_state.hpp"
#include "softgrain/soft/law_at_points.hpp"

namespace softgrain {
namespace {

using WideSolid = Mat<3, Wide>;

/// Laws that work in space and in grains that turn.
template <class Law>
constexpr bool is_solid() {
  if constexpr (SplitLaw<Law, 3> || SplitHistoryLaw<Law, 3>)
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

/// With P of the deviatoric part of the law at point p: deviatoric(cell, p).
template <class Law, class Deviatoric>
[[gnu::always_inline]] inline unsigned force_of_points(const Law& law, bool mean_dilatation,
                                                       const SolidBatch& batch, WidePlaces<3>& force,
                                                       const Deviatoric& deviatoric) {
  std::fill(force.begin(), force.end(), Vec<3, Wide>{});
  const Wide square = batch.radius * batch.radius;
  Wide least = 1.0;
  for_each_cell(batch, [&](const BrickState& cell) {
    const std::array<Wide, 8> theta = cell.thetas(law, mean_dilatation);
    const std::array<Wide, 8> pressure = BrickState::of_each(
        theta, mean_dilatation, [&](const Wide& of) { return law.volume().derivative(of); });
    for (std::size_t p = 0; p < 8; ++p) {
      const WideSolid& F = cell.F[p];
      const Wide J = determinant(F);
      least = select(J > 0.0, least, J);
      const WideSolid P = deviatoric(cell, static_cast<int>(p)) + pressure[p] * law.dilatation().gradient(F);
      for (std::size_t a = 0; a < 8; ++a) {
        const Vec<3> g = cell.points[p].volume * cell.points[p].gradient[a];
        Vec<3, Wide>& f = force[static_cast<std::size_t>(cell.nodes[a])];
        for (int i = 0; i < 3; ++i) f[i] += square * (P(i, 0) * g[0] + P(i, 1) * g[1] + P(i, 2) * g[2]);
      }
    }
  });
  return lanes_without(least);
}

/// Before anything flows.
template <class Law>
[[gnu::flatten]] unsigned force_of(const Law& law, bool mean_dilatation, const SolidBatch& batch,
                                   WidePlaces<3>& force) {
  const LawAtPoints<Law, 3> at(law, batch, 0);
  return force_of_points(law, mean_dilatation, batch, force,
                         [&](const BrickState& cell, int p) { return at.stress_without_flow(cell, p); });
}

template <class Law>
requires HistoryLaw<Law, 3>
[[gnu::flatten]] unsigned force_and_history_of(const Law& law, bool mean_dilatation, SolidBatch& batch,
                                               double dt, WidePlaces<3>& force, FlowOfStep& flow) {
  HistoryOfStep<Law, 3> step(batch);
  const LawAtPoints<Law, 3> at(law, batch, dt);
  const unsigned inverted =
      force_of_points(law, mean_dilatation, batch, force, [&](const BrickState& cell, int p) {
        const auto before = at.history(cell, p);
        const auto [P, advanced] = law.deviatoric().stress_and_advance(cell.F[p], before, dt);
        step.keep(cell, p, before, advanced);
        return P;
      });
  flow = step.sum();
  return inverted;
}

template <class Law>
[[gnu::flatten]] Wide energy_of(const Law& law, bool mean_dilatation, const SolidBatch& batch) {
  const LawAtPoints<Law, 3> at(law, batch, 0);
  Wide sum = 0.0;
  for_each_cell(batch, [&](const BrickState& cell) {
    const std::array<Wide, 8> theta = cell.thetas(law, mean_dilatation);
    const std::array<Wide, 8> U =
        BrickState::of_each(theta, mean_dilatation, [&](const Wide& of) { return law.volume().energy(of); });
    for (std::size_t p = 0; p < 8; ++p)
      sum += Wide(cell.points[p].volume) * (at.stored(cell, static_cast<int>(p)) + U[p]);
  });
  return sum * body_unit<3>(batch.radius);
}

}  // namespace

void require_solid(const GrainMaterial& material) {
  if (material.rigid) return;
  std::visit(
      []<class Law>(const Law&) {
        require(is_solid<Law>(),
                "not yet: this mpm.law knows no grains in space; take neo_hookean, another elastic "
                "and objective one, prony, norton, or von_mises without kinematic_modulus");
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

unsigned internal_force_and_history(const SolidGrains& grains, SolidBatch& batch, WidePlaces<3>& force,
                                    double dt, FlowOfStep& flow) {
  force.resize(batch.position.size());
  const bool mean = grains.material(batch.kind).mean_dilatation;
  return std::visit(
      [&]<class Law>(const Law& law) -> unsigned {
        if constexpr (HistoryLaw<Law, 3>)
          return force_and_history_of(law, mean, batch, dt, force, flow);
        else
          return internal_force(grains, batch, force);
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
