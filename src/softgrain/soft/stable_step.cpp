#include "softgrain/soft/stable_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/equilibrium.hpp"

namespace softgrain {
namespace {

/// Symmetric, of the eight velocities of a cell.
using CellMatrix = std::array<std::array<Wide, 8>, 8>;

CellMatrix square(const CellMatrix& A) {
  CellMatrix B;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j <= i; ++j) {
      Wide sum = 0.0;
      for (int k = 0; k < 8; ++k) sum += A[i][k] * A[j][k];
      B[i][j] = B[j][i] = sum;
    }
  return B;
}

/// Sum of the squares of the entries: of the eigenvalues.
Wide squares_of(const CellMatrix& A) {
  Wide sum = 0.0;
  for (const auto& row : A)
    for (const Wide& entry : row) sum += entry * entry;
  return sum;
}

/// M^-1/2 K M^-1/2 over the Pa of K and the kg/m of the mass, from 1/sqrt(mass) of the nodes.
CellMatrix matrix_of(const CellStiffness& K, const std::array<double, 4>& root) {
  CellMatrix A;
  int pair = 0;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b <= a; ++b, ++pair)
      for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k) {
          const Wide entry = (root[a] * root[b]) * K[pair][2 * i + k];
          A[2 * a + i][2 * b + k] = A[2 * b + k][2 * a + i] = entry;
        }
  return A;
}

/// Square of omega R sqrt(rho) of a cell in each lane, from above,
///   lambda <= |A|, |A^2|^(1/2), |A^4|^(1/4), |A^8|^(1/8),
/// |A| the root of the sum of the squares of the six eigenvalues or less that are not 0; or, once that is
/// known not to be above `known`, a bound that is not either.
Wide largest_eigenvalue(const CellStiffness& K, const MaterialPoint* points, const Wide& known) {
  std::array<double, 4> root{};
  for (int a = 0; a < 4; ++a) {
    double mass = 0;
    for (int p = 0; p < 4; ++p) mass += points[p].shape[a] * points[p].volume;
    root[a] = 1 / std::sqrt(mass);
  }
  CellMatrix A = matrix_of(K, root);
  const Wide size = sqrt(squares_of(A)), inverse = 1.0 / size;
  Wide bound = size;
  if (all(bound <= known)) return bound;
  for (auto& row : A)
    for (Wide& entry : row) entry *= inverse;
  for (int power = 2; power <= 8; power *= 2) {
    A = square(A);
    bound = sqrt(squares_of(A));
    for (int root_of = power; root_of > 1; root_of /= 2) bound = sqrt(bound);
    bound *= size;
    if (all(bound <= known)) break;
  }
  return bound;
}

/// Largest omega^2 [1/s^2] of the cells of a batch.
double largest_square_frequency(const SoftGrains& grains, const GrainBatch& batch) {
  Wide largest = 0.0;
  for_each_cell_stiffness(grains, batch, 0, [&](int cell, const CellStiffness& K) {
    const Wide square = largest_eigenvalue(K, &batch.topology->points[4 * cell], largest);
    largest = select(square > largest, square, largest);
  });
  const double density = grains.density(batch) * batch.topology->grid.fullness;
  double most = 0;
  for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
    most = std::max(most, largest[lane] / (density * batch.radius[lane] * batch.radius[lane]));
  return most;
}

}  // namespace

double stable_time_step(const SoftGrains& grains, double safety) {
  std::vector<double> shortest(grains.kinds(), std::numeric_limits<double>::infinity());
  for (int g = 0; g < grains.size(); ++g) {
    const ReferenceGrid& grid = grains.topology(g).grid;
    double& of_kind = shortest[grains.kind(g)];
    for (const auto& cell : grid.cell)
      for (int a = 0; a < 4; ++a)
        of_kind =
            std::min(of_kind, grains.radius(g) * norm(grid.node[cell[a]] - grid.node[cell[(a + 1) % 4]]));
  }
  double step = std::numeric_limits<double>::infinity();
  for (int k = 0; k < grains.kinds(); ++k)
    if (const GrainMaterial& material = grains.material(k); !material.rigid)
      step = std::min(step, safety * shortest[k] / wave_speed(material.law, material.density));
  return step;
}

double longest_stable_step(const SoftGrains& grains, double damping_share) {
  std::vector<double> largest(grains.batches.size());
  shared_for(
      grains.shares, static_cast<int>(largest.size()),
      [&](int b) { largest[b] = largest_square_frequency(grains, grains.batches[b]); },
      [&](int b, Message& message) { message(largest[b]); });
  return 2 / std::sqrt((1 + 2 * damping_share) * *std::max_element(largest.begin(), largest.end()));
}

}  // namespace softgrain
