#include "softgrain/soft/equilibrium.hpp"

#include <limits>
#include <variant>

#include "softgrain/soft/cell_in_lanes.hpp"
#include "softgrain/soft/law_at_points.hpp"

// flatten: without it g++ leaves sums of vectors as calls in the innermost loops, 2.7 times the time of a
// force

namespace softgrain {
namespace {

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
  /// f <- Q f
  void turn(const WideMat& Q) {
    for (int a = 1; a < 4; ++a) node_[a] = Q * node_[a];
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

/// P = dpsi_dev/dF + U'(mean theta) dtheta/dF at each point; deviatoric(p) is the first part.
template <class Law, class Deviatoric>
[[gnu::flatten]] CellForce cell_force(const Law& law, const CellState& state, InvertedLanes& inverted,
                                      const Deviatoric& deviatoric) {
  const auto theta = law.dilatation();
  const Wide pressure = law.volume().derivative(state.mean(theta));
  const auto stress = [&](int p) {
    inverted.note(determinant(state.F[p]));
    return deviatoric(p) + pressure * theta.gradient(state.F[p]);
  };
  CellForce force(stress(0), state.points[0]);
  for (int p = 1; p < 4; ++p) force.add(stress(p), state.points[p]);
  return force;
}

template <class Law>
unsigned add_forces(const Law& law, const GrainBatch& batch, double dt, WideVectors& force) {
  InvertedLanes inverted;
  const LawAtPoints<Law> at(law, batch, dt);
  for_each_cell(law, batch, [&](const CellState& state) {
    CellForce of_cell = cell_force(law, state, inverted, [&](int p) { return at.stress(state, p); });
    if (!Law::objective) of_cell.turn(placed_rotation(batch));
    of_cell.add_to(force, state.cell, batch.radius);
  });
  return inverted.lanes();
}

template <HasCofactorFactors Law>
[[gnu::flatten]] unsigned add_forces(const Law& law, const GrainBatch& batch, double, WideVectors& force) {
  const Topology& topology = *batch.topology;
  const Wide inverse_square_radius = 1.0 / (batch.radius * batch.radius);
  InvertedLanes inverted;
  for (std::size_t c = 0; c < topology.grid.cell.size(); ++c) {
    const std::array<int, 4>& nodes = topology.grid.cell[c];
    const CellShape& shape = topology.cell_shapes[c];
    const CellInLanes cell(batch.position, nodes);
    const std::array<Wide, 4> J = cell.J(shape, inverse_square_radius);
    for (const Wide& of_point : J) inverted.note(of_point);
    const Wide mean_J = cell.mean_J(shape, inverse_square_radius);
    cell.add_force(shape, law.mu, law.cofactor_factors(J, mean_J), nodes, force);
  }
  return inverted.lanes();
}

template <class Law>
requires HistoryLaw<Law, 2>
[[gnu::flatten]] unsigned add_forces_and_advance(const Law& law, GrainBatch& batch, double dt,
                                                 WideVectors& force, FlowOfStep& flow) {
  static_assert(Law::objective);
  InvertedLanes inverted;
  HistoryOfStep<Law> step(batch);
  const LawAtPoints<Law> at(law, batch, dt);
  for_each_cell(law, batch, [&](const CellState& state) {
    const auto deviatoric = [&](int p) {
      const auto before = at.history(state, p);
      const auto [P, advanced] = law.deviatoric().stress_and_advance(state.F[p], before, dt);
      step.keep(state, p, before, advanced);
      return P;
    };
    cell_force(law, state, inverted, deviatoric).add_to(force, state.cell, batch.radius);
  });
  flow = step.sum();
  return inverted.lanes();
}

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

/// K_ab += V U'' dtheta/dx_a (x) dtheta/dx_b, theta the mean over the cell
void add_bulk_stiffness(const Wide& second_derivative, const std::array<Vec<2, Wide>, 4>& dtheta,
                        CellStiffness& K) {
  int pair = 0;
  for (int a = 0; a < 4; ++a) {
    const Vec<2, Wide> weighted = second_derivative * dtheta[a];
    for (int b = 0; b <= a; ++b, ++pair)
      for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) K[pair][2 * i + k] += weighted[i] * dtheta[b][k];
  }
}

template <class Law>
[[gnu::flatten]] void cell_stiffness(const LawAtPoints<Law>& at, const CellState& state, CellStiffness& K) {
  const auto theta = at.law.dilatation();
  const Wide mean = state.mean(theta);
  const Wide pressure = at.law.volume().derivative(mean);
  std::array<Vec<2, Wide>, 4> dtheta{};  // of sum_p V_p theta_p
  for (int p = 0; p < 4; ++p) {
    const MaterialPoint& point = state.points[p];
    Mat<4, Wide> A = at.tangent(state, p);
    theta.add_second_derivative(A, pressure, state.F[p]);
    add_point_stiffness(A, point, K);
    const WideMat gradient = theta.gradient(state.F[p]);
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 2; ++i)
        dtheta[a][i] +=
            point.volume * (gradient(i, 0) * point.gradient[a][0] + gradient(i, 1) * point.gradient[a][1]);
  }
  add_bulk_stiffness(at.law.volume().second_derivative(mean) * Wide(1 / state.volume), dtheta, K);
}

/// K_ab <- Q K_ab Q^T
void turn(const WideMat& Q, CellStiffness& K) {
  for (auto& k : K) k = (Q * WideMat{k} * transpose(Q)).c;
}

template <class Law>
[[gnu::flatten]] Wide cell_energy(const LawAtPoints<Law>& at, const CellState& state) {
  Wide sum = state.volume * at.law.volume().energy(state.mean(at.law.dilatation()));
  for (int p = 0; p < 4; ++p) sum += state.points[p].volume * at.stored(state, p);
  return sum;
}

}  // namespace

