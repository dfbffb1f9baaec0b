#include "softgrain/soft/history.hpp"

#include <algorithm>
#include <variant>

#include "softgrain/soft/law_at_points.hpp"

namespace softgrain {
namespace {

/// visit(law) if the law has a history.
template <int Dim, class Visit>
void with_history(const AnyLaw& law, Visit&& visit) {
  std::visit(
      [&]<class Law>(const Law& some) {
        if constexpr (HistoryLaw<Law, Dim>) visit(some);
      },
      law);
}

template <class Law, int Dim = 2>
using StateOf = typename Law::template State<Dim, Wide>;

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

template <int Dim>
std::vector<Wide> undeformed_history(const AnyLaw& law, std::size_t points) {
  std::vector<Wide> history;
  with_history<Dim>(law, [&]<class Law>(const Law&) {
    const StateOf<Law, Dim> point = Law::template undeformed<Dim, Wide>();
    for (std::size_t p = 0; p < points; ++p) history.insert(history.end(), point.begin(), point.end());
  });
  return history;
}

FlowOfStep advance_history(const SoftGrains& grains, GrainBatch& batch, double dt) {
  FlowOfStep sum;
  with_history<2>(grains.law(batch), [&](const auto& law) { sum = advance(law, batch, dt); });
  return sum;
}

namespace {

/// Of all points, undeformed: in space the flat cells of a grid fill less than its grain.
double size_of_points(const SoftGrains& grains) { return grains.undeformed_area(); }
double size_of_points(const GrainsOf<3>& grains) {
  double sum = 0;
  for (int g = 0; g < grains.size(); ++g)
    for (const SolidPoint& point : grains.topology(g).points)
      sum += point.volume * body_unit<3>(grains.radius(g));
  return sum;
}

}  // namespace

template <int Dim>
FlowOfGrains sum_of(const GrainsOf<Dim>& grains, std::span<const FlowOfStep> of_batches) {
  FlowOfGrains sum;
  for (std::size_t b = 0; b < of_batches.size(); ++b)
    for (int lane = 0; lane < Wide::size && grains.batches[b].grain[lane] >= 0; ++lane) {
      sum.dissipated += of_batches[b].dissipated[lane];
      sum.share += of_batches[b].flowing[lane];
    }
  sum.share /= size_of_points(grains);
  return sum;
}

template <int Dim>
PlasticStrain plastic_strain(const GrainsOf<Dim>& grains) {
  PlasticStrain strain;
  for (const BatchOf<Dim>& batch : grains.batches)
    with_history<Dim>(grains.law(batch), [&]<class Law>(const Law&) {
      for (std::size_t p = 0; p < batch.topology->points.size(); ++p) {
        StateOf<Law, Dim> state;
        std::copy_n(&batch.history[state.size() * p], state.size(), state.begin());
        const Wide alpha = Law::plastic_strain(state);
        const Wide weighted = alpha * (batch.topology->points[p].volume * body_unit<Dim>(batch.radius));
        for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
          strain.mean += weighted[lane];
          strain.largest = std::max(strain.largest, alpha[lane]);
        }
      }
    });
  strain.mean /= size_of_points(grains);
  return strain;
}

template <int Dim>
void visit_history(GrainsOf<Dim>& grains, StateVisitor& visit) {
  if (!grains.has_history()) return;
  std::vector<double> values;
  std::size_t numbers = 0;
  for (const BatchOf<Dim>& batch : grains.batches) numbers += batch.history.size() * Wide::size;
  values.reserve(numbers);
  for (const BatchOf<Dim>& batch : grains.batches)
    for (const Wide& number : batch.history)
      for (int lane = 0; lane < Wide::size; ++lane) values.push_back(number[lane]);
  visit.rows(
      {"history", "", Owner::point, Role::state,
       "of each point of eight grains C_p^-1 (11, 22, 12) and the plastic strain; of what relaxes U and "
       "C_v^-1 of four branches (11, 22, 12 each); in space F_p^-1, or F and F_v^-1"},
      values, Wide::size);
  if (!visit.reads()) return;
  const double* value = values.data();
  for (BatchOf<Dim>& batch : grains.batches)
    for (Wide& number : batch.history) {
      number = load_wide(value);
      value += Wide::size;
    }
}

template std::vector<Wide> undeformed_history<2>(const AnyLaw&, std::size_t);
template std::vector<Wide> undeformed_history<3>(const AnyLaw&, std::size_t);
template FlowOfGrains sum_of(const GrainsOf<2>&, std::span<const FlowOfStep>);
template FlowOfGrains sum_of(const GrainsOf<3>&, std::span<const FlowOfStep>);
template PlasticStrain plastic_strain(const GrainsOf<2>&);
template PlasticStrain plastic_strain(const GrainsOf<3>&);
template void visit_history(GrainsOf<2>&, StateVisitor&);
template void visit_history(GrainsOf<3>&, StateVisitor&);

}  // namespace softgrain
