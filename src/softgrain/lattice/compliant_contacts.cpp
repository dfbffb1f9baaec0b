#include "softgrain/lattice/compliant_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/math/tensor.hpp"

namespace softgrain {

CompliantContacts::CompliantContacts(const Lattice& lattice, const LatticeContacts& contacts,
                                     std::span<const GrainEquations> equations, double dt,
                                     CompliantContacts* before)
    : contacts_(contacts), grain_(equations.size()) {
  find_nodes(lattice, equations);
  parallel_for(static_cast<int>(grain_.size()), [&](int g) {
    Grain& grain = grain_[g];
    if (before != nullptr && before->grain_[g].unknown == grain.unknown)
      grain.compliance = std::move(before->grain_[g].compliance);
    else
      grain.compliance = equations[g].compliance(grain.unknown, dt);
  });
  find_shares(lattice, equations);
  for (int c = 0; c < size(); ++c) delassus_.push_back(find_delassus(c));
}

void CompliantContacts::find_nodes(const Lattice& lattice, std::span<const GrainEquations> equations) {
  const auto grain_of = [&](int contact, int node) {
    const LatticeContact& c = contacts_.contacts()[contact];
    return c.other >= 0 && lattice.holds(c.other, node) ? c.other : c.grain;
  };
  for (int c = 0; c < size(); ++c)
    for (const NodeWeight& w : contacts_.weights_of(c)) {
      const int g = grain_of(c, w.node);
      grain_[g].unknown.push_back(equations[g].unknown(w.node));
    }
  for (std::size_t g = 0; g < grain_.size(); ++g) {
    std::vector<int>& unknown = grain_[g].unknown;
    std::sort(unknown.begin(), unknown.end());
    unknown.erase(std::unique(unknown.begin(), unknown.end()), unknown.end());
    grain_[g].first = static_cast<int>(node_.size());
    for (const int u : unknown) node_.push_back(equations[g].nodes()[u]);
  }
  velocity_.resize(node_.size());
}

void CompliantContacts::find_shares(const Lattice& lattice, std::span<const GrainEquations> equations) {
  for (int c = 0; c < size(); ++c) {
    const LatticeContact& contact = contacts_.contacts()[c];
    for (const NodeWeight& w : contacts_.weights_of(c)) {
      const int g =
          contact.other >= 0 && lattice.holds(contact.other, w.node) ? contact.other : contact.grain;
      const std::vector<int>& unknown = grain_[g].unknown;
      const auto found = std::lower_bound(unknown.begin(), unknown.end(), equations[g].unknown(w.node));
      shares_.push_back({g, grain_[g].first + static_cast<int>(found - unknown.begin()), w.weight});
    }
    begin_.push_back(static_cast<int>(shares_.size()));
  }
}

/// sum_ij w_i w_j C_ij over nodes of the same grain, in the frame of the contact.
Mat<2> CompliantContacts::find_delassus(int contact) const {
  Mat<2> W;
  for (const Share& i : shares_of(contact))
    for (const Share& j : shares_of(contact)) {
      if (i.grain != j.grain) continue;
      const Grain& grain = grain_[i.grain];
      const std::size_t stride = 2 * grain.unknown.size();
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          W(a, b) +=
              i.weight * j.weight *
              grain.compliance[(2 * (i.place - grain.first) + a) * stride + 2 * (j.place - grain.first) + b];
    }
  const Vec<2>& n = contacts_.contacts()[contact].normal;
  const Vec<2> t = perpendicular(n), along_n = W * n, along_t = W * t;
  return {{dot(n, along_n), dot(n, along_t), dot(t, along_n), dot(t, along_t)}};
}

void CompliantContacts::start(std::span<const Vec<2>> node_velocity, std::span<const Vec<2>> impulse) {
  for (std::size_t k = 0; k < node_.size(); ++k) velocity_[k] = node_velocity[node_[k]];
  for (int c = 0; c < size(); ++c)
    if (!(impulse[c] == Vec<2>{})) apply_impulse(c, impulse[c]);
  before_ = velocity_;
}

Vec<2> CompliantContacts::relative_velocity(int contact) const {
  const LatticeContact& c = contacts_.contacts()[contact];
  Vec<2> u = -c.wall_velocity;
  for (const Share& s : shares_of(contact)) u += s.weight * velocity_[s.place];
  return {dot(c.normal, u) + c.gap_rate, dot(perpendicular(c.normal), u)};
}

void CompliantContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const Vec<2>& n = contacts_.contacts()[contact].normal;
  const Vec<2> P = dp[0] * n + dp[1] * perpendicular(n);
  for (const Share& s : shares_of(contact)) {
    const Grain& grain = grain_[s.grain];
    const std::size_t stride = 2 * grain.unknown.size();
    // rows of a symmetric matrix are its columns
    const double* x = grain.compliance.data() + 2 * (s.place - grain.first) * stride;
    const double *y = x + stride, px = s.weight * P[0], py = s.weight * P[1];
    double* v = velocity_[grain.first].c.data();
    for (std::size_t k = 0; k < stride; ++k) v[k] += px * x[k] + py * y[k];
  }
}

void CompliantContacts::extrapolate(double b) {
  for (std::size_t k = 0; k < velocity_.size(); ++k) softgrain::extrapolate(velocity_[k], before_[k], b);
}

}  // namespace softgrain
