#include "softgrain/core/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>
#include <vector>

using namespace softgrain;

namespace {

/// Sets the number of threads for the length of a test.
struct Threads {
  explicit Threads(int count) : before(threads()) { set_threads(count); }
  ~Threads() { set_threads(before); }
  int before;
};

}  // namespace

TEST_CASE("every item of a parallel loop is worked on once, on any number of threads") {
  for (const int count : {1, 2, 3, 7}) {
    const Threads use(count);
    CHECK(threads() == count);
    for (const int items : {0, 1, 2, 5, 1000})
      for (int again = 0; again < 200; ++again) {
        std::vector<int> visits(items);
        parallel_for(items, [&](int i) { ++visits[i]; });
        CHECK(visits == std::vector<int>(items, 1));
      }
  }
}

TEST_CASE("a parallel loop is over when it returns, however late its threads are") {
  const Threads use(4);
  for (int again = 0; again < 50; ++again) {
    std::atomic<int> running = 0;
    parallel_for(8, [&](int i) {
      ++running;
      if (i % 3 == 1) std::this_thread::sleep_for(std::chrono::microseconds(200));
      --running;
    });
    CHECK(running == 0);
    if (again % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the others go to sleep
  }
}

TEST_CASE("items are shared among the threads") {
  const Threads use(2);
  std::atomic<int> waiting = 0;
  parallel_for(2, [&](int) {
    ++waiting;  // either item waits for the other: one thread alone would never come back
    while (waiting < 2) std::this_thread::yield();
  });
  CHECK(waiting == 2);
}

TEST_CASE("loops inside loops and beside each other do all of their items") {
  const Threads use(3);
  std::vector<int> inner(20);
  parallel_for(4, [&](int i) { parallel_for(5, [&](int k) { ++inner[5 * i + k]; }); });
  CHECK(inner == std::vector<int>(20, 1));
  std::vector<std::vector<int>> visits(3, std::vector<int>(500));
  std::vector<std::thread> callers;
  for (std::vector<int>& mine : visits)
    callers.emplace_back([&mine] {
      for (int again = 0; again < 100; ++again) parallel_for(500, [&](int i) { ++mine[i]; });
    });
  for (std::thread& caller : callers) caller.join();
  for (const std::vector<int>& mine : visits) CHECK(mine == std::vector<int>(500, 100));
}
