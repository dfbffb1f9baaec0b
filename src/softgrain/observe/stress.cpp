#include "softgrain/observe/stress.hpp"

namespace softgrain {
namespace {

void add_outer(Mat<2>& sum, double scale, const Vec<2>& a, const Vec<2>& b) {
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) sum(i, j) += scale * a[i] * b[j];
}

}  // namespace

std::vector<double> virial_pressure(std::span<const BranchForce> forces, std::span<const double> area) {
  std::vector<double> pressure(area.size(), 0);
  for (const BranchForce& f : forces) {
    if (f.a >= 0) pressure[f.a] += dot(f.force, f.branch_a) / (2 * area[f.a]);  // the force on a is -f
    if (f.b >= 0) pressure[f.b] -= dot(f.force, f.branch_b) / (2 * area[f.b]);
  }
  return pressure;
}

Mat<2> contact_stress(std::span<const ContactPoint> contacts, std::span<const Vec<2>> centre, double area) {
  Mat<2> sigma;
  for (const ContactPoint& c : contacts)
    add_outer(sigma, 1 / area, c.force, (c.b < 0 ? c.position : centre[c.b] + c.image) - centre[c.a]);
  return sigma;
}

Mat<2> kinetic_stress(std::span<const double> mass, std::span<const Vec<2>> velocity, double area) {
  Vec<2> momentum;
  double total = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) momentum += mass[i] * velocity[i], total += mass[i];
  Mat<2> sigma;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const Vec<2> v = velocity[i] - (1 / total) * momentum;
    add_outer(sigma, mass[i] / area, v, v);
  }
  return sigma;
}

}  // namespace softgrain
