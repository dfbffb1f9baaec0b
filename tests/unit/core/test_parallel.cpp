#include "softgrain/core/parallel.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <functional>
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

/// Items that wait for each other: one thread alone would never come back.
void check_two_threads_share() {
  std::atomic<int> waiting = 0;
  parallel_for(2, [&](int) {
    ++waiting;
    while (waiting < 2) std::this_thread::yield();
  });
  CHECK(waiting == 2);
}

/// The number that a loop throws as an exception, -1 if none.
template <class Work>
int thrown_by(int items, const Work& work) {
  try {
    parallel_for(items, work);
  } catch (const int& number) {
    return number;
  }
  return -1;
}

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
  check_two_threads_share();
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

TEST_CASE("the first item by index that throws reaches the caller, on any number of threads") {
  for (const int count : {1, 2, 3, 7}) {
    const Threads use(count);
    for (int again = 0; again < 100; ++again) {
      std::vector<int> visits(1000);
      const int thrown = thrown_by(1000, [&](int i) {
        ++visits[i];
        if (i % 100 == 42 || i > 500) throw i;
      });
      CHECK(thrown == 42);
      for (int i = 0; i < 43; ++i) CHECK(visits[i] == 1);
    }
  }
}

TEST_CASE("an exception of the caller or of a helper leaves the threads at work") {
  const Threads use(2);
  const std::thread::id caller = std::this_thread::get_id();
  for (const bool by_caller : {true, false})
    for (int again = 0; again < 50; ++again) {
      std::atomic<int> waiting = 0;
      const int thrown = thrown_by(2, [&](int i) {
        ++waiting;
        while (waiting < 2) std::this_thread::yield();  // so that each thread has one of the two
        if ((std::this_thread::get_id() == caller) == by_caller) throw i;
      });
      CHECK(thrown >= 0);
      check_two_threads_share();
    }
}

TEST_CASE("an exception passes through loops inside loops, ranges, sums and alternate loops") {
  const Threads use(3);
  CHECK(thrown_by(4, [](int i) { parallel_for(5, [i](int k) { i == 2 && k == 3 ? throw 23 : 0; }); }) == 23);
  const auto fail = [](int begin, int) -> int { return begin > 0 ? throw 5 : 1; };
  CHECK_THROWS_AS(parallel_ranges(10000, fail), int);
  CHECK_THROWS_AS(parallel_sum<int>(10000, fail), int);
  CHECK_THROWS_AS(parallel_alternate(9, [](int i) { i == 7 ? throw 7 : 0; }), int);
}

TEST_CASE("a host program may bring its own threads") {
  const Threads use(4);
  int loops = 0, tasks_of_loop = 0;
  const RunTasks host = [&](int count, const std::function<void(int)>& task) {
    ++loops;
    tasks_of_loop = count;
    std::vector<std::thread> threads;
    for (int k = 0; k < count; ++k) threads.emplace_back([&task, k] { task(k); });
    for (std::thread& thread : threads) thread.join();
  };
  set_host_threads(2, host);
  CHECK(threads() == 2);
  check_two_threads_share();
  CHECK(loops == 1);
  CHECK(tasks_of_loop == 2);
  std::vector<int> visits(1000);
  parallel_for(1000, [&](int i) { ++visits[i]; });
  CHECK(visits == std::vector<int>(1000, 1));
  CHECK(thrown_by(1000, [](int i) { i % 10 == 3 ? throw i : 0; }) == 3);
  set_host_threads(3, [](int count, const std::function<void(int)>& task) {
    for (int k = count; k-- > 0;) task(k);  // one after the other is allowed too
  });
  parallel_for(1000, [&](int i) { ++visits[i]; });
  CHECK(visits == std::vector<int>(1000, 2));
  set_host_threads(2, {});
  check_two_threads_share();
  CHECK(loops == 3);
}
