#pragma once
#include <functional>
#include <span>
#include <vector>

#include "softgrain/geometry/periodic_cell.hpp"
#include "softgrain/math/vec.hpp"
#include "softgrain/soft/curve_weights.hpp"
#include "softgrain/soft/outline_state.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

/// The outline of a grain is the smooth closed curve through its vertices (curve_weights).
///
/// An outline vertex (the slave) against another grain's outline (the master), or against a wall. Both grains
/// of a pair bring their vertices, so that neither outline sinks between the vertices of the other. To a wall
/// a vertex brings its arc (OutlineArc): it faces the wall with the place of the arc that lies lowest. So
/// does a vertex of a rigid grain to another rigid one, which nothing makes fit it (docs/decisions/0047).
///
/// Gaps are those at the end of the step; the place on a master and its normal are those at
/// OutlineState::normals_at, half-way unless said otherwise: along a convex outline n . dx then is the change
/// of the gap but for terms of third order, so that contact gives no energy. With the normal of the end it is
/// more, by half the curvature times the square of the slip (docs/decisions/0026).
struct OutlineContact {
  int vertex = 0;  ///< the slave
  int wall = -1;   ///< or -1
  std::array<int, 4>
      master{};      ///< vertices x_0 .. x_3 of the curve that it faces; at a wall its own, x_1 the slave
  double share = 0;  ///< xi: the slave faces c(xi); at a wall x_1 + xi (x_2 - x_0)/2 faces the wall
  double rise = 0;   ///< of the arc over that place, away from the wall [m]
  double along = 0, inward = 0;  ///< of a rigid slave: where on its arc it touches (ArcPlace)
  std::array<int, 2> beside{};   ///< then the vertices beside it
  Vec<2> normal{};        ///< unit, from the master to the slave: the gradient of the gap, at normals_at
  double gap = 0;         ///< g = (x_slave - c) . n [m], open > 0
  double slip = 0;        ///< tangential displacement of slave against master since the start of the step [m]
  Vec<2> image{};         ///< from where the master is to where the slave sees it, at the end of the step [m]
  Vec<2> image_motion{};  ///< of that image against the master over the step [m]

  /// Where the slave is, of outlines at x [m].
  Vec<2> slave_at(std::span<const Vec<2>> x) const {
    if (inward == 0) return x[vertex];
    const Vec<2>&before = x[beside[0]], &after = x[beside[1]];
    return (1 - inward) * x[vertex] + ((inward - along) / 2) * before + ((inward + along) / 2) * after;
  }
  /// One of the master's vertices.
  int facing_vertex() const { return master[0]; }
  /// Weights of the master's vertices, if there is one.
  std::array<double, 4> weights() const { return curve_weights(share); }
  /// visit(vertex, weight) for all vertices that take part: dg = n . sum weight dx.
  template <class Visit>
  void for_each_vertex(Visit&& visit) const {
    if (inward == 0) {
      visit(vertex, 1.0);
    } else {
      visit(vertex, 1 - inward);
      visit(beside[0], (inward - along) / 2);
      visit(beside[1], (inward + along) / 2);
    }
    if (wall >= 0) {
      if (share == 0) return;
      visit(master[0], -share / 2);
      visit(master[2], share / 2);
      return;
    }
    const auto weight = weights();
    for (std::size_t k = 0; k < 4; ++k) visit(master[k], -weight[k]);
  }
};

/// Finds the contacts of outlines: which grains a vertex may meet is looked up among cells, and kept until
/// some vertex has moved far; where on their outline it faces them is walked to from where it did last. Cost
/// O(vertices), which ranks share: all call it alike, and all get all contacts.
class OutlineNeighbours {
 public:
  /// From now on contacts are kept up to at least this gap [m], and where vertices_only(kind, other kind or
  /// -1 for walls) vertices bring no arcs: what acts across a gap is summed over places at even distances.
  void keep(double range, std::function<bool(int, int)> vertices_only);
  /// All contacts with gap < margin, sorted by (vertex, master grain or wall); the margin is in units of the
  /// mean segment of the outlines, at most 0.5.
  std::vector<OutlineContact> detect(const SoftGrains& grains, const OutlineState& state,
                                     double margin = 0.5);

 private:
  /// A slave vertex, and the vertex of a master grain that was nearest to it.
  struct Candidate {
    int vertex = 0, nearest = 0;
  };
  /// Vertices begin .. end - 1, which one thread takes at once.
  struct Part {
    int begin = 0, end = 0;
    std::vector<Candidate> candidates;     // sorted by (vertex, master grain)
    std::vector<OutlineContact> contacts;  // of the last call
    bool moved_far = false;
  };
  bool moved_far(const OutlineState& state);
  void find_candidates(const SoftGrains& grains, const OutlineState& state);
  void find_contacts(const SoftGrains& grains, const OutlineState& state, double margin, Part& part) const;
  OutlineContact wall_contact(const SoftGrains& grains, const OutlineState& state, int wall, int v,
                              double height) const;

  std::vector<Part> parts_;        // all vertices, in order
  Shares shares_;                  // of parts: whose candidates a rank knows
  std::vector<Vec<2>> reference_;  // positions when the candidates were found
  PeriodicCell<2> reference_cell_;
  std::vector<Vec<2>> on_the_way_;               // where normals are taken [m]
  double segment_ = 0;                           // mean length of a segment of the round grains [m]
  double range_ = 0;                             // up to which contacts are kept in any case [m]
  std::function<bool(int, int)> vertices_only_;  // or empty
};

/// Gap of a contact when its bodies have moved a little since it was found [m].
double gap_now(const OutlineContact& contact, const OutlineState& state);

/// p_n n + p_t t [N s/m], on the slave.
inline Vec<2> impulse_vector(const OutlineContact& contact, const Vec<2>& impulse) {
  return impulse[0] * contact.normal + impulse[1] * perpendicular(contact.normal);
}

/// Displacement of the slave since the start of the step, less that of the place or wall that it faces [m].
Vec<2> relative_displacement(const OutlineContact& contact, const OutlineState& state);

/// Impulses of `old` contacts [N s/m], given to the new contacts of the same vertex and master grain or wall.
/// Both lists are sorted by vertex.
std::vector<Vec<2>> carried_impulses(const SoftGrains& grains, std::span<const OutlineContact> old,
                                     std::span<const Vec<2>> old_impulse,
                                     std::span<const OutlineContact> contacts);

}  // namespace softgrain
