#pragma once
#include <omp.h>

namespace softgrain {

/// How many threads parallel loops use from now on.
inline void set_threads(int count) { omp_set_num_threads(count); }

/// How many threads a parallel loop would use now.
inline int threads() { return omp_get_max_threads(); }

}  // namespace softgrain
