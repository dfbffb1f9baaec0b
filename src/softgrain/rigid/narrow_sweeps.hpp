#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "softgrain/contact/law.hpp"
#include "softgrain/math/narrow.hpp"
#include "softgrain/rigid/contact_blocks.hpp"
#include "softgrain/rigid/contacts.hpp"
#include "softgrain/rigid/narrow_rows.hpp"
#include "softgrain/rigid/neighbours.hpp"
#include "softgrain/rigid/particles.hpp"

namespace softgrain {

/// NLGS over disks (spheres) in single precision, eight contacts at once: the law of
/// RigidContactSystem::sweep, block by block (docs/decisions/0022). Positions, gaps and the velocities that a
/// step leaves stay in double: they follow from the impulses found here, which act on both bodies alike. Same
/// bits on any number of threads.
template <int Dim>
class NarrowSweepsOf {
 public:
  /// Starts from the free velocities of the bodies and the impulses of the contacts, which act at once.
  /// `prepare(begin, end)` makes sure of normals, impulses and `offset` (m) [m/s], as from signorini_offset,
  /// of these contacts; omega = `relaxation`.
  /// Ranks have their shares of the blocks until the next start.
  template <class Prepare>
  void start(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts, const Prepare& prepare,
             std::span<const double> offset, double relaxation, const Shares& shares = {}) {
    take_bodies(particles, contacts, relaxation);
    shares_ = shares;
    for_each_block(
        contacts, shares,
        [&](int k) {
          const ContactBlock& block = contacts.blocks[k];
          prepare(block.begin(), block.end());
          take_contacts(contacts, block, offset);
        },
        [&](int k, Message& message) { pass_touched(blocks_[listed_[k]], message); });
  }

  /// One sweep of all blocks. The violation is counted only if `measured`.
  Violation sweep(bool measured);

  // As a BlockSystem; sweep_between leaves out the contacts that no block sweeps, and end_sweep closes each
  // sweep.
  int blocks() const { return std::max(static_cast<int>(listed_.size()) - 1, 0); }
  void sweep_blocks(std::span<const int> open, std::span<Violation> found, double ahead, bool measured);
  void go_ahead_between(double ahead);
  Violation sweep_between(bool measured);
  void end_sweep();
  double moved(int block) const { return blocks_[listed_[block]].moved; }
  /// The bodies of a grain that have contacts between grains.
  std::span<const int> touched(int grain) const { return touched(blocks_[grain]); }

  /// As a ContactSystem, for the contacts that no block sweeps (ContactBlock::pressed, crossing): u under all
  /// impulses so far, with `offset` as in start, and what an impulse does.
  class System;

  /// The impulses found, (p_n, p_t) [N s/m], of a block of contacts.
  void read_impulses(const ContactBlock& listed, std::span<Vec<Dim>> impulse) const;

 private:
  using Floats = Narrow::Floats;
  static constexpr int eight = Wide::size;

  using Velocity = NarrowRow<Dim>;  // of a body [m/s]
  using Turn = NarrowRow<spin_size<Dim>>;
  using Vector = Vec<Dim, Floats>;
  using Tangential = Vec<Dim - 1, Floats>;
  using Turning = Vec<spin_size<Dim>, Floats>;
  /// Contacts that share no particle. Lanes left over hold a contact of a body at rest with itself.
  struct Eight {
    int a[eight], b[eight];
    Vector n;
    Floats inverse_a, inverse_b, gain, offset, p_n, p_n_before;  // gain: omega / W_nn
  };
  struct FrictionalEight : Eight {
    Floats friction;
    Tangential p_t, p_t_before;
    std::array<Vector, Dim == 2 ? 0 : 2> t;  // tangents; in the plane (-n_y, n_x)
  };
  /// The contacts begin .. begin + count - 1 of a block are an Eight.
  struct Place {
    int begin, count;
  };
  template <class AnyEight>
  struct Batch {
    std::vector<AnyEight> eights;
    std::vector<Place> places;
  };
  /// A ContactBlock, made again only when its list is.
  struct Block {
    int made = -1;
    Batch<Eight> frictionless;
    Batch<FrictionalEight> frictional;
    GrainRange bodies{};  // of a grain
    bool any = false;     // has it contacts?
    bool spins = false;   // has it friction?
    int touched_made = -1;
    GrainRange touched{};  // its bodies with contacts between grains, in touched_
    int turn = 0;          // the last sweep of it
    float moved = 0;       // [m/s]
  };
  /// A body of a grain with contacts between grains, as it was at the end of the sweep that had its grain's
  /// last turn.
  struct Touched {
    int body, list;
    Velocity velocity{};
    Turn spin{};
  };
  struct Bodies;

