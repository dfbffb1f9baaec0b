#pragma once
#include <algorithm>

#include "softgrain/material/elastic_law.hpp"
#include "softgrain/soft/cell_state.hpp"
#include "softgrain/soft/history.hpp"

namespace softgrain {

/// The deviatoric part of a law at the points of a batch's cells: of F alone, or, where the law has a
/// history, of what the point remembers too. dt [s] is the time since then.
template <class Law>
struct LawAtPoints {
  LawAtPoints(const Law& elastic, const GrainBatch&, double) : law(elastic) {}

  Wide energy(const CellState& cell, int p) const { return law.deviatoric().energy(cell.F[p]); }
  Wide stored(const CellState& cell, int p) const { return energy(cell, p); }
  WideMat stress(const CellState& cell, int p) const { return law.deviatoric().stress(cell.F[p]); }
  Mat<4, Wide> tangent(const CellState& cell, int p) const { return law.deviatoric().tangent(cell.F[p]); }

  const Law& law;
};

template <class Law>
requires HistoryLaw<Law, 2>
struct LawAtPoints<Law> {
  using State = typename Law::template State<2, Wide>;

  LawAtPoints(const Law& with_history, const GrainBatch& grains, double since)
      : law(with_history), batch(grains), dt(since) {}

  State history(const CellState& cell, int p) const {
    State state;
    const Wide* from = &batch.history[state.size() * static_cast<std::size_t>(4 * cell.index + p)];
    std::copy(from, from + state.size(), state.begin());
    return state;
  }
  Wide energy(const CellState& cell, int p) const {
    return law.deviatoric().energy(cell.F[p], history(cell, p), dt);
  }
  Wide stored(const CellState& cell, int p) const {
    return law.deviatoric().stored(cell.F[p], history(cell, p));
  }
  WideMat stress(const CellState& cell, int p) const {
    return law.deviatoric().stress(cell.F[p], history(cell, p), dt);
  }
  Mat<4, Wide> tangent(const CellState& cell, int p) const {
    return law.deviatoric().tangent(cell.F[p], history(cell, p), dt);
  }

  const Law& law;
  const GrainBatch& batch;
  double dt;
};

/// Writes down what a step does to the points of a batch, and sums it up.
template <class Law>
requires HistoryLaw<Law, 2>
class HistoryOfStep {
 public:
  using State = typename Law::template State<2, Wide>;

  explicit HistoryOfStep(GrainBatch& grains) : batch_(grains) {}

  /// Advanced is what the law's advance says of point p.
  template <class Advanced>
  void keep(const CellState& cell, int p, const State& before, const Advanced& advanced) {
    const State& after = advanced.state;
    const double volume = cell.points[p].volume;
    sum_.dissipated += volume * advanced.dissipated;
    sum_.flowing += select(Law::plastic_strain(after) > Law::plastic_strain(before), Wide(volume), Wide(0.0));
    std::copy(after.begin(), after.end(),
              &batch_.history[after.size() * static_cast<std::size_t>(4 * cell.index + p)]);
  }
  FlowOfStep sum() const {
    const Wide square = batch_.radius * batch_.radius;
    return {sum_.dissipated * square, sum_.flowing * square};
  }

 private:
  GrainBatch& batch_;
  FlowOfStep sum_;
};

}  // namespace softgrain
