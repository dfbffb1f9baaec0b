#pragma once
#include "softgrain/core/shared_loop.hpp"
#include "softgrain/rigid/contacts.hpp"

namespace softgrain {

/// work(block) for each of RigidContacts::blocks: those inside grains on all threads, then the one between.
template <class Work>
void for_each_block(int blocks, const Work& work) {
  parallel_for(blocks - 1, work);
  if (blocks > 0) work(blocks - 1);
}

/// The same, each block inside a grain on the rank that has the grain; others have its result (shared_for)
/// before the block between grains has its turn, on all ranks.
template <int Dim, class Work, class Result>
void for_each_block(const RigidContacts<Dim>& contacts, const Shares& shares, const Work& work,
                    const Result& result) {
  const int blocks = static_cast<int>(contacts.blocks.size());
  shared_for(
      shares, blocks - 1, [&](int k) { return contacts.blocks[k].list; }, work, result);
  if (blocks > 0) work(blocks - 1);
}

}  // namespace softgrain
