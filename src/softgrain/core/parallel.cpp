#include "softgrain/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "softgrain/core/processor.hpp"

namespace softgrain {
namespace {

/// Looks at a state this often before a thread goes to sleep: some 50 us, about the pause between two loops
/// of a step.
constexpr int looks_before_sleep = 2000;

/// Turns that each thread takes in a loop of many items: few enough that taking one costs nothing beside
/// items of half a microsecond, enough that no thread waits long for the last.
constexpr int turns_per_thread = 16;

/// The items of one loop. Threads take turns of them in the order of their index until none is left.
class Loop {
 public:
  Loop(int count, int threads, detail::LoopBody body, const void* work)
      : count_(count), turn_(std::max(1, count / (turns_per_thread * threads))), body_(body), work_(work) {}

  /// Throws nothing. An item that throws ends its turn, and no turn behind it begins.
  void take_turns() noexcept {
    for (int begin; (begin = next_.fetch_add(turn_, std::memory_order_relaxed)) < count_;) {
      if (begin > failed_.load(std::memory_order_relaxed)) return;
      int i = begin;
      try {
        for (; i < std::min(count_, begin + turn_); ++i) body_(work_, i);
      } catch (...) {
        keep(i, std::current_exception());
      }
    }
  }

  /// After all turns. All items before the first that threw have been worked on, so that it is the same one
  /// on any number of threads.
  void rethrow() {
    if (error_ != nullptr) std::rethrow_exception(std::exchange(error_, nullptr));
  }

 private:
  void keep(int item, std::exception_ptr error) {
    const std::lock_guard lock(keeping_);
    if (item >= failed_) return;
    failed_ = item;
    error_ = std::move(error);
  }

  std::atomic<int> next_{0};
  std::atomic<int> failed_{std::numeric_limits<int>::max()};  // the first item that threw
  int count_, turn_;                                          // items of the loop, and of a turn
  detail::LoopBody body_;
  const void* work_;
  std::mutex keeping_;
  std::exception_ptr error_;
};

/// Threads that wait for loops. One word says all: whether a loop is open, how many helpers are inside it,
/// and the number of the loop, so that a helper never enters one that has ended.
class Team {
 public:
  /// With fewer helpers where the system gives no more threads.
  explicit Team(int helpers) : wanted_(helpers) {
    helpers_.reserve(helpers);
    try {
      for (int k = 0; k < helpers; ++k) helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
    }
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() {
    ending_ = true;
    state_.fetch_add(one_loop);
    state_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  int wanted() const { return wanted_; }

  void run(Loop& loop) {
    loop_ = &loop;
    state_.fetch_add(one_loop + open);
    state_.notify_all();
    loop.take_turns();
    // no helper comes in any more; those that are inside finish the turn that they hold
    for (std::uint32_t state = state_.fetch_sub(open) - open; inside(state) != 0; state = state_.load())
      wait_while(state);
  }

 private:
  static constexpr std::uint32_t one_helper = 1, open = 1u << 12, one_loop = open << 1;
  static std::uint32_t inside(std::uint32_t state) { return state % open; }
  static bool is_open(std::uint32_t state) { return (state & open) != 0; }

  void wait_while(std::uint32_t state) {
    for (int look = 0; look < looks_before_sleep; ++look, spin_pause())
      if (state_.load(std::memory_order_relaxed) != state) return;
    state_.wait(state);
  }

  void help() {
    std::uint32_t done = 0;  // the loop that this helper has left
    for (;;) {
      std::uint32_t state = state_.load();
      if (ending_) return;
      if (!is_open(state) || state / one_loop == done) {
        wait_while(state);
        continue;
      }
      if (!state_.compare_exchange_strong(state, state + one_helper)) continue;
      loop_->take_turns();
      done = state / one_loop;
      state_.fetch_sub(one_helper);
      state_.notify_all();
    }
  }

  std::atomic<std::uint32_t> state_{0};
  std::atomic<bool> ending_{false};
  Loop* loop_ = nullptr;
  int wanted_;
  std::vector<std::thread> helpers_;
};

int& wanted_threads() {
  static int count = [] {
    const char* wish = std::getenv("OMP_NUM_THREADS");
    const int number = wish != nullptr ? std::atoi(wish) : 0;
    return number > 0 ? number : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }();
  return count;
}

RunTasks& host() {
  static RunTasks run;
  return run;
}

/// The threads of this file.
Team& own_team() {
  static std::unique_ptr<Team> team;
  if (team == nullptr || team->wanted() != threads() - 1) {
    team.reset();
    team = std::make_unique<Team>(threads() - 1);
  }
  return *team;
}

}  // namespace

void set_threads(int count) { wanted_threads() = std::clamp(count, 1, 1024); }

int threads() { return wanted_threads(); }

void set_host_threads(int count, RunTasks run) {
  set_threads(count);
  host() = std::move(run);
}

void detail::run_loop(int count, LoopBody body, const void* work) {
  static std::atomic_flag busy;  // by another simulation of this process, or a loop around this one
  if (threads() == 1 || count < 2 || busy.test_and_set()) {
    for (int i = 0; i < count; ++i) body(work, i);
    return;
  }
  struct Release {
    ~Release() { busy.clear(); }
  } const release;
  Loop loop(count, threads(), body, work);
  if (host())
    host()(threads(), [&loop](int) { loop.take_turns(); });
  else
    own_team().run(loop);
  loop.rethrow();
}

}  // namespace softgrain
