#include "softgrain/material/element_test.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/material/elastic_law.hpp"

namespace softgrain {
namespace {

/// One point of an elastic law: it remembers nothing.
template <class Law>
struct Point {
  explicit Point(const Law& elastic) : law(elastic) {}

  Mat<2> stress(const Mat<2>& F, double) const { return law.stress(F); }
  Mat<4> tangent(const Mat<2>& F, double) const { return law.tangent(F); }
  double stress_across(const Mat<2>& F) const {
    return law.stress(Mat<3>{{F(0, 0), F(0, 1), 0, F(1, 0), F(1, 1), 0, 0, 0, 1}})(2, 2);
  }
  double advance(const Mat<2>&, double) { return 0; }
  double stored(const Mat<2>& F) const { return law.energy(F); }
  double plastic_strain() const { return 0; }

  const Law& law;
};

template <class Law>
requires HistoryLaw<Law, 2>
struct Point<Law> {
  explicit Point(const Law& with_history) : law(with_history), state(Law::template undeformed<2, double>()) {}

  Mat<2> stress(const Mat<2>& F, double dt) const { return law.stress(F, state, dt); }
  Mat<4> tangent(const Mat<2>& F, double dt) const { return law.tangent(F, state, dt); }
  double stress_across(const Mat<2>& F) const { return law.stress_across(F, state, 0); }
  double advance(const Mat<2>& F, double dt) {
    const auto after = law.advance(F, state, dt);
    state = after.state;
    return after.dissipated;
  }
  double stored(const Mat<2>& F) const { return law.stored(F, state); }
  double plastic_strain() const { return Law::plastic_strain(state); }

  const Law& law;
  typename Law::template State<2, double> state;
};

/// ln of the stretch along y at which nothing pulls there, by Newton's method from `start`.
template <class Law>
double free_width(const Point<Law>& point, double along, double start, double dt) {
  constexpr int enough = 200;
  constexpr double converged = 1e-14, longest = 0.1;  // of ln of the stretch
  double width = start;
  for (int k = 0; k < enough; ++k) {
    const Mat<2> F = Mat<2>::diagonal({std::exp(along), std::exp(width)});
    const double slope = point.tangent(F, dt)(3, 3) * F(1, 1);
    const double step = std::clamp(-point.stress(F, dt)(1, 1) / slope, -longest, longest);
    width += step;
    if (std::abs(step) < converged) return width;
  }
  throw NumericalError(fmt::format("no width of the point is free of stress at a strain of {:.3g}", along));
}

/// F at this strain; `width` is ln of the stretch along y of a point that is free there.
Mat<2> deformation(ElementPath path, double strain, double width) {
  if (path == ElementPath::shear) return {{1, strain, 0, 1}};
  return Mat<2>::diagonal({std::exp(strain), std::exp(width)});
}

template <class Law>
void set_stresses(const Point<Law>& point, const Mat<2>& F, const Mat<2>& P, ElementRow& row) {
  const double inverse_J = 1 / determinant(F);
  const Mat<2> stress = symmetric_part(inverse_J * (P * transpose(F)));
  const double xx = stress(0, 0), yy = stress(1, 1), xy = stress(0, 1);
  const double zz = inverse_J * point.stress_across(F);
  row.stress_xx = xx, row.stress_yy = yy, row.stress_zz = zz, row.stress_xy = xy;
  row.pressure = -(xx + yy + zz) / 3;
  row.von_mises =
      std::sqrt(((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 + 3 * xy * xy);
}

/// The strains at the ends of the ways.
std::vector<double> turns_of(const ElementTest& test) {
  if (test.path == ElementPath::cycle) return {test.strain, 0, test.strain};
  return {test.strain};
}

template <class Law>
std::vector<ElementRow> drive(Point<Law> point, const ElementTest& test) {
  const bool is_free = test.path == ElementPath::uniaxial || test.path == ElementPath::cycle;
  const double by = test.strain / test.steps, dt = std::abs(by) / test.rate;
  std::vector<ElementRow> rows(1);
  Mat<2> F = identity<2>(), P = point.stress(F, 0);
  double width = 0, begin = 0;
  for (const double end : turns_of(test)) {
    for (int k = 1; k <= test.steps; ++k) {
      const double strain = k == test.steps ? end : begin + (end - begin) * k / test.steps;
      if (is_free) width = free_width(point, strain, width, dt);
      const Mat<2> F_before = F, P_before = P;
      F = deformation(test.path, strain, width);
      P = point.stress(F, dt);
      ElementRow row{.time = rows.back().time + dt, .strain = strain, .stretch = F(1, 1)};
      row.dissipated = rows.back().dissipated + point.advance(F, dt);
      row.work = rows.back().work + 0.5 * contract(P + P_before, F - F_before);
      row.stored = point.stored(F);
      row.plastic_strain = point.plastic_strain();
      set_stresses(point, F, P, row);
      rows.push_back(row);
    }
    begin = end;
  }
  return rows;
}

}  // namespace

std::vector<ElementRow> drive_point(const AnyLaw& law, const ElementTest& test) {
  require(std::isfinite(test.strain) && test.strain != 0, "the strain must be a number other than 0, got {}",
          test.strain);
  require(test.rate > 0 && std::isfinite(test.rate), "the rate must be > 0 1/s, got {}", test.rate);
  require(test.steps >= 1, "there must be one step at least, got {}", test.steps);
  return std::visit([&]<class Law>(const Law& some) { return drive(Point<Law>(some), test); }, law);
}

}  // namespace softgrain
