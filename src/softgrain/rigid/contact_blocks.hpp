#pragma once
#include "softgrain/core/parallel.hpp"

namespace softgrain {

/// work(block) for each of RigidContacts::blocks: those inside grains on all threads, then the one between.
template <class Work>
void for_each_block(int blocks, const Work& work) {
  parallel_for(blocks - 1, work);
  if (blocks > 0) work(blocks - 1);
}

}  // namespace softgrain
