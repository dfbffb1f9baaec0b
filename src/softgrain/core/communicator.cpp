#include "softgrain/core/communicator.hpp"

#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "softgrain/core/shared_loop.hpp"

namespace softgrain {
namespace {

std::unique_ptr<Communicator>& own() {
  static auto communicator = std::make_unique<Communicator>();
  return communicator;
}

}  // namespace

Communicator& communicator() { return *own(); }

void use_communicator(std::unique_ptr<Communicator> communicator) { own() = std::move(communicator); }

double process_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

OverRanks over_ranks(double number) {
  constexpr double millionths = 1e6;
  Communicator& all = communicator();
  return {.mean = all.sum(number) / all.ranks(),
          .largest = static_cast<double>(all.largest(std::llround(millionths * number))) / millionths};
}

std::string told(const std::string& text, int from) {
  Communicator& all = communicator();
  if (all.ranks() == 1) return text;
  const bool mine = all.rank() == from;
  const auto size = static_cast<std::size_t>(all.largest(mine ? static_cast<std::int64_t>(text.size()) : 0));
  std::string heard = mine ? text : std::string(size, '\0');
  std::vector<std::size_t> begin(all.ranks() + 1, 0);
  for (int r = from + 1; r <= all.ranks(); ++r) begin[r] = size;
  all.gather(std::as_writable_bytes(std::span(heard)), begin);
  return heard;
}

void together(bool here, const std::function<void()>& work) {
  RankError error;
  if (here) error.catch_from(work);
  error.raise_first();
}

}  // namespace softgrain
