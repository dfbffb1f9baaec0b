#pragma once
#include <algorithm>

#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/cell_state.hpp"
#include "softgrain/soft/history.hpp"

namespace softgrain {

/// Number of the p-th point of a cell among all of its grain.
template <int Dim>
std::size_t point_of_batch(const auto& cell, int p) {
  return static_cast<std::size_t>((1 << Dim) * cell.index + p);
}

/// The deviatoric part of a law at the points of a batch's cells: of F alone, or, where the law has a
/// history, of what the point remembers too. dt [s] is the time since then. A cell has F of its points, as
/// CellState, in space BrickState.
template <class Law, int Dim = 2>
struct LawAtPoints {
  LawAtPoints(const Law& elastic, const BatchOf<Dim>&, double) : law(elastic) {}

  Wide energy(const auto& cell, int p) const { return law.deviatoric().energy(cell.F[p]); }
  Wide stored(const auto& cell, int p) const { return energy(cell, p); }
  Mat<Dim, Wide> stress(const auto& cell, int p) const { return law.deviatoric().stress(cell.F[p]); }
  Mat<Dim, Wide> stress_without_flow(const auto& cell, int p) const { return stress(cell, p); }
  Mat<4, Wide> tangent(const CellState& cell, int p) const { return law.deviatoric().tangent(cell.F[p]); }

  const Law& law;
};

template <class Law, int Dim>
requires HistoryLaw<Law, Dim>
struct LawAtPoints<Law, Dim> {
  using State = typename Law::template State<Dim, Wide>;

  LawAtPoints(const Law& with_history, const BatchOf<Dim>& grains, double since)
      : law(with_history), batch(grains), dt(since) {}

  State history(const auto& cell, int p) const {
    State state;
    const Wide* from = &batch.history[state.size() * point_of_batch<Dim>(cell, p)];
    std::copy(from, from + state.size(), state.begin());
    return state;
  }
  Wide energy(const auto& cell, int p) const {
    return law.deviatoric().energy(cell.F[p], history(cell, p), dt);
  }
  Wide stored(const auto& cell, int p) const { return law.deviatoric().stored(cell.F[p], history(cell, p)); }
  Mat<Dim, Wide> stress(const auto& cell, int p) const {
    return law.deviatoric().stress(cell.F[p], history(cell, p), dt);
  }
  Mat<Dim, Wide> stress_without_flow(const auto& cell, int p) const {
    return law.deviatoric().without_flow().stress(cell.F[p], history(cell, p), 0);
  }
  Mat<4, Wide> tangent(const CellState& cell, int p) const {
    return law.deviatoric().tangent(cell.F[p], history(cell, p), dt);
  }

  const Law& law;
  const BatchOf<Dim>& batch;
  double dt;
};

/// Writes down what a step does to the points of a batch, and sums it up.
template <class Law, int Dim = 2>
requires HistoryLaw<Law, Dim>
class HistoryOfStep {
 public:
  using State = typename Law::template State<Dim, Wide>;

  explicit HistoryOfStep(BatchOf<Dim>& grains) : batch_(grains) {}

  /// Advanced is what the law's advance says of point p.
  template <class Advanced>
  void keep(const auto& cell, int p, const State& before, const Advanced& advanced) {
    const State& after = advanced.state;
    const double volume = cell.points[p].volume;
    sum_.dissipated += volume * advanced.dissipated;
    sum_.flowing += select(Law::plastic_strain(after) > Law::plastic_strain(before), Wide(volume), Wide(0.0));
    std::copy(after.begin(), after.end(), &batch_.history[after.size() * point_of_batch<Dim>(cell, p)]);
  }
  FlowOfStep sum() const {
    const Wide unit = body_unit<Dim>(batch_.radius);
    return {sum_.dissipated * unit, sum_.flowing * unit};
  }

 private:
  BatchOf<Dim>& batch_;
  FlowOfStep sum_;
};

}  // namespace softgrain
