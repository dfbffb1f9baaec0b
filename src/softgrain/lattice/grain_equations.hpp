#pragma once
#include <span>
#include <vector>

#include "softgrain/lattice/lattice.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/math/envelope_cholesky.hpp"

namespace softgrain {

/// The nodes of one grain on a lattice, as unknowns of a step by backward Euler (theory (60a)-(60d)): their
/// forces and their matrix
///   A = M/dt^2 + K,   K_ij = sum_p V_p (F_p^T dN_i) . dP/dF . (F_p^T dN_j),
/// F_p at the start of the step, dP/dF at its end. Nodes are numbered along the shorter side of the grain's
/// window, so that the rows of A are short.
class GrainEquations {
 public:
  /// The nodes that have mass, and which of them share a point.
  void number(const Lattice& lattice, int grain, std::span<const Stencil> stencil);

  /// Node of the lattice of each unknown.
  const std::vector<int>& nodes() const { return node_; }
  /// Unknown of a node of the grain's window; -1 without mass.
  int unknown(int node) const { return unknown_[node - first_node_]; }

  /// False if A is not positive definite.
  bool factor(const Lattice& lattice, const PointGrain& grain, std::span<const Stencil> stencil,
              std::span<const Mat<2>> F, const AnyLaw& law, double dt);
  /// x <- A^-1 x, by unknowns.
  void solve(std::span<Vec<2>> x) const { matrix_.solve(x); }
  /// A^-1/dt^2 on some unknowns, in rising order: velocities over impulses [1/kg], see EnvelopeCholesky.
  std::vector<double> compliance(std::span<const int> some, double dt) const;

 private:
  int grain_ = 0, first_node_ = 0;
  std::vector<int> node_, unknown_;
  std::vector<int> first_;  // (unknowns) that shares a point with each
  EnvelopeCholesky matrix_;
};

/// F_p at the end of a step in which the nodes have the velocities of the lattice: (1 + dt sum_i v_i (x)
/// dN_i) F_p. False if a point is turned inside out, or a number is not finite.
bool strained(const Lattice& lattice, int grain, const PointGrain& points, std::span<const Stencil> stencil,
              double dt, std::vector<Mat<2>>& F);

/// f_i = - sum_p V_p P(F_p') F_p^T dN_i [N/m] of a grain's nodes, F' at the end of the step and F at its
/// start, added to `force` of all nodes; with P F'^T of (56) for F' = F.
void add_internal_force(const Lattice& lattice, int grain, const PointGrain& points,
                        std::span<const Stencil> stencil, std::span<const Mat<2>> F, const AnyLaw& law,
                        std::span<Vec<2>> force);

/// sum_p V_p P(F_p') : (F_p' - F_p) [J/m], what the internal forces took from the nodes in the step.
double internal_work(const PointGrain& points, std::span<const Mat<2>> F, const AnyLaw& law);

}  // namespace softgrain
