#include "peers/vibrating_blocks.hpp"

#include <cmath>
#include <numbers>

namespace softgrain::bench {
namespace {

constexpr double shear_modulus = VibratingBlocks::E / (2 * (1 + VibratingBlocks::nu));
constexpr double courant = 0.3;

}  // namespace

double VibratingBlocks::omega() const {
  return std::numbers::pi / side() * std::sqrt(2 * shear_modulus / rho);
}

double VibratingBlocks::duration() const { return 0.75 * std::numbers::pi / omega(); }

int VibratingBlocks::explicit_steps() const {
  const double c_p = std::sqrt(2 * shear_modulus * (1 - nu) / (1 - 2 * nu) / rho);
  return static_cast<int>(std::ceil(duration() * c_p / (courant * h)));
}

Vec<2> VibratingBlocks::displacement(const Vec<2>& X) const {
  const double k = std::numbers::pi / side(), A = strain / k;
  return {A * std::cos(k * X[0]) * std::sin(k * X[1]), -A * std::sin(k * X[0]) * std::cos(k * X[1])};
}

Mat<2> VibratingBlocks::displacement_gradient(const Vec<2>& X) const {
  const double k = std::numbers::pi / side();
  const double normal = strain * std::sin(k * X[0]) * std::sin(k * X[1]);
  const double turn = strain * std::cos(k * X[0]) * std::cos(k * X[1]);
  Mat<2> H;
  H(0, 0) = -normal, H(0, 1) = turn;
  H(1, 0) = -turn, H(1, 1) = normal;
  return H;
}

Vec<2> VibratingBlocks::from_corner(int point) const {
  const int cell = point / 4 % (cells * cells);
  const double gauss = 0.5 / std::sqrt(3.0);
  return {h * (cell % cells + 0.5 + (point % 2 == 0 ? -gauss : gauss)),
          h * (cell / cells + 0.5 + (point % 4 < 2 ? -gauss : gauss))};
}

std::vector<Vec<2>> VibratingBlocks::positions() const {
  std::vector<Vec<2>> x;
  for (int p = 0; p < points(); ++p) x.push_back(corner(p / (4 * cells * cells)) + from_corner(p));
  return x;
}

std::vector<Vec<2>> VibratingBlocks::closed_velocity() const {
  std::vector<Vec<2>> v;
  const double factor = -omega() * std::sin(omega() * duration());
  for (int p = 0; p < points(); ++p) v.push_back(factor * displacement(from_corner(p)));
  return v;
}

double relative_difference(std::span<const Vec<2>> a, std::span<const Vec<2>> b) {
  double difference = 0, size = 0;
  for (std::size_t p = 0; p < b.size(); ++p) {
    difference += dot(a[p] - b[p], a[p] - b[p]);
    size += dot(b[p], b[p]);
  }
  return std::sqrt(difference / size);
}

}  // namespace softgrain::bench
