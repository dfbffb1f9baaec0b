#pragma once
#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/math/padded_vec.hpp"
#include "softgrain/math/tensor.hpp"
#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// How something turns: about e_z, in space about any axis.
template <int Dim, class T = double>
using SpinOf = std::conditional_t<Dim == 2, T, Vec<3, T>>;

/// A rigid grain in an explicit step.
template <int Dim>
struct LumpedBodyOf {
  Vec<Dim> centre;     ///< x_c where contacts take place and normal, OutlineState::normals_at of the step [m]
  Vec<Dim> velocity;   ///< [m/s]
  SpinOf<Dim> spin{};  ///< [1/s]
  double inverse_mass = 0, inverse_inertia = 0;  ///< [m/kg], [m/(kg m^2)]; in space without "m/"
  double radius = 0;                             ///< of a sphere, which takes part by its centre [m]
  Mat<3> inverse_tensor{};  ///< I^-1 of a body in space that is no sphere, whose radius is 0 [1/(kg m^2)]

  /// At the place x, of a sphere at its centre.
  Vec<Dim> velocity_at(const Vec<Dim>& x) const {
    if constexpr (Dim == 2)
      return velocity + spin * perpendicular(x - centre);
    else
      return radius > 0 ? velocity : velocity + cross(spin, x - centre);
  }
};
using LumpedBody = LumpedBodyOf<2>;

/// Which vertices belong to rigid grains.
template <int Dim>
struct LumpedBodiesOf {
  std::vector<LumpedBodyOf<Dim>> body;
  std::vector<int> of_vertex;  ///< (outline vertices) number of the body, or -1; empty if there are none

  int at(int vertex) const { return of_vertex.empty() ? -1 : of_vertex[static_cast<std::size_t>(vertex)]; }
};
using LumpedBodies = LumpedBodiesOf<2>;

/// The contacts of rigid grains among those of LumpedContacts: with w = sum_k w_k over the vertices that a
/// contact has on a body, and r the way from x_c to where it acts,
///   u = sum over soft vertices of w_k v_k + sum over bodies of (w v_c + omega x r),
///   W = sum w_k^2/m_k 1 + sum (w^2/m 1 + (r x)^T (r x)/I).
/// r = sum_k w_k (x_k - x_c). A sphere takes part by its centre, and r = -R n on either side. In space I^-1
/// of other bodies is a tensor, and W has (r x)^T I^-1 (r x). A body meets contacts all around it: they are
/// swept one after the other, so that any number of threads gives the same bits.
template <int Dim>
class BodyContacts {
 public:
  /// As LumpedSystem; keeps a reference to the bodies too, which have the velocities u_found now.
  BodyContacts(std::span<const ContactOf<Dim>> contacts, const OutlineStateOf<Dim>& outline,
               std::span<ScatteredVec<Dim>> velocity, std::span<const double> inverse_mass,
               LumpedBodiesOf<Dim>& bodies);

  bool has(int contact) const { return !row_of_.empty() && row_of_[static_cast<std::size_t>(contact)] >= 0; }
  std::span<const int> contacts() const { return contact_; }
  const Mat<Dim>& delassus_block(int contact) const { return row(contact).delassus; }
  Vec<Dim> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<Dim>& dp);

 private:
  static constexpr std::size_t most_vertices = Dim == 2 ? 5 : 32;
  struct Side {
    int body = -1;
    double weight = 0;
    Vec<Dim> arm;  // e_z x r, in space r
  };
  struct Row {
    int vertices = 0;  // of soft grains
    std::array<int, most_vertices> vertex{};
    std::array<double, most_vertices> weight{}, mobility{};
    std::array<Side, 2> side;
    Vec<Dim> normal, offset;
    Mat<Dim> delassus;
  };
  const Row& row(int contact) const { return rows_[row_of_[static_cast<std::size_t>(contact)]]; }
  Row make_row(const ContactOf<Dim>& contact, const OutlineStateOf<Dim>& outline,
               std::span<const double> inverse_mass) const;
  Vec<Dim> velocity_of(const Row& row) const;

  std::vector<Row> rows_;
  std::vector<int> contact_;  // of each row
  std::vector<int> row_of_;   // (all contacts) or -1; empty if there are no bodies
  std::span<ScatteredVec<Dim>> velocity_;
  LumpedBodiesOf<Dim>& bodies_;
};

}  // namespace softgrain
