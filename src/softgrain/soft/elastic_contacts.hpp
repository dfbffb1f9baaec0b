#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/contact/contact_levels.hpp"
#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/pushed_bodies.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/contact/solver_options.hpp"
#include "softgrain/core/shared_row.hpp"
#include "softgrain/soft/outline_contacts.hpp"

namespace softgrain {

/// Compliance of the outlines of the eight grains of a batch, (A^-1)_bb: grain after grain, each
/// (2 outline nodes)^2 row-major [m/N per m depth].
using OutlineCompliance = std::vector<double>;

/// Memory of an ElasticContacts, kept from one to the next: megabytes whose pages would otherwise be given
/// back to the system and asked for again in every Newton iteration.
struct ElasticScratch {
  std::vector<float> columns;
  std::vector<std::vector<double>> compliance;  ///< of vertices in contact, from each rank
};

/// Contacts of implicit grains as a ContactSystem (theory: W = H^T A^-1 H/dt^2, with A = M/dt^2 + K): the
/// impulse sees the implicit operator, condensed grain by grain on the vertices that take part in contacts.
/// Velocities are those over the step, with v = du/dt:
///   u_n = g/dt + n . (v_slave - v_master),   u_t = slip/dt + t . (v_slave - v_master),
/// so that u_n >= 0 is "no overlap at the end of the step".
class ElasticContacts {
 public:
  /// increment: (outline vertices) du without contact forces [m]. compliance: one for each batch of the
  /// grains, and no longer needed than the system. With `shared` ranks share the groups of contacts: each has
  /// the compliance of its own grains, and of rigid ones, and gets what its groups need of others. Nothing
  /// but sweeps and apply_impulses may look at contacts then, and impulses stay with their rank until gather.
  ElasticContacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                  std::span<const OutlineCompliance> compliance, std::span<const Vec<2>> increment, double dt,
                  ElasticScratch& scratch, bool shared = false);

  int size() const { return static_cast<int>(contact_.size()); }
  const Mat<2>& delassus_block(int contact) const { return contact_[contact].delassus; }
  Vec<2> relative_velocity(int contact) const {
    const Contact& c = contact_[contact];
    double x = 0, y = 0;
    for (int k = 0; k < c.vertices; ++k) {
      const double* v = &velocity_[c.velocity[k]];
      x += c.weight[k] * v[0];
      y += c.weight[k] * v[1];
    }
    const Vec<2>& n = c.normal;
    return {c.start[0] + (n[0] * x + n[1] * y), c.start[1] + (n[0] * y - n[1] * x)};
  }
  void apply_impulse(int contact, const Vec<2>& dp);
  /// apply_impulse at every contact, on all threads.
  void apply_impulses(std::span<const Vec<2>> impulse);
  /// One sweep of NLGS, on all threads: every second group of contacts, then the others (ContactLevels).
  Violation sweep(std::span<Vec<2>> impulse, std::span<const double> friction, const SolverOptions& options);
  /// v <- v + b (v - v'), v' the velocities when this was last called.
  void extrapolate(double b);
  /// Sweeps then move these bodies too. Keeps a reference.
  void push(PushedBodies& bodies) { pushed_ = &bodies; }
  /// On all ranks: these impulses, from the ranks that have them.
  void gather(std::span<Vec<2>> impulse) const;

 private:
  /// A grain's vertices in contact: vertex_[first .. first + count - 1]. Their velocities are `width`
  /// numbers, filled up with zeros, from `velocity` on in velocity_.
  struct Condensed {
    int first = 0, count = 0, velocity = 0, width = 0;
    int nodes = 0;                       ///< that the compliance is of:
    bool whole = true;                   ///< the whole outline, or the vertices in contact, from another rank
    const double* compliance = nullptr;  ///< of these
  };
  struct Contact {
    std::array<int, 7> vertex{};     ///< numbers in their compliance: the slave's, then the master's four
    std::array<int, 7> velocity{};   ///< theirs in velocity_
    std::array<double, 7> weight{};  ///< 1, -w_k; of a place at a wall or on a rigid arc w_k
    int vertices = 0;
    int of_slave() const { return master_grain >= 0 ? vertices - 4 : vertices; }
    int slave_grain = 0, master_grain = -1;
    Vec<2> normal, start;        ///< (g, slip)/dt [m/s]
    Mat<2> delassus;             ///< W_cc
    std::size_t column = 0;      ///< where its columns start
    std::array<bool, 2> made{};  ///< those of n and t
  };
  void number_vertices(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                       std::span<const Vec<2>> increment);
  void set(Contact& contact, const OutlineContact& found, const SoftGrains& grains) const;
  Mat<2> delassus_of(const Contact& contact) const;
  const float* column(Contact& contact, int axis);
  template <int Vertices>
  void fill(const Contact& contact, int first, int grain, const Vec<2>& direction, float* column) const;
  template <class Work>
  void for_each_in_order(const Work& work);
  template <class Visit>
  void for_each_grain(int group, const Visit& visit) const;
  void share_groups();
  void fetch_compliance(const SoftGrains& grains, ElasticScratch& scratch);
  /// Of a vertex in contact, in the grain's compliance.
  int number_of(const Condensed& grain, int local) const {
    return grain.whole ? vertex_[grain.first + local] : local;
  }

  double dt_;
  std::vector<Condensed> grain_;
  std::vector<int> local_;   // (outline vertices) place among the grain's vertices in contact, -1 if none
  std::vector<int> vertex_;  // the vertices in contact, by their number along the outline
  std::vector<double> velocity_;  // v of the vertices in contact, grain by grain
  std::vector<double> before_;    // the same when they were last extrapolated
  std::vector<Contact> contact_;
  // A^-1 H_c/dt^2 on the slave's, then on the master's grain; those of n come before those of t. In single
  // precision, as they are what a sweep reads.
  float* columns_;
  std::size_t tangential_ = 0;
  ContactLevels levels_;
  SharedRow row_of_groups_;
  std::vector<std::vector<int>> at_seam_;  // grains that the groups of a seam share
  std::vector<Violation> violation_;       // (groups)
  PushedBodies* pushed_ = nullptr;
};

/// Force on each outline vertex from the contacts' impulses over dt [N/m].
std::vector<Vec<2>> contact_forces(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                   std::span<const Vec<2>> impulse, double dt);

}  // namespace softgrain
