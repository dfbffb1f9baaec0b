#include "softgrain/contact/tangents.hpp"
#include "softgrain/rigid/narrow_sweeps.hpp"

namespace softgrain {
namespace {

/// As NarrowRow, which moves three numbers as four.
template <int N>
Vec<N> to_vec(const NarrowRow<N>& row) {
  Vec<N> v;
  for (int k = 0; k < N; ++k) v[k] = row.c[k];
  return v;
}

/// s x n along the tangents, of s = s_a + s_b.
Vec<1> along_tangents(const Vec<2>&, const Vec<1>& s) { return s; }
Vec<2> along_tangents(const Vec<3>& n, const Vec<3>& s) {
  const auto t = tangents(n);
  return {dot(t[1], s), -dot(t[0], s)};
}

/// n x P, of P = p_t along the tangents.
Vec<1> turning_of(const Vec<2>&, const Vec<2>& p) { return {p[1]}; }
Vec<3> turning_of(const Vec<3>& n, const Vec<3>& p) {
  const auto t = tangents(n);
  return p[1] * t[1] - p[2] * t[0];
}

}  // namespace

template <int Dim>
NarrowSweepsOf<Dim>::System::System(NarrowSweepsOf& sweeps, const RigidParticles<Dim>& particles,
                                    const RigidContacts<Dim>& contacts, std::span<const double> offset)
    : sweeps_(sweeps), contacts_(contacts), offset_(offset), inertia_ratio_(particles.inertia_ratio) {}

template <int Dim>
Mat<Dim> NarrowSweepsOf<Dim>::System::delassus_block(int contact) const {
  const double W_nn = contacts_.inverse_mass_a[contact] + contacts_.inverse_mass_b[contact];
  Vec<Dim> diagonal{W_nn};
  for (int k = 1; k < Dim; ++k) diagonal[k] = (1 + inertia_ratio_) * W_nn;
  return Mat<Dim>::diagonal(diagonal);
}

template <int Dim>
Vec<Dim> NarrowSweepsOf<Dim>::System::relative_velocity(int contact) const {
  const int a = contacts_.body_a[contact], b = contacts_.body_b[contact];
  const Vec<Dim> along = (to_vec<Dim>(sweeps_.velocity_[b]) - to_vec<Dim>(sweeps_.velocity_[a])) +
                         contacts_.image_velocity(contact);
  const Vec<Dim>& n = contacts_.normal[contact];
  constexpr int spins = spin_size<Dim>;
  const auto turned = along_tangents(n, to_vec<spins>(sweeps_.spin_[a]) + to_vec<spins>(sweeps_.spin_[b]));
  Vec<Dim> u{dot(n, along) + offset_[contact]};
  const auto t = tangents(n);
  for (int k = 1; k < Dim; ++k) u[k] = dot(t[static_cast<std::size_t>(k - 1)], along) - turned[k - 1];
  return u;
}

template <int Dim>
void NarrowSweepsOf<Dim>::System::apply_impulse(int contact, const Vec<Dim>& dp) {
  const Vec<Dim>& n = contacts_.normal[contact];
  const Vec<Dim> P = from_local(n, dp);
  const auto turning = turning_of(n, dp);
  const auto give = [&](int body, double inverse_mass, double sign) {
    for (int k = 0; k < Dim; ++k)
      sweeps_.velocity_[body].c[k] += static_cast<float>(sign * inverse_mass * P[k]);
    for (int k = 0; k < spin_size<Dim>; ++k)
      sweeps_.spin_[body].c[k] -= static_cast<float>(inertia_ratio_ * inverse_mass * turning[k]);
  };
  give(contacts_.body_a[contact], contacts_.inverse_mass_a[contact], -1);
  give(contacts_.body_b[contact], contacts_.inverse_mass_b[contact], 1);
}

template class NarrowSweepsOf<2>::System;
template class NarrowSweepsOf<3>::System;

}  // namespace softgrain
