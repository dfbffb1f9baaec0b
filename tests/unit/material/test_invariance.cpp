#include <doctest/doctest.h>

#include "samples.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

template <int Dim>
void check_rotations() {
  for_each_law([](const std::string& name, const auto& law) {
    if (name == "small_strain_hooke") return;
    CAPTURE(name);
    for (const Mat<Dim>& F : sample_deformations<Dim>()) {
      const Mat<Dim> Q = sample_rotation<Dim>(3), P = law.stress(F);
      const double scale = 1e-12 * (1 + largest_entry(P));
      CHECK(law.energy(Q * F) == doctest::Approx(law.energy(F)).epsilon(1e-12));
      CHECK(difference(law.stress(Q * F), Q * P) < scale);
      CHECK(law.energy(F * Q) == doctest::Approx(law.energy(F)).epsilon(1e-12));
      CHECK(difference(law.stress(F * Q), P * Q) < scale);
    }
  });
}

/// In-plane entries of a 9 x 9 tangent.
Mat<4> plane_part(const Mat<9>& A) {
  const int entry[] = {0, 1, 3, 4};
  Mat<4> plane;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) plane(row, column) = A(entry[row], entry[column]);
  return plane;
}

/// Eight deformations of one grain shape, one per lane, and what the law says of each alone.
template <int Dim, class Law>
double largest_lane_difference(const Law& law) {
  const std::vector<Mat<Dim>> samples = sample_deformations<Dim>();
  Mat<Dim, Wide> F;
  const auto sample = [&](int lane) { return samples[static_cast<std::size_t>(lane) % samples.size()]; };
  for (int lane = 0; lane < Wide::size; ++lane)
    for (std::size_t k = 0; k < F.c.size(); ++k) F.c[k].set(lane, sample(lane).c[k]);
  const Wide energy = law.energy(F);
  const Mat<Dim, Wide> P = law.stress(F);
  const Mat<Dim * Dim, Wide> A = law.tangent(F);
  double largest = 0;
  const auto compare = [&](double wide, double scalar, double size) {
    largest = std::max(largest, std::abs(wide - scalar) / (1 + size));
  };
  for (int lane = 0; lane < Wide::size; ++lane) {
    const Mat<Dim> stress = law.stress(sample(lane));
    const Mat<Dim* Dim> tangent = law.tangent(sample(lane));
    compare(energy[lane], law.energy(sample(lane)), 0);
    for (std::size_t k = 0; k < P.c.size(); ++k) compare(P.c[k][lane], stress.c[k], largest_entry(stress));
    for (std::size_t k = 0; k < A.c.size(); ++k) compare(A.c[k][lane], tangent.c[k], largest_entry(tangent));
  }
  return largest;
}

}  // namespace

TEST_CASE("a rotated grain has the same energy and the rotated stress, and no axes if isotropic") {
  check_rotations<2>();
  check_rotations<3>();
}

TEST_CASE("Hooke's law in the small strain takes a rotation for a strain") {
  const auto law = small_strain_hooke(E, nu);
  CHECK(law.energy(rotation(Vec<1>{0.5})) > 0.01 * E);
  // cos(angle) - 1 is a strain in both directions.
  const double strain = std::cos(0.5) - 1, lambda = 2 * 0.3 / (1.3 * 0.4), mu = 2 / 2.6;
  CHECK(law.stress(rotation(Vec<1>{0.5}))(0, 0) ==
        doctest::Approx(2 * (lambda + mu) * strain).epsilon(1e-13));
}

TEST_CASE("plane strain is 3D with a stretch of one across the plane") {
  for_each_law([](const std::string& name, const auto& law) {
    CAPTURE(name);
    for (const Mat<2>& F : sample_deformations<2>()) {
      CHECK(law.energy(F) == doctest::Approx(law.energy(embedded(F))).epsilon(1e-13));
      const Mat<2> P = law.stress(F);
      const Mat<3> Q = law.stress(embedded(F));
      CHECK(difference(P, Mat<2>{{Q(0, 0), Q(0, 1), Q(1, 0), Q(1, 1)}}) < 1e-13 * (1 + largest_entry(P)));
      const Mat<4> A = law.tangent(F);
      CHECK(difference(A, plane_part(law.tangent(embedded(F)))) < 1e-13 * largest_entry(A));
    }
  });
}

TEST_CASE("at small strain every law is Hooke's") {
  const double strain = 1e-7, shear_modulus = E / (2 * (1 + nu));
  for_each_law([&](const std::string& name, const auto& law) {
    CAPTURE(name);
    // Undeformed: no energy, no stress.
    CHECK(std::abs(law.energy(identity<2>())) < 1e-15);
    CHECK(largest_entry(law.stress(identity<3>())) < 1e-15);
    // Strains of a bar pulled along x and free across: stress E along, 0 across.
    const auto bar = law.stress(Mat<3>::diagonal({1 + strain, 1 - nu * strain, 1 - nu * strain}));
    CHECK(bar(0, 0) / strain == doctest::Approx(E).epsilon(1e-6));
    CHECK(std::abs(bar(1, 1) / strain) < 1e-6 * E);
    // Plane strain, free across: E / (1 - nu^2).
    const auto sheet = law.stress(Mat<2>::diagonal({1 + strain, 1 - nu / (1 - nu) * strain}));
    CHECK(sheet(0, 0) / strain == doctest::Approx(E / (1 - nu * nu)).epsilon(1e-6));
    CHECK(std::abs(sheet(1, 1) / strain) < 1e-6 * E);
    // Uniaxial strain: E (1 - nu) / ((1 + nu) (1 - 2 nu)).
    const auto layer = law.stress(Mat<2>::diagonal({1 + strain, 1}));
    CHECK(layer(0, 0) / strain == doctest::Approx(E * 0.7 / (1.3 * 0.4)).epsilon(1e-6));
    // Simple shear: symmetric stress G gamma.
    const auto shear = law.stress(Mat<2>{{1, strain, 0, 1}});
    CHECK(shear(0, 1) / strain == doctest::Approx(shear_modulus).epsilon(1e-6));
    CHECK(shear(1, 0) / strain == doctest::Approx(shear_modulus).epsilon(1e-6));
  });
}

TEST_CASE("a pressure wave travels at the speed of the uniaxial strain modulus") {
  const double density = 990;
  for_each_law([&](const std::string& name, const auto& law) {
    CAPTURE(name);
    const double modulus = law.tangent(identity<3>())(0, 0);
    CHECK(law.wave_speed(density) == doctest::Approx(std::sqrt(modulus / density)).epsilon(1e-14));
  });
  CHECK(neo_hookean(10e6, 0.45).wave_speed(990) == doctest::Approx(195.74).epsilon(1e-4));
}

TEST_CASE("eight deformations at once get the answers that each gets alone") {
  for_each_law([](const std::string& name, const auto& law) {
    CAPTURE(name);
    CHECK(largest_lane_difference<2>(law) < 1e-14);
    CHECK(largest_lane_difference<3>(law) < 1e-14);
  });
}
