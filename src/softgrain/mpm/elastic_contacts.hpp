#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/mpm/outline_contacts.hpp"

namespace softgrain {

/// Compliance of the outlines of the eight grains of a batch, (A^-1)_bb: (2 outline nodes)^2 row-major [m/N
/// per m depth].
using OutlineCompliance = std::vector<Wide>;

/// Memory of an ElasticContacts, kept from one to the next: megabytes that are written once, whose pages
/// would otherwise be given back to the system and asked for again in every Newton iteration.
struct ElasticScratch {
  std::vector<double> compliance, columns;
};

/// Contacts of implicit grains as a ContactSystem (theory: W = H^T A^-1 H/dt^2, with A = M/dt^2 + K): the
/// impulse sees the implicit operator, condensed grain by grain on the vertices that take part in contacts.
/// Velocities are those over the step:
///   u_n = (g + n . (du_slave - du_master))/dt,   u_t = (slip + t . (du_slave - du_master))/dt,
/// so that u_n >= 0 is "no penetration at the end of the step".
class ElasticContacts {
 public:
  /// increment: (outline vertices) du without contact forces [m]. compliance: one for each batch of the
  /// grains.
  ElasticContacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                  std::span<const OutlineCompliance> compliance, std::span<const Vec<2>> increment, double dt,
                  ElasticScratch& scratch);

  int size() const { return static_cast<int>(contacts_.size()); }
  const Mat<2>& delassus_block(int contact) const { return delassus_[contact]; }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);

 private:
  /// A grain's vertices in contact: `count` of them, from `first` in increment_ and from `matrix` in
  /// compliance_.
  struct Condensed {
    int count = 0;
    std::size_t first = 0, matrix = 0;
  };
  /// Where a contact finds its vertices' du in increment_: the slave's, then the master's four.
  struct Place {
    std::array<std::size_t, 5> at{};
    std::array<double, 5> weight{};  ///< 1, -w_k
    int count = 1;
    int slave_grain = 0, master_grain = -1;
    std::array<std::ptrdiff_t, 2> column{-1, -1};  ///< of n and t in columns_, once they are needed
  };
  void number_vertices();
  void copy_compliance(std::span<const OutlineCompliance> compliance);
  Place place_of(const OutlineContact& contact) const;
  const double* column(int contact, int axis);
  Mat<2> delassus_of(int contact) const;

  const SoftGrains& grains_;
  std::span<const OutlineContact> contacts_;
  double dt_;
  std::vector<int> local_;  // (outline vertices) number among the grain's vertices in contact, -1 if none
  std::vector<Condensed> condensed_;  // (grains)
  std::vector<Place> places_;         // (contacts)
  std::vector<double> increment_;     // du of the vertices in contact, grain by grain
  std::vector<double>& compliance_;
  std::vector<double>&
      columns_;  // du of the slave's, then of the master's grain under a unit force at a contact
  std::vector<Mat<2>> delassus_;
};

/// Force on each outline vertex from the contacts' impulses over dt [N/m].
std::vector<Vec<2>> contact_forces(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                   std::span<const Vec<2>> impulse, double dt);

}  // namespace softgrain
