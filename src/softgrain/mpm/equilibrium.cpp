#include "softgrain/mpm/equilibrium.hpp"

#include <limits>
#include <variant>

#include "softgrain/material/elastic_law.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/mpm/cell_in_lanes.hpp"

namespace softgrain {
namespace {

using WideMat = Mat<2, Wide>;

/// The four points of a cell in the eight grains: F of each.
struct CellState {
  CellState(const GrainBatch& batch, int cell_index)
      : cell(batch.topology->grid.cell[cell_index]), points(&batch.topology->points[4 * cell_index]) {
    // F = sum_a x_a (x) dN_a/dX = sum_(a > 0) (x_a - x_0) (x) dN_a/dX, as sum_a N_a = 1
    const Wide inverse_radius = 1.0 / batch.radius;
    std::array<Vec<2, Wide>, 4> edge;
    for (int a = 1; a < 4; ++a)
      edge[a] = inverse_radius * (batch.position[cell[a]] - batch.position[cell[0]]);
    for (int p = 0; p < 4; ++p) {
      const auto& g = points[p].gradient;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          F[p](i, j) = edge[1][i] * g[1][j] + edge[2][i] * g[2][j] + edge[3][i] * g[3][j];
    }
  }
  /// Mean J of the cell, weighted by volume.
  Wide mean_dilatation(double& volume) const {
    Wide sum = 0.0;
    volume = 0;
    for (int p = 0; p < 4; ++p) sum += points[p].volume * determinant(F[p]), volume += points[p].volume;
    return sum * Wide(1 / volume);
  }

  const std::array<int, 4>& cell;
  const MaterialPoint* points;
  std::array<WideMat, 4> F;
};

/// The lanes in which some J was not positive.
class InvertedLanes {
 public:
  void note(const Wide& J) { some_ = select(J > 0.0, some_, J); }
  unsigned lanes() const {
    unsigned found = 0;
    for (int lane = 0; lane < Wide::size; ++lane)
      if (!(some_[lane] > 0)) found |= 1u << lane;
    return found;
  }

 private:
  Wide some_ = 1.0;  // a J that is not positive, else 1
};

/// Forces on the nodes of a cell; that on the first balances the others.
class CellForce {
 public:
  /// V P . dN_a/dX of the first point (not zero and then `add`: clearing took a tenth of the time)
  CellForce(const WideMat& P, const MaterialPoint& point) {
    for (int a = 1; a < 4; ++a) node_[a] = of_point(P, point, a);
  }
  void add(const WideMat& P, const MaterialPoint& point) {
    for (int a = 1; a < 4; ++a) node_[a] += of_point(P, point, a);
  }
  /// With R^2 of the volume and 1/R of the gradient.
  void add_to(WideVectors& force, const std::array<int, 4>& cell, Wide radius) {
    for (int a = 1; a < 4; ++a) {
      node_[a] *= radius;
      force[cell[a]] += node_[a];
      force[cell[0]] -= node_[a];
    }
  }

 private:
  static Vec<2, Wide> of_point(const WideMat& P, const MaterialPoint& point, int a) {
    const Vec<2> g = point.volume * point.gradient[a];
    return {P(0, 0) * g[0] + P(0, 1) * g[1], P(1, 0) * g[0] + P(1, 1) * g[1]};
  }
  std::array<Vec<2, Wide>, 4> node_;
};

template <class Law>
CellForce cell_force(const Law& law, const CellState& state, InvertedLanes& inverted) {
  const auto stress = [&](int p) {
    if (Law::needs_positive_J) inverted.note(determinant(state.F[p]));
    return law.stress(state.F[p]);
  };
  CellForce force(stress(0), state.points[0]);
  for (int p = 1; p < 4; ++p) force.add(stress(p), state.points[p]);
  return force;
}

/// With P = dpsi_dev/dF + U'(mean J) cof F.
template <class Law>
CellForce cell_force_mean_dilatation(const Law& law, const CellState& state, InvertedLanes& inverted) {
  double volume = 0;
  const Wide J = state.mean_dilatation(volume);
  const Wide pressure = law.volume().derivative(J);
  inverted.note(J);
  CellForce force = cell_force(law.deviatoric(), state, inverted);
  for (int p = 0; p < 4; ++p) force.add(pressure * cofactor(state.F[p]), state.points[p]);
  return force;
}

template <HasCofactorFactors Law>
unsigned add_forces_of_cells(const Law& law, bool mean_dilatation, const GrainBatch& batch,
                             WideVectors& force) {
  const Topology& topology = *batch.topology;
  const Wide inverse_square_radius = 1.0 / (batch.radius * batch.radius);
  InvertedLanes inverted;
  for (std::size_t c = 0; c < topology.grid.cell.size(); ++c) {
    const std::array<int, 4>& nodes = topology.grid.cell[c];
    const CellShape& shape = topology.cell_shapes[c];
    const CellInLanes cell(batch.position, nodes);
    const std::array<Wide, 4> J = cell.J(shape, inverse_square_radius);
    for (const Wide& of_point : J) inverted.note(of_point);
    cell.add_force(shape, law.mu,
                   mean_dilatation ? factors_of_mean_dilatation(law, &topology.points[4 * c], J)
                                   : law.cofactor_factors(J),
                   nodes, force);
  }
  return inverted.lanes();
}

/// The ten blocks K_ab, b <= a, of a cell.
using CellStiffness = std::array<std::array<Wide, 4>, 10>;

/// K_ab += V g_a . A . g_b
void add_point_stiffness(const Mat<4, Wide>& A, const MaterialPoint& point, CellStiffness& K) {
  int pair = 0;
  for (int a = 0; a < 4; ++a) {
    const Vec<2>& g_a = point.gradient[a];
    std::array<Wide, 8> row;  // V sum_J A_iJkL g_a,J at 4 i + 2 k + L
    for (int i = 0; i < 2; ++i)
      for (int kL = 0; kL < 4; ++kL)
        row[4 * i + kL] = point.volume * (g_a[0] * A(2 * i, kL) + g_a[1] * A(2 * i + 1, kL));
    for (int b = 0; b <= a; ++b, ++pair) {
      const Vec<2>& g_b = point.gradient[b];
      for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k)
          K[pair][2 * i + k] += row[4 * i + 2 * k] * g_b[0] + row[4 * i + 2 * k + 1] * g_b[1];
    }
  }
}

template <class Law>
void cell_stiffness(const Law& law, const CellState& state, CellStiffness& K) {
  for (int p = 0; p < 4; ++p) add_point_stiffness(law.tangent(state.F[p]), state.points[p], K);
}

template <class Law>
void cell_stiffness_mean_dilatation(const Law& law, const CellState& state, CellStiffness& K) {
  double volume = 0;
  const Wide J = state.mean_dilatation(volume);
  const Wide pressure = law.volume().derivative(J);
  const Wide bulk = law.volume().second_derivative(J) * Wide(1 / volume);
  std::array<Vec<2, Wide>, 4> dJ{};  // sum_p V cof F . g_a
  for (int p = 0; p < 4; ++p) {
    Mat<4, Wide> A = law.deviatoric().tangent(state.F[p]);
    add_cofactor_derivative(A, pressure, state.F[p]);
    add_point_stiffness(A, state.points[p], K);
    const WideMat cof = cofactor(state.F[p]);
    for (int a = 0; a < 4; ++a) {
      const Vec<2>& g = state.points[p].gradient[a];
      for (int i = 0; i < 2; ++i) dJ[a][i] += state.points[p].volume * (cof(i, 0) * g[0] + cof(i, 1) * g[1]);
    }
  }
  int pair = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b <= a; ++b, ++pair)
      for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) K[pair][2 * i + k] += bulk * dJ[a][i] * dJ[b][k];
}

