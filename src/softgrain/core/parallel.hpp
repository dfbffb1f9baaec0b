#pragma once

namespace softgrain {

/// How many threads parallel loops use from now on, at least 1. Not during a loop.
void set_threads(int count);

/// How many threads a parallel loop uses: as set, else OMP_NUM_THREADS, else one for each core that the
/// process may use.
int threads();

namespace detail {

using LoopBody = void (*)(const void* work, int i);

/// body(work, i) for i = 0 .. count - 1 on all threads.
void run_loop(int count, LoopBody body, const void* work);

}  // namespace detail

/// work(i) for i = 0 .. count - 1, in any order, on all threads; each must write its own data only and
/// throw nothing. Results do not depend on the number of threads. A loop inside a loop, or beside one of
/// another thread, runs on its own thread alone.
///
/// A thread that is late is not waited for: the others take its share (docs/decisions/0016).
template <class Work>
void parallel_for(int count, const Work& work) {
  detail::run_loop(
      count, [](const void* w, int i) { (*static_cast<const Work*>(w))(i); }, &work);
}

}  // namespace softgrain