unsigned internal_force(const SoftGrains& grains, const GrainBatch& batch, WideVectors& force, double dt) {
  force.assign(batch.position.size(), {});
  return std::visit([&](const auto& law) { return add_forces(law, batch, dt, force); }, grains.law(batch));
}

unsigned internal_force_and_history(const SoftGrains& grains, GrainBatch& batch, WideVectors& force,
                                    double dt, FlowOfStep& flow) {
  force.assign(batch.position.size(), {});
  return std::visit(
      [&]<class Law>(const Law& law) {
        if constexpr (HistoryLaw<Law, 2>)
          return add_forces_and_advance(law, batch, dt, force, flow);
        else
          return add_forces(law, batch, dt, force);
      },
      grains.law(batch));
}

void for_each_cell_stiffness(const SoftGrains& grains, const GrainBatch& batch, double dt,
                             const std::function<void(int cell, const CellStiffness& K)>& visit) {
  std::visit(
      [&]<class Law>(const Law& law) {
        const LawAtPoints<Law> at(law, batch, dt);
        for_each_cell(law, batch, [&](const CellState& state) {
          CellStiffness K{};
          cell_stiffness(at, state, K);
          if (!Law::objective) turn(placed_rotation(batch), K);
          visit(state.index, K);
        });
      },
      grains.law(batch));
}

void add_stiffness(const SoftGrains& grains, const GrainBatch& batch, BatchedCholesky& matrix, double dt) {
  for_each_cell_stiffness(grains, batch, dt, [&](int cell, const CellStiffness& K) {
    for (int pair = 0; pair < 10; ++pair) {
      const CellBlock& to = batch.topology->cell_blocks[10 * cell + pair];
      const auto& k = K[pair];
      matrix.add_block(to.block, to.transposed ? std::array<Wide, 4>{k[0], k[2], k[1], k[3]} : k);
    }
  });
}

Wide elastic_energy(const SoftGrains& grains, const GrainBatch& batch) {
  Wide sum = 0.0;
  std::visit(
      [&]<class Law>(const Law& law) {
        const LawAtPoints<Law> at(law, batch, 0);
        for_each_cell(law, batch, [&](const CellState& state) { sum += cell_energy(at, state); });
      },
      grains.law(batch));
  return sum * (batch.radius * batch.radius);
}

Wide least_J(const GrainBatch& batch) {
  Wide least = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < static_cast<int>(batch.topology->grid.cell.size()); ++cell) {
    const CellState state(batch, cell, false);
    for (const WideMat& F : state.F) least = min(determinant(F), least);
  }
  return least;
}

}  // namespace softgrain
