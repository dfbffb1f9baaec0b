#pragma once
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/pushed_bodies.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/contact/tangents.hpp"
#include "softgrain/core/shared_row.hpp"
#include "softgrain/soft/contact_strips.hpp"
#include "softgrain/soft/lumped_bodies.hpp"
#include "softgrain/soft/lumped_row.hpp"

namespace softgrain {

/// Contacts of explicit grains as a ContactSystem: the outline's lumped masses answer at once,
///   u = v_slave - sum_k w_k v_k,   W = (1/m_slave + sum_k w_k^2/m_k) 1,
/// or at a wall sum_k w_k v_k and sum_k w_k^2/m_k,
/// with u_n changed to the gap at the end of the step over dt, (g + dt n . (u - u_found))/dt, where u_found
/// had brought the outlines to where the contacts were found.
template <int Dim>
class LumpedSystem {
 public:
  struct Scratch;
  /// velocity: (outline vertices) [m/s], u_found when constructed, then changed by the caller and by
  /// impulses, as are those of the rigid bodies; inverse_mass: (outline vertices) [m/kg]. Keeps references to
  /// the contacts, the velocities, the masses, the bodies and the scratch. With `shared` ranks share the
  /// strips: nothing but sweeps and apply_impulses may look at contacts and velocities then, until gather.
  LumpedSystem(std::span<const ContactOf<Dim>> contacts, const OutlineStateOf<Dim>& outline,
               std::span<ScatteredVec<Dim>> velocity, std::span<const double> inverse_mass,
               LumpedBodiesOf<Dim>& bodies, Scratch& scratch, bool shared = false);

  int size() const { return static_cast<int>(rows_.size()); }
  Mat<Dim> delassus_block(int contact) const {
    if (of_bodies_.has(contact)) return of_bodies_.delassus_block(contact);
    Vec<Dim> W;
    for (int k = 0; k < Dim; ++k) W[k] = row(contact).delassus();
    return Mat<Dim>::diagonal(W);
  }
  Vec<Dim> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<Dim>& dp);
  /// The impulses of all contacts.
  void apply_impulses(std::span<const Vec<Dim>> impulse);
  /// One pass of Gauss-Seidel, first over the even strips, then over the odd ones, then over the contacts of
  /// rigid bodies, those of pushed bodies last. Where W is a multiple of 1, a
  /// contact is solved by
  ///   p_n = max(0, p_n - u_n/W),  p_t = p_t - u_t/W, cut to |p_t| <= mu p_n.
  /// In space contacts that the first sweep finds wide open have their next turns only in sweeps that would
  /// be the last; those that have closed by then have all turns that follow.
  Violation sweep(std::span<Vec<Dim>> impulse, std::span<const double> friction,
                  const SolverOptions& options);
  /// Velocities go ahead as impulses do (Extrapolation).
  void extrapolate(double b);
  /// Sweeps then move these bodies too. Keeps a reference.
  void push(PushedBodies& bodies) { pushed_ = &bodies; }
  /// On all ranks: the velocities and these impulses, from the ranks that have them.
  void gather(std::span<Vec<Dim>> impulse);

 private:
  using Row = LumpedRow<Dim>;

  const Row& row(int contact) const { return rows_[strips_.place[contact]]; }
  void make_rows(const OutlineStateOf<Dim>& outline);
  void set_offset(Row& row, const OutlineStateOf<Dim>& outline) const;
  Vec<Dim> velocity_of(const Row& row) const { return row.velocity(velocity_.data()); }
  Vec<Dim> relative_velocity(const Row& row) const;
  void apply_impulse(const Row& row, const Vec<Dim>& dp);
  double solve(const Row& row, Vec<Dim>& p, double friction, const SolverOptions& options,
               Violation& violation);
  struct Sweep;
  void sweep_strip(int strip, const Sweep& sweep, Violation& violation);
  void sort_by_need(int strip, const Sweep& sweep, Violation& violation);
  void look_at_open(int strip, const Sweep& sweep, Violation& violation);
  Violation sweep_strips(const std::function<void(int strip, Violation& violation)>& work);
  // no templates, so that the law is compiled into the sweeps (decision 0072)
  void for_each_strip(const std::function<void(int strip)>& work);
  void for_each_own_strip(const std::function<void(int strip)>& work) const;
  void share_strips(bool ring);
  template <class Visit>
  void for_each_vertex(int strip, const Visit& visit) const;

  std::span<const ContactOf<Dim>> contacts_;
  Scratch& scratch_;
  std::vector<Row>& rows_;  // strip by strip; of this rank's
  ContactStrips& strips_;
  SharedRow row_of_strips_;
  std::vector<std::vector<int>> at_seam_;  // vertices that the strips of a seam share
  std::span<ScatteredVec<Dim>> velocity_;
  std::span<const double> inverse_mass_;
  LumpedBodiesOf<Dim>& bodies_;
  BodyContacts<Dim> of_bodies_;
  PushedBodies* pushed_ = nullptr;
  bool sorted_by_need_ = false;
};

using LumpedContacts = LumpedSystem<2>;

/// Memory kept from step to step.
template <int Dim>
struct LumpedSystem<Dim>::Scratch {
  std::vector<Row> rows;
  ContactStrips strips;
  /// In space: rows and strips are those of the contacts already, which have not changed since the last
  /// system.
  bool kept = false;
  /// (contacts) rows strip by strip: of each first those that have their turn in every sweep, at the end
  /// those that are wide open
  std::vector<int> turn;
  std::vector<int> busy_end, open_begin;           ///< (strips) in `turn`
  std::vector<ScatteredVec<Dim>> velocity_before;  ///< of extrapolate
  std::vector<LumpedBodyOf<Dim>> body_before;
};

}  // namespace softgrain
