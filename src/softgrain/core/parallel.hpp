#pragma once
#include <algorithm>
#include <functional>
#include <vector>

namespace softgrain {

/// How many threads parallel loops use from now on, at least 1. Not during a loop.
void set_threads(int count);

/// How many threads a parallel loop uses: as set, else OMP_NUM_THREADS, else one for each core that the
/// process may use.
int threads();

/// Runs task(k) for k = 0 .. count - 1, each once and at the same time as far as it can, and returns when all
/// are done. The tasks throw nothing; this must throw nothing once it has begun one.
using RunTasks = std::function<void(int count, const std::function<void(int k)>& task)>;

/// Parallel loops use the threads of a host program from now on: each loop hands `count` tasks to `run`, and
/// whichever tasks run share its items, so that none waits for another to begin. Results have the same bits
/// as with threads of our own, to which an empty `run` goes back. Not during a loop.
void set_host_threads(int count, RunTasks run);

namespace detail {

using LoopBody = void (*)(const void* work, int i);

/// body(work, i) for i = 0 .. count - 1 on all threads.
void run_loop(int count, LoopBody body, const void* work);

}  // namespace detail

/// work(i) for i = 0 .. count - 1, in any order, on all threads; each must write its own data only. Results
/// do not depend on the number of threads. A loop inside a loop, or beside one of another thread, runs on its
/// own thread alone.
///
/// If items throw, the caller gets the exception of the first of them by index, the one that a plain loop
/// would meet, when all threads have left the loop. All items before it are done, some behind it may be.
///
/// A thread that is late is not waited for: the others take its share (docs/decisions/0016).
template <class Work>
void parallel_for(int count, const Work& work) {
  detail::run_loop(
      count, [](const void* w, int i) { (*static_cast<const Work*>(w))(i); }, &work);
}

/// work(i) for i = 0, 2, 4, ... on all threads, then for i = 1, 3, 5, ...: where only neighbours share data.
template <class Work>
void parallel_alternate(int count, const Work& work) {
  for (const int first : {0, 1}) parallel_for((count + 1 - first) / 2, [&](int k) { work(first + 2 * k); });
}

namespace detail {
/// Items of a loop over many small things that one thread takes at once. Fixed, so that sums over chunks have
/// the same bits on any number of threads.
inline constexpr int chunk = 2048;
inline int chunks(int count) { return (count + chunk - 1) / chunk; }
}  // namespace detail

/// work(begin, end) for consecutive ranges that make up 0 .. count - 1, as parallel_for.
template <class Work>
void parallel_ranges(int count, const Work& work) {
  parallel_for(detail::chunks(count),
               [&](int k) { work(k * detail::chunk, std::min(count, (k + 1) * detail::chunk)); });
}

/// The sum of what work(begin, end) returns for consecutive ranges that make up 0 .. count - 1; T{} is zero.
template <class T, class Work>
T parallel_sum(int count, const Work& work) {
  std::vector<T> part(detail::chunks(count));
  parallel_for(detail::chunks(count),
               [&](int k) { part[k] = work(k * detail::chunk, std::min(count, (k + 1) * detail::chunk)); });
  T sum{};
  for (const T& p : part) sum += p;
  return sum;
}

}  // namespace softgrain
