#pragma once
#include <cstdint>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// What a run will take, before it runs. Steps are exact; the rest is good to a factor of about two.
struct Estimate {
  std::int64_t primaries = 0;
  std::int64_t contacts =
      0;                   ///< 2.2 per primary: a dense packing of disks has about 2, some more come and go
  std::int64_t steps = 0;  ///< of the loading path; the preparation of the grain comes on top
  double memory = 0;       ///< [bytes] 50 MB + 1 kB per primary + 200 B per contact
  double hours = 0;        ///< [h] at most: contacts x max_sweeps x steps, at 15 million contacts per second
};

Estimate estimate(const Case& the_case);

}  // namespace softgrain
