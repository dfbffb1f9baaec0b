#include "softgrain/observe/stress.hpp"

namespace softgrain {
namespace {

template <int Dim>
void add_outer(Mat<Dim>& sum, double scale, const Vec<Dim>& a, const Vec<Dim>& b) {
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) sum(i, j) += scale * a[i] * b[j];
}

template <int Dim>
Mat<Dim> stress_of_contacts(std::span<const ContactPointOf<Dim>> contacts, std::span<const Vec<Dim>> centre,
                            double area) {
  Mat<Dim> sigma;
  for (const auto& c : contacts)
    add_outer(sigma, 1 / area, c.force, (c.b < 0 ? c.position : centre[c.b] + c.image) - centre[c.a]);
  return sigma;
}

template <int Dim>
Mat<Dim> stress_of_motion(std::span<const double> mass, std::span<const Vec<Dim>> velocity, double area) {
  Vec<Dim> momentum;
  double total = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) momentum += mass[i] * velocity[i], total += mass[i];
  Mat<Dim> sigma;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const Vec<Dim> v = velocity[i] - (1 / total) * momentum;
    add_outer(sigma, mass[i] / area, v, v);
  }
  return sigma;
}

template <int Dim>
std::vector<double> pressure_of_forces(std::span<const BranchForceOf<Dim>> forces,
                                       std::span<const double> size) {
  std::vector<double> pressure(size.size(), 0);
  for (const BranchForceOf<Dim>& f : forces) {
    if (f.a >= 0) pressure[f.a] += dot(f.force, f.branch_a) / (Dim * size[f.a]);  // the force on a is -f
    if (f.b >= 0) pressure[f.b] -= dot(f.force, f.branch_b) / (Dim * size[f.b]);
  }
  return pressure;
}

}  // namespace

std::vector<double> virial_pressure(std::span<const BranchForce> forces, std::span<const double> area) {
  return pressure_of_forces(forces, area);
}
std::vector<double> virial_pressure(std::span<const BranchForceOf<3>> forces,
                                    std::span<const double> volume) {
  return pressure_of_forces(forces, volume);
}

Mat<2> contact_stress(std::span<const ContactPoint> contacts, std::span<const Vec<2>> centre, double area) {
  return stress_of_contacts(contacts, centre, area);
}
Mat<3> contact_stress(std::span<const ContactPointOf<3>> contacts, std::span<const Vec<3>> centre,
                      double volume) {
  return stress_of_contacts(contacts, centre, volume);
}

Mat<2> kinetic_stress(std::span<const double> mass, std::span<const Vec<2>> velocity, double area) {
  return stress_of_motion(mass, velocity, area);
}
Mat<3> kinetic_stress(std::span<const double> mass, std::span<const Vec<3>> velocity, double volume) {
  return stress_of_motion(mass, velocity, volume);
}

}  // namespace softgrain
