#include "softgrain/contact/block_sweeps.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/rigid/contact_blocks.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {
namespace {

/// Disks (spheres) in grains as a BlockSystem: `narrow` with the contacts that it leaves out, which take
/// their turns alone after the others between grains.
template <int Dim>
class GrainBlocks {
 public:
  GrainBlocks(NarrowSweepsOf<Dim>& narrow, typename NarrowSweepsOf<Dim>::System& system,
              PushedBodies& pressed, RigidContacts<Dim>& contacts, double relaxation)
      : narrow_(narrow), system_(system), pressed_(pressed), contacts_(contacts), relaxation_(relaxation) {
    for (const Pushing& of : pressed.contacts) alone_.push_back(of.contact);
    for (int c = contacts.first_crossing(); c < contacts.size(); ++c) alone_.push_back(c);
    before_.resize(alone_.size());
    for (const int c : alone_) system.apply_impulse(c, contacts.impulse[c]);
  }

  int blocks() const { return narrow_.blocks(); }
  double moved(int block) const { return narrow_.moved(block); }
  void sweep_blocks(std::span<const int> open, std::span<Violation> found, double b, bool measured) {
    narrow_.sweep_blocks(open, found, b, measured);
  }
  void go_ahead_between(double b) {
    narrow_.go_ahead_between(b);
    pressed_.extrapolate(b);
    for (std::size_t k = 0; k < alone_.size(); ++k) {
      Vec<Dim>& p = contacts_.impulse[alone_[k]];
      const Vec<Dim> last = p;
      extrapolate(p, before_[k], b);
      if (!(p == last)) system_.apply_impulse(alone_[k], p - last);
    }
  }
  Violation sweep_between(bool measured) {
    Violation violation = narrow_.sweep_between(measured);
    pressed_.template sweep<Dim>(system_, contacts_.impulse, contacts_.friction, relaxation_, violation);
    for (int c = contacts_.first_crossing(); c < contacts_.size(); ++c)
      nlgs_update<Dim>(system_, c, contacts_.impulse[c], contacts_.friction[c], relaxation_, violation);
    narrow_.end_sweep();
    return violation;
  }

 private:
  NarrowSweepsOf<Dim>& narrow_;
  typename NarrowSweepsOf<Dim>::System& system_;
  PushedBodies& pressed_;
  RigidContacts<Dim>& contacts_;
  double relaxation_;
  std::vector<int> alone_;
  std::vector<Vec<Dim>> before_;
};

}  // namespace

template <int Dim>
SolverReport RigidDynamics<Dim>::solve_in_single_precision(RigidContactSystem<Dim>& system,
                                                           const SolverOptions& solver, double dt) {
  narrow_.start(
      particles, contacts, [&](int begin, int end) { prepare(begin, end, dt); }, offset_, solver.relaxation,
      reference.shares);
  typename NarrowSweepsOf<Dim>::System alone(narrow_, particles, contacts, offset_);
  PushedBodies pressed = pressed_walls(dt);
  GrainBlocks<Dim> grains(narrow_, alone, pressed, contacts, solver.relaxation);
  const SolverReport report = BlockSweeps().solve(grains, solver.velocity_scale, solver);
  for_each_block(
      contacts, reference.shares,
      [&](int k) {
        narrow_.read_impulses(contacts.blocks[k], contacts.impulse);
        system.apply_impulses(k, contacts.impulse);
        overlaps_[k] = overlaps_of(contacts.blocks[k]);
      },
      [&](int k, Message& message) {
        const std::span<const int> touched = narrow_.touched(contacts.blocks[k].list);
        message.at(touched, std::span(particles.velocity));
        message.at(touched, std::span(particles.spin));  // n x (p n) is round-off, not 0
        message(overlaps_[k]);
      });
  move_presses(dt);
  return report;
}

template SolverReport RigidDynamics<2>::solve_in_single_precision(RigidContactSystem<2>&,
                                                                  const SolverOptions&, double);
template SolverReport RigidDynamics<3>::solve_in_single_precision(RigidContactSystem<3>&,
                                                                  const SolverOptions&, double);

}  // namespace softgrain
