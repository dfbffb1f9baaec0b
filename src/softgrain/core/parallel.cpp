#include "softgrain/core/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

namespace softgrain {
namespace {

/// Looks at a state this often before a thread goes to sleep: some 50 us, about the pause between two loops
/// of a step.
constexpr int looks_before_sleep = 2000;

/// Turns that each thread takes in a loop of many items: few enough that taking one costs nothing beside
/// items of half a microsecond, enough that no thread waits long for the last.
constexpr int turns_per_thread = 16;

inline void pause() { __builtin_ia32_pause(); }

/// Threads that wait for loops. One word says all: whether a loop is open, how many helpers are inside it,
/// and the number of the loop, so that a helper never enters one that has ended.
class Team {
 public:
  explicit Team(int helpers) {
    for (int k = 0; k < helpers; ++k) helpers_.emplace_back([this] { help(); });
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() {
    ending_ = true;
    state_.fetch_add(one_loop);
    state_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  int size() const { return 1 + static_cast<int>(helpers_.size()); }

  void run(int count, detail::LoopBody body, const void* work) {
    count_ = count, body_ = body, work_ = work;
    turn_ = std::max(1, count / (turns_per_thread * size()));
    next_.store(0, std::memory_order_relaxed);
    state_.fetch_add(one_loop + open);
    state_.notify_all();
    take_turns();
    // no helper comes in any more; those that are inside finish the turn that they hold
    for (std::uint32_t state = state_.fetch_sub(open) - open; inside(state) != 0; state = state_.load())
      wait_while(state);
  }

 private:
  static constexpr std::uint32_t one_helper = 1, open = 1u << 12, one_loop = open << 1;
  static std::uint32_t inside(std::uint32_t state) { return state % open; }
  static bool is_open(std::uint32_t state) { return (state & open) != 0; }

  void wait_while(std::uint32_t state) {
    for (int look = 0; look < looks_before_sleep; ++look, pause())
      if (state_.load(std::memory_order_relaxed) != state) return;
    state_.wait(state);
  }

  void take_turns() {
    for (int begin; (begin = next_.fetch_add(turn_, std::memory_order_relaxed)) < count_;)
      for (int i = begin; i < std::min(count_, begin + turn_); ++i) body_(work_, i);
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
      take_turns();
      done = state / one_loop;
      state_.fetch_sub(one_helper);
      state_.notify_all();
    }
  }

  std::atomic<std::uint32_t> state_{0};
  std::atomic<int> next_{0};
  std::atomic<bool> ending_{false};
  int count_ = 0, turn_ = 1;  // items of a loop, and of a turn
  detail::LoopBody body_ = nullptr;
  const void* work_ = nullptr;
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

}  // namespace

void set_threads(int count) { wanted_threads() = std::clamp(count, 1, 1024); }

int threads() { return wanted_threads(); }

void detail::run_loop(int count, LoopBody body, const void* work) {
  static std::atomic_flag busy;  // by another simulation of this process, or a loop around this one
  if (threads() == 1 || count < 2 || busy.test_and_set()) {
    for (int i = 0; i < count; ++i) body(work, i);
    return;
  }
  static std::unique_ptr<Team> team;
  if (team == nullptr || team->size() != threads()) {
    team.reset();
    team = std::make_unique<Team>(threads() - 1);
  }
  team->run(count, body, work);
  busy.clear();
}

}  // namespace softgrain
