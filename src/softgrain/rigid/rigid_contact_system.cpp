#include "softgrain/rigid/rigid_contact_system.hpp"

#include <cmath>

#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/math/lanes.hpp"
#include "softgrain/rigid/contact_blocks.hpp"
#include "softgrain/rigid/lane_sweep.hpp"

namespace softgrain {
namespace {

/// (s_a + s_b) x n: the surfaces' velocity at the contact.
Vec<2> surface_velocity(const Vec<1>& spin_sum, const Vec<2>& n) { return spin_sum[0] * perpendicular(n); }
Vec<3> surface_velocity(const Vec<3>& spin_sum, const Vec<3>& n) { return cross(spin_sum, n); }

/// n x P: how an impulse P at the contact turns both bodies.
Vec<1> turning(const Vec<2>& n, const Vec<2>& impulse) { return {n[0] * impulse[1] - n[1] * impulse[0]}; }
Vec<3> turning(const Vec<3>& n, const Vec<3>& impulse) { return cross(n, impulse); }

}  // namespace

template <int Dim>
void signorini_offset(const RigidContacts<Dim>& contacts, std::span<const Vec<Dim>> velocity_start,
                      const ContactLaw& law, double dt, std::vector<double>& offset) {
  offset.resize(contacts.size());
  signorini_offset<Dim>(contacts, velocity_start, law, dt, 0, offset);
}

template <int Dim>
void signorini_offset(const RigidContacts<Dim>& contacts, std::span<const Vec<Dim>> velocity_start,
                      const ContactLaw& law, double dt, int begin, std::span<double> offset) {
  const double* gap = contacts.gap.data() + begin;
  if (law.activation == Activation::anticipated) {
    const double open_rate = 1 / dt, closed_rate = law.push_out / dt;
    for (std::size_t k = 0; k < offset.size(); ++k)
      offset[k] = gap[k] * (gap[k] > 0 ? open_rate : closed_rate);
    return;
  }
  const double ahead = law.activation == Activation::closed_at_end_of_step ? dt / 2 : 0;
  for (std::size_t k = 0; k < offset.size(); ++k) {
    const int c = begin + static_cast<int>(k);
    const Vec<Dim> u =
        velocity_start[contacts.body_b[c]] - velocity_start[contacts.body_a[c]] + contacts.image_velocity(c);
    const double u_n = dot(contacts.normal[c], u);
    offset[k] = gap[k] + ahead * u_n <= 0 ? law.restitution * u_n : inactive_offset;
  }
}

template <int Dim>
Mat<Dim> RigidContactSystem<Dim>::delassus_block(int contact) const {
  const double W_nn = contacts_.inverse_mass_a[contact] + contacts_.inverse_mass_b[contact];
  Mat<Dim> W;
  W(0, 0) = W_nn;
  for (int k = 1; k < Dim; ++k) W(k, k) = (1 + particles_.inertia_ratio) * W_nn;
  return W;
}

template <int Dim>
Vec<Dim> relative_velocity(const RigidContacts<Dim>& contacts, int contact,
                           std::span<const Vec<Dim>> velocity, std::span<const Spin<Dim>> spin) {
  const int a = contacts.body_a[contact], b = contacts.body_b[contact];
  const Vec<Dim>& n = contacts.normal[contact];
  const Vec<Dim> along = velocity[b] - velocity[a] + contacts.image_velocity(contact);
  const Vec<Dim> slip = along - surface_velocity(spin[a] + spin[b], n);
  Vec<Dim> u;
  u[0] = dot(n, along);
  const auto t = tangents(n);
  for (int k = 1; k < Dim; ++k) u[k] = dot(t[k - 1], slip);
  return u;
}

template <int Dim>
Vec<Dim> RigidContactSystem<Dim>::relative_velocity(int contact) const {
  Vec<Dim> u = softgrain::relative_velocity<Dim>(contacts_, contact, particles_.velocity, particles_.spin);
  u[0] += offset_[contact];
  return u;
}

template <int Dim>
void RigidContactSystem<Dim>::apply_impulse(int contact, const Vec<Dim>& dp) {
  const int a = contacts_.body_a[contact], b = contacts_.body_b[contact];
  const double inverse_a = contacts_.inverse_mass_a[contact], inverse_b = contacts_.inverse_mass_b[contact];
  const Vec<Dim>& n = contacts_.normal[contact];
  const auto t = tangents(n);
  Vec<Dim> impulse = dp[0] * n;
  for (int k = 1; k < Dim; ++k) impulse += dp[k] * t[k - 1];
  particles_.velocity[a] -= inverse_a * impulse;
  particles_.velocity[b] += inverse_b * impulse;
  const Spin<Dim> turn = particles_.inertia_ratio * turning(n, impulse);
  particles_.spin[a] -= inverse_a * turn;
  particles_.spin[b] -= inverse_b * turn;
}

template <int Dim>
void RigidContactSystem<Dim>::relax_contact(int contact, Vec<Dim>& impulse, double friction,
                                            double relaxation, LaneViolation<double>& violation) {
  const double gain = relaxation * contacts_.inverse_delassus[contact];
  const Vec<Dim> solved = solve_uncoupled(impulse, relative_velocity(contact), gain,
                                          gain / (1 + particles_.inertia_ratio), friction);
  const Vec<Dim> dp = solved - impulse;
  impulse = solved;
  apply_impulse(contact, dp);
  violation.add(delassus_block(contact) * dp, solved[0]);
}

template <int Dim>
Violation RigidContactSystem<Dim>::sweep_block(int block, std::span<Vec<Dim>> impulse,
                                               std::span<const double> friction, double relaxation) {
  Violation violation;
  LaneViolation<double> one_by_one;
  const ContactBlock& contacts = contacts_.blocks[block];
  for (const ContactBatch* batch : {&contacts.frictionless, &contacts.frictional}) {
    int c = batch->begin;
    if constexpr (Dim == 2) {
      if (c < batch->fours_end)
        violation += sweep_fours({particles_, contacts_, offset_, impulse, friction, relaxation}, *batch,
                                 batch == &contacts.frictional);
      c = batch->fours_end;
    }
    for (; c < batch->end; ++c) relax_contact(c, impulse[c], friction[c], relaxation, one_by_one);
  }
  return violation += one_by_one.total(relaxation);
}

template <int Dim>
Violation RigidContactSystem<Dim>::sweep(std::span<Vec<Dim>> impulse, std::span<const double> friction,
                                         const SolverOptions& options) {
  std::vector<Violation> found(contacts_.blocks.size());
  for_each_block(static_cast<int>(contacts_.blocks.size()),
                 [&](int k) { found[k] = sweep_block(k, impulse, friction, options.relaxation); });
  Violation violation;
  for (const Violation& of_block : found) violation += of_block;
  if (pushed_) pushed_->sweep<Dim>(*this, impulse, friction, options.relaxation, violation);
  LaneViolation<double> crossing;
  for (int c = contacts_.first_crossing(); c < size(); ++c)
    relax_contact(c, impulse[c], friction[c], options.relaxation, crossing);
  return violation += crossing.total(options.relaxation);
}

template <int Dim>
void RigidContactSystem<Dim>::extrapolate(double b) {
  velocity_before_.resize(particles_.velocity.size());
  spin_before_.resize(particles_.spin.size());
  parallel_ranges(static_cast<int>(velocity_before_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      softgrain::extrapolate(particles_.velocity[i], velocity_before_[i], b);
      softgrain::extrapolate(particles_.spin[i], spin_before_[i], b);
    }
  });
  if (pushed_) pushed_->extrapolate(b);
}

