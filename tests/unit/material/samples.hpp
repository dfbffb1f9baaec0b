#pragma once
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "softgrain/material/any_law.hpp"
#include "softgrain/material/elastic_law.hpp"
#include "softgrain/math/random.hpp"

namespace softgrain::test {

inline constexpr double E = 2.0, nu = 0.3;  // stresses of order one
/// For laws that take more.
inline constexpr MaterialParameters material{.young_modulus = E,
                                             .poisson_ratio = nu,
                                             .c20 = -0.1,
                                             .c30 = 0.05,
                                             .yield_stress = 0.05,
                                             .c01 = 0.1,
                                             .ogden_exponent_1 = 1.3,
                                             .ogden_exponent_2 = 5,
                                             .ogden_exponent_3 = -2,
                                             .ogden_share_2 = 0.1,
                                             .ogden_share_3 = 0.2,
                                             .creep_rate = 0.2,
                                             .creep_stress = 0.1,
                                             .creep_exponent = 4,
                                             .relaxation_share_1 = 0.4,
                                             .relaxation_share_2 = 0.3,
                                             .relaxation_time_1 = 0.1,
                                             .relaxation_time_2 = 1};

/// Calls check(name, law) for every elastic law that a case file can choose.
template <class Check>
void for_each_law(Check check) {
  for (const LawChoice& choice : law_choices())
    std::visit(
        [&]<class Law>(const Law& law) {
          if constexpr (ElasticLaw<Law, 2>) check(std::string(choice.name), law);
        },
        choice.make(material));
}

inline Mat<2> rotation(const Vec<1>& angle) {
  const double c = std::cos(angle[0]), s = std::sin(angle[0]);
  return {{c, -s, s, c}};
}
/// Rodrigues' formula about the axis angle / |angle|.
inline Mat<3> rotation(const Vec<3>& angle) {
  const double size = norm(angle);
  const Vec<3> n = (1.0 / size) * angle;
  const Mat<3> cross{{0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0}};
  return identity<3>() + std::sin(size) * cross + (1 - std::cos(size)) * (cross * cross);
}
template <int Dim>
Mat<Dim> sample_rotation(int k) {
  if constexpr (Dim == 2)
    return rotation(Vec<1>{0.3 + 1.7 * k});
  else
    return rotation(Vec<3>{0.4 + 0.9 * k, std::sin(k), -0.7 + 0.3 * k});
}

/// A deformation with the principal stretches `s` along axes turned arbitrarily in both configurations.
template <int Dim>
Mat<Dim> with_stretches(const Vec<Dim>& s, int k = 0) {
  return sample_rotation<Dim>(k) * Mat<Dim>::diagonal(s) * transpose(sample_rotation<Dim>(k + 7));
}

/// Principal stretches: none, equal, nearly equal, moderate, large.
template <int Dim>
std::vector<Vec<Dim>> sample_stretches() {
  if constexpr (Dim == 2)
    return {{1, 1}, {1.3, 1.3}, {0.8, 0.8 + 1e-9}, {1.2, 0.9}, {1.3, 1.6}, {0.5, 1.7}, {2.5, 0.6}};
  else
    return {{1, 1, 1},       {0.7, 0.7, 0.7},   {1.4, 0.9, 0.9}, {0.8, 0.8 + 1e-9, 0.8 - 2e-9},
            {1.2, 0.9, 1.1}, {1.31, 1.3, 0.95}, {0.5, 1.7, 1.1}, {2.5, 0.6, 1.2}};
}
template <int Dim>
std::vector<Mat<Dim>> sample_deformations() {
  std::vector<Mat<Dim>> samples{identity<Dim>()};
  int k = 0;
  for (const Vec<Dim>& s : sample_stretches<Dim>()) samples.push_back(with_stretches<Dim>(s, k++));
  return samples;
}

/// Plane strain seen in 3D: F_33 = 1.
inline Mat<3> embedded(const Mat<2>& F) { return {{F(0, 0), F(0, 1), 0, F(1, 0), F(1, 1), 0, 0, 0, 1}}; }

template <int N>
double largest_entry(const Mat<N>& m) {
  double largest = 0;
  for (const double entry : m.c) largest = std::isnan(entry) ? entry : std::max(largest, std::abs(entry));
  return largest;
}
template <int N>
double difference(const Mat<N>& a, const Mat<N>& b) {
  return largest_entry(a - b);
}

/// df/dx(0) by five points, error of order step^4.
template <class F>
auto derivative(F f, double step = 3e-4) {
  return (1 / (12 * step)) * (8.0 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step)));
}
template <int Dim>
Mat<Dim> moved(Mat<Dim> F, int entry, double by) {
  F.c[static_cast<std::size_t>(entry)] += by;
  return F;
}
/// d energy / dF by finite differences.
template <int Dim, class Energy>
Mat<Dim> gradient(Energy energy, const Mat<Dim>& F) {
  Mat<Dim> P;
  for (int k = 0; k < Dim * Dim; ++k)
    P.c[static_cast<std::size_t>(k)] = derivative([&](double by) { return energy(moved(F, k, by)); });
  return P;
}
/// d stress / dF by finite differences.
template <int Dim, class Stress>
Mat<Dim * Dim> gradient_of_stress(Stress stress, const Mat<Dim>& F) {
  Mat<Dim * Dim> A;
  for (int column = 0; column < Dim * Dim; ++column) {
    const Mat<Dim> slope = derivative([&](double by) { return stress(moved(F, column, by)); });
    for (int row = 0; row < Dim * Dim; ++row) A(row, column) = slope.c[static_cast<std::size_t>(row)];
  }
  return A;
}

}  // namespace softgrain::test
