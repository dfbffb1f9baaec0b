#pragma once
#include <cstdint>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// What a run will take, before it runs; a guide, good to a factor of about two.
struct Estimate {
  double particles = 0;  ///< bpm: primary particles; mpm: material points, 14 cells^2 in a grain
  double contacts =
      0;  ///< bpm: 2.2 per primary, a dense packing has about 2; mpm: half of the outlines' vertices
  double steps = 0;   ///< of the loading path; preparing the sample comes on top
  double memory = 0;  ///< [bytes] 50 MB + 1 kB per particle + 200 B per contact
  double disk = 0;    ///< [bytes] snapshots and ParaView's files
  double hours = 0;   ///< [h] on one thread; bpm: with 17 sweeps a step, as usual
};

/// Estimates a valid case.
Estimate estimate(const Case& the_case);

}  // namespace softgrain
