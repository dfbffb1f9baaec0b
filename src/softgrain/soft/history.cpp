#include "softgrain/soft/history.hpp"

#include <algorithm>
#include <variant>

#include "softgrain/soft/law_at_points.hpp"

namespace softgrain {
namespace {

/// visit(law) if the law has a history.
template <class Visit>
void with_history(const AnyLaw& law, Visit&& visit) {
  std::visit(
      [&]<class Law>(const Law& some) {
        if constexpr (HistoryLaw<Law, 2>) visit(some);
      },
      law);
}

template <class Law>
using StateOf = typename Law::template State<2, Wide>;

template <class Law>
[[gnu::flatten]] FlowOfStep advance(const Law& law, GrainBatch& batch, double dt) {
  HistoryOfStep<Law> step(batch);
  const LawAtPoints<Law> at(law, batch, dt);
  for_each_cell(law, batch, [&](const CellState& cell) {
    for (int p = 0; p < 4; ++p) {
      const StateOf<Law> before = at.history(cell, p);
      step.keep(cell, p, before, law.deviatoric().advance(cell.F[p], before, dt));
    }
  });
  return step.sum();
}

}  // namespace

std::vector<Wide> undeformed_history(const AnyLaw& law, const Topology& topology) {
  std::vector<Wide> history;
  with_history(law, [&]<class Law>(const Law&) {
    const StateOf<Law> point = Law::template undeformed<2, Wide>();
    for (std::size_t p = 0; p < topology.points.size(); ++p)
      history.insert(history.end(), point.begin(), point.end());
  });
  return history;
}

FlowOfStep advance_history(const SoftGrains& grains, GrainBatch& batch, double dt) {
  FlowOfStep sum;
  with_history(grains.law(batch), [&](const auto& law) { sum = advance(law, batch, dt); });
  return sum;
}

FlowOfGrains sum_of(const SoftGrains& grains, std::span<const FlowOfStep> of_batches) {
  FlowOfGrains sum;
  for (std::size_t b = 0; b < of_batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      sum.dissipated += of_batches[b].dissipated[lane];
      sum.share += of_batches[b].flowing[lane];
    }
  sum.share /= grains.undeformed_area();
  return sum;
}

PlasticStrain plastic_strain(const SoftGrains& grains) {
  PlasticStrain strain;
  for (const GrainBatch& batch : grains.batches)
    with_history(grains.law(batch), [&]<class Law>(const Law&) {
      for (std::size_t p = 0; p < batch.topology->points.size(); ++p) {
        StateOf<Law> state;
        std::copy_n(&batch.history[state.size() * p], state.size(), state.begin());
        const Wide alpha = Law::plastic_strain(state);
        const Wide weighted = alpha * (batch.topology->points[p].volume * (batch.radius * batch.radius));
        for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
          strain.mean += weighted[lane];
          strain.largest = std::max(strain.largest, alpha[lane]);
        }
      }
    });
  strain.mean /= grains.undeformed_area();
  return strain;
}

void visit_history(SoftGrains& grains, StateVisitor& visit) {
  if (!grains.has_history()) return;
  std::vector<double> values;
  for (const GrainBatch& batch : grains.batches)
    for (const Wide& number : batch.history)
      for (int lane = 0; lane < Wide::size; ++lane) values.push_back(number[lane]);
  visit.rows(
      {"history", "", Owner::point, Role::state,
       "of each point of eight grains C_p^-1 (11, 22, 12) and the plastic strain; of what relaxes U of "
       "C = U^T U and C_v^-1 of four branches (11, 22, 12 each)"},
      values, Wide::size);
  const double* value = values.data();
  for (GrainBatch& batch : grains.batches)
    for (Wide& number : batch.history) {
      number = load_wide(value);
      value += Wide::size;
    }
}

}  // namespace softgrain