template <class Law>
Wide cell_energy(const Law& law, const CellState& state) {
  Wide sum = 0.0;
  for (int p = 0; p < 4; ++p) sum += state.points[p].volume * law.energy(state.F[p]);
  return sum;
}

}  // namespace

unsigned internal_force(const SoftGrains& grains, const GrainBatch& batch, WideVectors& force) {
  force.assign(batch.position.size(), {});
  return std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (HasCofactorFactors<Law>)
          return add_forces_of_cells(law, grains.mean_dilatation, batch, force);
        InvertedLanes inverted;
        for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell) {
          const CellState state(batch, cell);
          if constexpr (SplitLaw<Law, 2>) {
            if (grains.mean_dilatation) {
              cell_force_mean_dilatation(law, state, inverted).add_to(force, state.cell, batch.radius);
              continue;
            }
          }
          cell_force(law, state, inverted).add_to(force, state.cell, batch.radius);
        }
        return inverted.lanes();
      },
      grains.law);
}

void add_stiffness(const SoftGrains& grains, const GrainBatch& batch, BatchedCholesky& matrix) {
  std::visit(
      [&]<class Law>(const Law& law) {
        for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell) {
          const CellState state(batch, cell);
          CellStiffness K{};
          bool done = false;
          if constexpr (SplitLaw<Law, 2>) {
            if ((done = grains.mean_dilatation)) cell_stiffness_mean_dilatation(law, state, K);
          }
          if (!done) cell_stiffness(law, state, K);
          for (int pair = 0; pair < 10; ++pair) {
            const CellBlock& to = batch.topology->cell_blocks[10 * cell + pair];
            const auto& k = K[pair];
            matrix.add_block(to.block, to.transposed ? std::array<Wide, 4>{k[0], k[2], k[1], k[3]} : k);
          }
        }
      },
      grains.law);
}

Wide elastic_energy(const SoftGrains& grains, const GrainBatch& batch) {
  return std::visit(
      [&]<class Law>(const Law& law) {
        Wide sum = 0.0;
        for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell) {
          const CellState state(batch, cell);
          if constexpr (SplitLaw<Law, 2>) {
            if (grains.mean_dilatation) {
              double volume = 0;
              const Wide J = state.mean_dilatation(volume);
              sum += cell_energy(law.deviatoric(), state) + volume * law.volume().energy(J);
              continue;
            }
          }
          sum += cell_energy(law, state);
        }
        return sum * (batch.radius * batch.radius);
      },
      grains.law);
}

Wide least_J(const GrainBatch& batch) {
  Wide least = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell) {
    const CellState state(batch, cell);
    for (const WideMat& F : state.F) least = min(determinant(F), least);
  }
  return least;
}

std::vector<PointState> point_states(const SoftGrains& grains, int grain) {
  const auto place = grains.batch_of(grain);
  const GrainBatch* batch = place.first;  // not a structured binding: clang 14 keeps those out of lambdas
  const int lane = place.second;
  std::vector<PointState> states;
  std::visit(
      [&]<class Law>(const Law& law) {
        for (int cell = 0; cell < static_cast<int>(batch->topology->grid.cell.size()); ++cell) {
          const CellState state(*batch, cell);
          for (int p = 0; p < 4; ++p) {
            PointState point;
            for (int k = 0; k < 4; ++k) point.F.c[k] = state.F[p].c[k][lane];
            const double J = determinant(point.F);
            point.stress = (1 / J) * (law.stress(point.F) * transpose(point.F));
            point.pressure = -trace(point.stress) / 2;
            states.push_back(point);
          }
        }
      },
      grains.law);
  return states;
}

}  // namespace softgrain
