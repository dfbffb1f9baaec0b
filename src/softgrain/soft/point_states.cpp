#include "softgrain/soft/point_states.hpp"

#include <cmath>
#include <variant>

#include "softgrain/soft/law_at_points.hpp"

namespace softgrain {
namespace {

template <class Law>
void respond(const LawAtPoints<Law>& at, const CellState&, int, int, const Mat<2>&, double pressure,
             PointState& point) {
  const Law& law = at.law;
  const Mat<2> P = law.deviatoric().stress(point.F) + pressure * law.dilatation().gradient(point.F);
  point.stress = (1 / determinant(point.F)) * (P * transpose(point.F));
  point.pressure = -trace(point.stress) / 2;
}

/// With the stress across the plane, which belongs to what makes the point flow. The history is that of the
/// grid's own axes, as F is.
template <class Law>
requires HistoryLaw<Law, 2>
void respond(const LawAtPoints<Law>& at, const CellState& cell, int p, int lane, const Mat<2>& F,
             double pressure, PointState& point) {
  const Law& law = at.law;
  typename Law::template State<2, double> state;
  for (std::size_t k = 0; k < state.size(); ++k) state[k] = at.history(cell, p)[k][lane];
  const double J = determinant(F);
  const Mat<2> P = law.deviatoric().stress(F, state, 0) + pressure * law.dilatation().gradient(F);
  point.stress = (1 / J) * (P * transpose(F));
  const double across = law.deviatoric().stress_across(F, state, 0) / J + pressure;
  point.pressure = -(trace(point.stress) + across) / 3;
  const auto& [xx, xy, yx, yy] = point.stress.c;
  const double squares =
      (xx - yy) * (xx - yy) + (yy - across) * (yy - across) + (across - xx) * (across - xx);
  point.von_mises = std::sqrt(squares / 2 + 3 * xy * yx);
  point.plastic_strain = Law::plastic_strain(state);
}

/// Points of one lane; Q: how it was placed.
template <class Law>
void add_point_states(const LawAtPoints<Law>& at, const CellState& cell, const Wide& pressure,
                      const Mat<2>& Q, int lane, std::vector<PointState>& states) {
  for (int p = 0; p < 4; ++p) {
    Mat<2> F;
    for (std::size_t k = 0; k < 4; ++k) F.c[k] = cell.F[p].c[k][lane];
    PointState point{.F = (Law::objective ? F : Q * F) * transpose(Q), .stress = {}, .pressure = 0};
    respond(at, cell, p, lane, F, pressure[lane], point);
    states.push_back(point);
  }
}

}  // namespace

std::array<std::vector<PointState>, Wide::size> point_states(const SoftGrains& grains,
                                                             const GrainBatch& batch, unsigned lanes) {
  std::array<Mat<2>, Wide::size> Q;
  std::array<std::vector<PointState>, Wide::size> states;
  const auto placed = placed_rotation(batch);
  for (int lane = 0; lane < Wide::size; ++lane) {
    for (std::size_t k = 0; k < 4; ++k) Q[lane].c[k] = placed.c[k][lane];
    if ((lanes >> lane & 1U) != 0) states[lane].reserve(batch.topology->points.size());
  }
  std::visit(
      [&]<class Law>(const Law& law) {
        const LawAtPoints<Law> at(law, batch, 0);
        for_each_cell(law, batch, [&](const CellState& cell) {
          const Wide pressure = law.volume().derivative(cell.mean(law.dilatation()));
          for (int lane = 0; lane < Wide::size; ++lane)
            if ((lanes >> lane & 1U) != 0) add_point_states(at, cell, pressure, Q[lane], lane, states[lane]);
        });
      },
      grains.law(batch));
  return states;
}

std::vector<PointState> point_states(const SoftGrains& grains, int grain) {
  const auto [batch, lane] = grains.batch_of(grain);
  return std::move(point_states(grains, *batch, 1U << lane)[lane]);
}

}  // namespace softgrain
