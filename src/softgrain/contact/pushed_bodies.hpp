#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "softgrain/contact/extrapolate.hpp"
#include "softgrain/contact/nlgs.hpp"

namespace softgrain {

/// A body that moves along one direction, and that its contacts push back:
///   v = v_free - mobility sum_c share_c p_n,c, cut to |v| <= v_most.
struct PushedBody {
  double free = 0;      ///< v_free [m/s]
  double mobility = 0;  ///< [1/kg]
  double most = 0;      ///< v_most [m/s]
  double assumed = 0;   ///< v for which a ContactSystem gives the velocities of the contacts [m/s]
  double push = 0;      ///< sum_c share_c p_n,c [N s]
  double before = 0;    ///< the same when it was last extrapolated

  double velocity() const { return std::clamp(free - mobility * push, -most, most); }
};

/// A contact and the body that it pushes.
struct Pushing {
  int contact = 0, body = 0;
  double share = 0;  ///< -du_n/dv
};

/// Bodies that many contacts share, for a ContactSystem that knows nothing of them: it leaves their contacts
/// out of its own sweep, and they are swept here, one after the other, with the velocity of their body as it
/// is at their turn. So any number of threads gives the same bits.
struct PushedBodies {
  std::vector<PushedBody> bodies;
  std::vector<Pushing> contacts;
  std::vector<char> pushes;  ///< (all contacts) 1 for those in `contacts`; empty if there are none

  bool has(int contact) const { return !pushes.empty() && pushes[static_cast<std::size_t>(contact)] != 0; }

  /// A contact of the system, `all` in number, with the normal impulse that it carries.
  void add(const Pushing& pushing, double p_n, int all) {
    pushes.resize(static_cast<std::size_t>(all));
    pushes[static_cast<std::size_t>(pushing.contact)] = 1;
    contacts.push_back(pushing);
    bodies[static_cast<std::size_t>(pushing.body)].push += pushing.share * p_n;
  }

  /// The pushes go ahead as impulses do (Extrapolation).
  void extrapolate(double b) {
    for (PushedBody& body : bodies) softgrain::extrapolate(body.push, body.before, b);
  }

  /// The turns of their contacts in a sweep of nonlinear Gauss-Seidel, with
  ///   u_n = u_n(v_assumed) - share (v - v_assumed),  W_nn + share^2 mobility.
  template <int Dim, ContactSystem<Dim> System>
  void sweep(System& system, std::span<Vec<Dim>> impulse, std::span<const double> friction, double relaxation,
             Violation& violation) {
    for (const Pushing& pushing : contacts) {
      const auto c = static_cast<std::size_t>(pushing.contact);
      WithBody<Dim, System> seen{system, bodies[static_cast<std::size_t>(pushing.body)], pushing.share};
      nlgs_update<Dim>(seen, pushing.contact, impulse[c], friction[c], relaxation, violation);
    }
  }

 private:
  /// The system as the contacts of a body see it.
  template <int Dim, class System>
  struct WithBody {
    System& system;
    PushedBody& body;
    double share;

    int size() const { return system.size(); }
    Vec<Dim> relative_velocity(int contact) const {
      Vec<Dim> u = system.relative_velocity(contact);
      u[0] -= share * (body.velocity() - body.assumed);
      return u;
    }
    Mat<Dim> delassus_block(int contact) const {
      Mat<Dim> W = system.delassus_block(contact);
      W(0, 0) += share * share * body.mobility;
      return W;
    }
    void apply_impulse(int contact, const Vec<Dim>& dp) {
      body.push += share * dp[0];
      system.apply_impulse(contact, dp);
    }
  };
};

}  // namespace softgrain