  void take_bodies(const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
                   double relaxation);
  void take_contacts(const RigidContacts<Dim>& contacts, const ContactBlock& listed,
                     std::span<const double> offset);
  template <class AnyEight>
  void fill(const RigidContacts<Dim>& contacts, const ContactBatch& listed, int begin, int idle,
            Batch<AnyEight>& batch) const;
  template <class AnyEight>
  void load(const RigidContacts<Dim>& contacts, std::span<const double> offset, const ContactBlock& listed,
            Batch<AnyEight>& batch);
  /// n dp_n and what a change of p_t adds to it: an impulse in the frame of the world.
  static Vector impulse_of(const Eight& contact, const Floats& dp_n);
  static Vector impulse_of(const FrictionalEight& contact, const Floats& dp_n, const Tangential& dp_t);
  /// u_t of bodies whose velocities differ by du and whose spins add up to s.
  static Tangential slip_of(const FrictionalEight& contact, const Vector& du, const Turning& s);
  /// ds = -kappa n x P/m on both bodies, whose spins are s_a and s_b.
  void turn(const FrictionalEight& contact, const Turning& s_a, const Turning& s_b, const Tangential& p_t);
  static void load_tangents(FrictionalEight& contact);
  void take_range(const RigidContacts<Dim>& contacts, const ContactBlock& listed, Block& block);
  void take_touched(const RigidContacts<Dim>& contacts, const ContactBlock& between);
  std::span<const int> touched(const Block& block) const {
    const auto [begin, end] = block.touched;
    return std::span<const int>(touched_bodies_).subspan(begin, end - begin);
  }
  void pass_touched(const Block& block, Message& message);
  Violation sweep_block(int block, double ahead, bool measured);
  template <bool Ahead, bool Measured>
  void relax(Eight& contact, float b, LaneViolation<Floats>& violation);
  template <bool Ahead, bool Measured>
  void relax(FrictionalEight& contact, float b, LaneViolation<Floats>& violation);
  template <bool Ahead, bool Measured>
  Violation sweep_contacts(Block& block, float b);

  std::vector<Block> blocks_;       // by ContactBlock::list
  std::vector<int> listed_;         // in the order of the sweep
  std::vector<Velocity> velocity_;  // of the bodies, then of one at rest for each block
  std::vector<Turn> spin_;
  std::vector<Velocity> start_, end_;  // of the bodies of grains in the last turn of their block
  std::vector<Turn> spin_start_, spin_end_;
  std::vector<int> list_of_;  // of bodies; -1: no grain's
  std::vector<Touched> touched_;
  std::vector<int> touched_bodies_;
  Shares shares_;
  int bodies_ = 0, sweeps_ = 0;
  float relaxation_ = 1, inertia_ratio_ = 2;
};
using NarrowSweeps = NarrowSweepsOf<2>;

template <int Dim>
class NarrowSweepsOf<Dim>::System {
 public:
  /// Keeps references.
  System(NarrowSweepsOf& sweeps, const RigidParticles<Dim>& particles, const RigidContacts<Dim>& contacts,
         std::span<const double> offset);

  int size() const { return contacts_.size(); }
  Mat<Dim> delassus_block(int contact) const;
  Vec<Dim> relative_velocity(int contact) const;
  void apply_impulse(int contact, const Vec<Dim>& dp);

 private:
  NarrowSweepsOf& sweeps_;
  const RigidContacts<Dim>& contacts_;
  std::span<const double> offset_;
  double inertia_ratio_;
};

}  // namespace softgrain
