#pragma once
#include <omp.h>

namespace softgrain {

/// How many threads parallel loops use from now on.
inline void set_threads(int count) { omp_set_num_threads(count); }

/// How many threads a parallel loop would use now.
inline int threads() { return omp_get_max_threads(); }

/// work(i) for i = 0 .. count - 1, in any order, on all threads; each must write its own data only, and throw
/// nothing. Results do not depend on the number of threads.
template <class Work>
void parallel_for(int count, const Work& work) {
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < count; ++i) work(i);
}

}  // namespace softgrain
