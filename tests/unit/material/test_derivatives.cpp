#include <doctest/doctest.h>

#include <numbers>
#include <utility>

#include "samples.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// The textbook energies in the principal stretches; lambda and mu of E = 2, nu = 0.3 written out.
double energy_in_stretches(const std::string& law, const Vec<3>& s) {
  const double lambda = 2 * 0.3 / (1.3 * 0.4), mu = 2 / 2.6, J = s[0] * s[1] * s[2];
  const auto hooke = [&](auto strain) {
    double squares = 0, sum = 0;
    for (const double stretch : s.c) {
      squares += strain(stretch) * strain(stretch);
      sum += strain(stretch);
    }
    return mu * squares + lambda / 2 * sum * sum;
  };
  if (law == "hencky") return hooke([](double stretch) { return std::log(stretch); });
  if (law == "corotated") return hooke([](double stretch) { return stretch - 1; });
  if (law == "st_venant_kirchhoff") return hooke([](double stretch) { return (stretch * stretch - 1) / 2; });
  if (law == "yeoh") {
    const double i = dot(s, s) / std::cbrt(J * J) - 3, log_J = std::log(J);
    return mu / 2 * i - 0.1 * i * i + 0.05 * i * i * i + (lambda + 2 * mu / 3) / 2 * log_J * log_J;
  }
  const double third = std::cbrt(J), log_J = std::log(J),
               of_volume = (lambda + 2 * mu / 3) / 2 * log_J * log_J;
  if (law == "mooney_rivlin") {
    const double I1 = dot(s, s),
                 I2 = s[0] * s[0] * s[1] * s[1] + s[1] * s[1] * s[2] * s[2] + s[2] * s[2] * s[0] * s[0];
    return (mu / 2 - 0.1) * (I1 / (third * third) - 3) + 0.1 * (I2 / (J * third) - 3) + of_volume;
  }
  if (law == "ogden") {
    double sum = of_volume;
    for (const auto& [share, alpha] : {std::pair{0.7, 1.3}, std::pair{0.1, 5.0}, std::pair{0.2, -2.0}})
      for (const double stretch : s.c)
        sum += 2 * share * mu / (alpha * alpha) * (std::pow(stretch / third, alpha) - 1);
    return sum;
  }
  const double U = law == "neo_hookean" ? std::log(J) * std::log(J) : (J - 1) * (J - 1);
  return mu / 2 * (dot(s, s) - 3) - mu * std::log(J) + lambda / 2 * U;
}

template <int Dim>
void check_energies() {
  for_each_law([](const std::string& name, const auto& law) {
    if (name == "small_strain_hooke") return;  // not a function of stretches
    CAPTURE(name);
    for (const Vec<Dim>& s : sample_stretches<Dim>()) {
      const Vec<3> all{s[0], s[1], Dim == 3 ? s[Dim - 1] : 1};
      const double expected = energy_in_stretches(name, all);
      CHECK(law.energy(Mat<Dim>::diagonal(s)) == doctest::Approx(expected).epsilon(1e-13));
      CHECK(law.energy(with_stretches<Dim>(s)) == doctest::Approx(expected).epsilon(1e-12));
    }
  });
}

template <int Dim>
void check_stresses() {
  for_each_law([](const std::string& name, const auto& law) {
    CAPTURE(name);
    for (const Mat<Dim>& F : sample_deformations<Dim>()) {
      const auto energy = [&](const Mat<Dim>& G) { return law.energy(G); };
      CHECK(difference(law.stress(F), gradient(energy, F)) < 1e-9);
    }
  });
}

template <int Dim>
void check_tangents() {
  for_each_law([](const std::string& name, const auto& law) {
    CAPTURE(name);
    for (const Mat<Dim>& F : sample_deformations<Dim>()) {
      const Mat<Dim* Dim> A = law.tangent(F);
      const auto stress = [&](const Mat<Dim>& G) { return law.stress(G); };
      CHECK(difference(A, gradient_of_stress(stress, F)) < 1e-8);
      CHECK(difference(A, transpose(A)) < 1e-13 * largest_entry(A));
    }
  });
}

/// A closed loop of deformations and its speed, at time t of [0, 1].
template <int Dim>
struct LoopPoint {
  Mat<Dim> F = identity<Dim>(), rate;
};
template <int Dim>
LoopPoint<Dim> loop(double t) {
  constexpr double turn = 2 * std::numbers::pi;
  LoopPoint<Dim> point;
  for (int k = 0; k < Dim * Dim; ++k) {
    const double phase = turn * t + 1.1 * k, size = (Dim == 2 ? 0.2 : 0.1) + 0.02 * k;
    point.F.c[static_cast<std::size_t>(k)] += size * std::sin(phase);
    point.rate.c[static_cast<std::size_t>(k)] = turn * size * std::cos(phase);
  }
  return point;
}

/// int P : dF around the loop, by the trapezoidal rule, which converges exponentially on a loop; `half` stops
/// midway.
struct Work {
  double largest_power = 0, total = 0;
};
template <int Dim, class Law>
Work work_around_loop(const Law& law) {
  constexpr int steps = 200;
  Work work;
  for (int k = 0; k < steps; ++k) {
    const LoopPoint<Dim> point = loop<Dim>(double(k) / steps);
    const double power = contract(law.stress(point.F), point.rate);
    work.total += power / steps;
    work.largest_power = std::max(work.largest_power, std::abs(power));
  }
  return work;
}

template <int Dim>
void check_loops() {
  for_each_law([](const std::string& name, const auto& law) {
    CAPTURE(name);
    const Work work = work_around_loop<Dim>(law);
    CHECK(work.largest_power > 0.1);
    CHECK(std::abs(work.total) < 1e-13 * work.largest_power);
  });
}

}  // namespace

TEST_CASE("the energy of each law is the textbook's in the principal stretches, whatever the axes") {
  check_energies<2>();
  check_energies<3>();
}

TEST_CASE("the energy of Hooke's law in the small strain is that of the symmetric displacement gradient") {
  const double lambda = 2 * 0.3 / (1.3 * 0.4), mu = 2 / 2.6;
  const Mat<2> F{{1.1, 0.3, -0.1, 0.8}};  // strains 0.1, -0.2 and 0.1 in shear
  const double expected = mu * (0.01 + 0.04 + 2 * 0.01) + lambda / 2 * 0.01;
  CHECK(small_strain_hooke(E, nu).energy(F) == doctest::Approx(expected).epsilon(1e-14));
  CHECK(small_strain_hooke(E, nu).energy(embedded(F)) == doctest::Approx(expected).epsilon(1e-14));
}

TEST_CASE("stress is the derivative of the energy") {
  check_stresses<2>();
  check_stresses<3>();
}

TEST_CASE("the tangent is the derivative of the stress and symmetric") {
  check_tangents<2>();
  check_tangents<3>();
}

TEST_CASE("no work is gained or lost around a closed loop of deformations") {
  check_loops<2>();
  check_loops<3>();
}
