#include <algorithm>

#include "softgrain/core/parallel.hpp"
#include "softgrain/rigid/narrow_sweeps.hpp"

namespace softgrain {

template <int Dim>
void NarrowSweepsOf<Dim>::take_bodies(const RigidParticles<Dim>& particles,
                                      const RigidContacts<Dim>& contacts, double relaxation) {
  bodies_ = static_cast<int>(particles.velocity.size());
  if (relaxation_ != static_cast<float>(relaxation)) blocks_.clear();
  relaxation_ = static_cast<float>(relaxation);
  inertia_ratio_ = static_cast<float>(particles.inertia_ratio);
  blocks_.resize(contacts.blocks.empty() ? 0 : contacts.blocks.back().list + 1);
  listed_.clear();
  for (const ContactBlock& block : contacts.blocks) {
    listed_.push_back(block.list);
    blocks_[block.list].spins = block.rough;
    blocks_[block.list].any = block.any;
  }
  velocity_.resize(bodies_ + blocks_.size());
  spin_.resize(bodies_ + blocks_.size());
  start_.resize(bodies_), end_.resize(bodies_);
  spin_start_.resize(bodies_), spin_end_.resize(bodies_);
  sweeps_ = 0;
  if (static_cast<int>(list_of_.size()) != bodies_) {
    list_of_.assign(bodies_, -1);
    for (int i = 0, list = -1; i < particles.size(); ++i) {
      if (i == 0 || particles.grain[i] != particles.grain[i - 1]) ++list;
      list_of_[i] = list;
    }
  }
  if (!listed_.empty())
    if (Block& between = blocks_[listed_.back()]; between.touched_made != contacts.blocks.back().made) {
      take_touched(contacts, contacts.blocks.back());
      between.touched_made = contacts.blocks.back().made;
    }
  const auto take = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      for (int k = 0; k < Dim; ++k) velocity_[i].c[k] = static_cast<float>(particles.velocity[i][k]);
      for (int k = 0; k < spin_size<Dim>; ++k) spin_[i].c[k] = static_cast<float>(particles.spin[i][k]);
    }
  };
  particles.followed.for_each_range(particles.size(), take);
  take(particles.size(), bodies_);
}

/// The bodies of a grain that have contacts inside it.
template <int Dim>
void NarrowSweepsOf<Dim>::take_range(const RigidContacts<Dim>& contacts, const ContactBlock& listed,
                                     Block& block) {
  block.bodies = {listed.end() > listed.begin() ? bodies_ : 0, 0};
  for (int c = listed.begin(); c < listed.end(); ++c) {
    block.bodies.begin = std::min(block.bodies.begin, contacts.body_a[c]);
    block.bodies.end = std::max(block.bodies.end, contacts.body_b[c] + 1);
  }
}

/// Bodies of grains that have contacts between grains.
template <int Dim>
void NarrowSweepsOf<Dim>::take_touched(const RigidContacts<Dim>& contacts, const ContactBlock& between) {
  std::vector<int> bodies;
  for (int c = between.begin(); c < between.end(); ++c)
    bodies.push_back(contacts.body_a[c]), bodies.push_back(contacts.body_b[c]);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  touched_.clear();
  touched_bodies_.clear();
  for (Block& block : blocks_) block.touched = {};
  for (const int body : bodies) {
    if (list_of_[body] < 0) continue;
    const int at = static_cast<int>(touched_.size());
    GrainRange& of_grain = blocks_[list_of_[body]].touched;
    if (of_grain.end == 0) of_grain.begin = at;
    of_grain.end = at + 1;
    touched_.push_back({.body = body, .list = list_of_[body]});
    touched_bodies_.push_back(body);
  }
}

template void NarrowSweepsOf<2>::take_bodies(const RigidParticles<2>&, const RigidContacts<2>&, double);
template void NarrowSweepsOf<3>::take_bodies(const RigidParticles<3>&, const RigidContacts<3>&, double);
template void NarrowSweepsOf<2>::take_range(const RigidContacts<2>&, const ContactBlock&, Block&);
template void NarrowSweepsOf<3>::take_range(const RigidContacts<3>&, const ContactBlock&, Block&);

}  // namespace softgrain