template <int Dim>
void RigidContactSystem<Dim>::apply_impulses(int block, std::span<const Vec<Dim>> impulse) {
  const ContactBlock& contacts = contacts_.blocks[block];
  int c = contacts.begin();
  if constexpr (Dim == 2) {
    push_fours(particles_, contacts_, impulse, contacts.frictionless);
    c = contacts.frictionless.fours_end;
  }
  for (; c < contacts.end(); ++c)
    if (impulse[c][0] != 0) apply_impulse(c, impulse[c]);
}

template <int Dim>
void RigidContactSystem<Dim>::apply_impulses(std::span<const Vec<Dim>> impulse) {
  for_each_block(static_cast<int>(contacts_.blocks.size()), [&](int k) { apply_impulses(k, impulse); });
}

template void signorini_offset<2>(const RigidContacts<2>&, std::span<const Vec<2>>, const ContactLaw&, double,
                                  int, std::span<double>);
template void signorini_offset<2>(const RigidContacts<2>&, std::span<const Vec<2>>, const ContactLaw&, double,
                                  std::vector<double>&);
template void signorini_offset<3>(const RigidContacts<3>&, std::span<const Vec<3>>, const ContactLaw&, double,
                                  int, std::span<double>);
template void signorini_offset<3>(const RigidContacts<3>&, std::span<const Vec<3>>, const ContactLaw&, double,
                                  std::vector<double>&);
template Vec<2> relative_velocity<2>(const RigidContacts<2>&, int, std::span<const Vec<2>>,
                                     std::span<const Spin<2>>);
template Vec<3> relative_velocity<3>(const RigidContacts<3>&, int, std::span<const Vec<3>>,
                                     std::span<const Spin<3>>);
template class RigidContactSystem<2>;
template class RigidContactSystem<3>;

}  // namespace softgrain
