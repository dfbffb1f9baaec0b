#pragma once
#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "softgrain/math/tensor.hpp"
#include "softgrain/rigid/particles.hpp"
#include "softgrain/soft/curve_weights.hpp"
#include "softgrain/soft/outline_state.hpp"

namespace softgrain {

/// A primary of a bonded grain at the outline of an elastic one. The outline's vertices meet the disk, and so
/// does each span of the smooth curve between two of them where it comes nearest: neither sinks between the
/// other's. A single place of the whole curve would jump from span to span, which makes energy
/// (docs/decisions/0080).
///
/// As between outlines the gap is that at the end of a flight without forces; place and normal are those
/// half-way (OutlineContact).
struct PrimaryContact {
  int primary = 0;
  int grain = 0;              ///< the elastic one, by its number among these
  int vertex = -1;            ///< of the outline; or -1: a span of its curve
  std::array<int, 4> span{};  ///< c(xi) of these vertices (curve_weights), between the middle two
  double share = 0;           ///< xi
  Vec<2> normal{};            ///< unit, from the primary to the outline
  double gap = 0;             ///< |x - x_c| - r [m], open > 0
  Vec<2> image{};  ///< from where the outline is to where the primary sees it, at the end of the step [m]
  Vec<2> image_motion{};  ///< of that image against the outline over the step [m]

  /// The contacts of a step differ in it, and are sorted by it.
  auto key() const { return std::tuple(primary, grain, vertex >= 0 ? 2 * vertex : 2 * span[1] + 1); }
  /// visit(vertex, weight) of the outline's place x = sum weight x_k.
  template <class Visit>
  void for_each_vertex(Visit&& visit) const {
    if (vertex >= 0) return visit(vertex, 1.0);
    const auto weight = curve_weights(share);
    for (std::size_t k = 0; k < 4; ++k) visit(span[k], weight[k]);
  }
};

/// p_n n + p_t t [N s/m], on the outline; the primary gets the opposite.
inline Vec<2> impulse_vector(const PrimaryContact& contact, const Vec<2>& impulse) {
  return impulse[0] * contact.normal + impulse[1] * perpendicular(contact.normal);
}

/// What contacts gave in a step, with the velocities in the mean of its start and its end [J/m].
struct PrimaryWork {
  double on_outlines = 0, on_primaries = 0;
  double by_cell = 0;   ///< by the cell, whose images go faster than their outlines
  double friction = 0;  ///< of what all lost: by sliding
};

/// Contacts of primaries and outlines as a ContactSystem. At x_c + r n a primary with s = r omega moves by
/// v + s t:
///   u = sum_k w_k v_k - v - s t,  W = diag(M + 1/m, M + (1 + kappa)/m),  M = sum_k w_k^2/m_k,
/// kappa = m r^2/I. u_n has the offset of anticipated contacts (signorini_offset),
///   max(g, 0)/dt + beta min(g, 0)/dt,  g = g_end - dt n . u_found,
/// g_end the gap of the flight with the velocities u_found.
class PrimaryContactSystem {
 public:
  /// At the velocities u_found with which the contacts were found. outline_velocity: (outline vertices)
  /// [m/s], those of now; of the start they are what brings outline.start to outline.position in dt.
  /// inverse_mass: (outline vertices) [m/kg]. push_out: beta. Keeps references to the velocities and to the
  /// primaries.
  PrimaryContactSystem(std::span<const PrimaryContact> contacts, const OutlineState& outline,
                       std::span<Vec<2>> outline_velocity, std::span<const double> inverse_mass,
                       RigidParticles<2>& primaries, double push_out = 1);

  int size() const { return static_cast<int>(rows_.size()); }
  Mat<2> delassus_block(int contact) const { return Mat<2>::diagonal(rows_[contact].delassus); }
  Vec<2> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<2>& dp);
  void apply_impulses(std::span<const Vec<2>> impulse);
  /// The other systems have the velocities.
  void extrapolate(double) {}

  /// Once the velocities are those of the end.
  PrimaryWork work(std::span<const Vec<2>> impulse) const;

 private:
  struct Row {
    int primary = 0, vertices = 0;
    std::array<int, 4> vertex{};
    std::array<double, 4> weight{}, mobility{};
    Vec<2> normal, delassus;
    double offset = 0;
    Vec<2> image;                         // velocity of the outline's image against it
    Vec<2> outline_start, primary_start;  // velocities there at the start
  };
  Vec<2> outline_velocity(const Row& row) const;
  Vec<2> primary_velocity(const Row& row) const;

  std::vector<Row> rows_;
  std::span<Vec<2>> velocity_;
  RigidParticles<2>& primaries_;
};

}  // namespace softgrain
