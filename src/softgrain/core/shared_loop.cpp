#include "softgrain/core/shared_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// An exception as ranks tell of it.
enum class Kind : char { usage = 'u', numerical = 'n', io = 'i', memory = 'm', other = 'o' };

std::string text_of(const std::exception_ptr& error) {
  const auto of = [](Kind kind, const std::exception& e) {
    return static_cast<char>(kind) + std::string(e.what());
  };
  try {
    std::rethrow_exception(error);
  } catch (const UsageError& e) {
    return of(Kind::usage, e);
  } catch (const NumericalError& e) {
    return of(Kind::numerical, e);
  } catch (const IoError& e) {
    return of(Kind::io, e);
  } catch (const std::system_error& e) {  // of the file system
    return of(Kind::io, e);
  } catch (const std::bad_alloc& e) {
    return of(Kind::memory, e);
  } catch (const std::exception& e) {
    return of(Kind::other, e);
  }
}

/// The weights, or with SOFTGRAIN_PARTITION others that differ by up to a thousand times.
std::vector<double> weights_for_tests(std::span<const double> given) {
  std::vector<double> weight(given.begin(), given.end());
  const char* wish = std::getenv("SOFTGRAIN_PARTITION");
  const auto seed = static_cast<std::uint64_t>(wish != nullptr ? std::atoi(wish) : 0);
  if (seed == 0) return weight;
  constexpr int bits = 64, decades = 3;
  std::uint64_t unit = 0;
  for (double& w : weight) {
    std::uint64_t mixed = (seed << 32U) + ++unit;  // splitmix64
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    w *= std::pow(10, decades * std::ldexp(static_cast<double>(mixed ^ (mixed >> 31U)), -bits));
  }
  return weight;
}

[[noreturn]] void raise_text(const std::string& text) {
  const std::string words = text.substr(1);
  switch (static_cast<Kind>(text.front())) {
    case Kind::usage:
      throw UsageError(words);
    case Kind::numerical:
      throw NumericalError(words);
    case Kind::io:
      throw IoError(words);
    case Kind::memory:
      throw std::bad_alloc();
    default:
      throw std::runtime_error(words);
  }
}

}  // namespace

/// Ends at the middles of equal parts of the whole weight.
Shares::Shares(std::span<const double> given) {
  const int ranks = communicator().ranks(), units = static_cast<int>(given.size());
  if (ranks == 1) return;
  const std::vector<double> weight = weights_for_tests(given);
  const double whole = std::accumulate(weight.begin(), weight.end(), 0.0);
  begin_.push_back(0);
  double before = 0;
  for (int unit = 0; unit < units; ++unit) {
    while (static_cast<int>(begin_.size()) < ranks &&
           before + weight[unit] / 2 >= whole * static_cast<double>(begin_.size()) / ranks)
      begin_.push_back(unit);
    before += weight[unit];
  }
  begin_.resize(ranks + 1, units);
}

void RankError::raise(int rank) const {
  raise_text(told(error_ != nullptr && communicator().rank() == rank ? text_of(error_) : "", rank));
}

void RankError::raise_first() const {
  Communicator& all = communicator();
  if (all.ranks() == 1) {
    if (error_ != nullptr) std::rethrow_exception(error_);
    return;
  }
  const std::int64_t behind = error_ != nullptr ? all.ranks() - all.rank() : 0;
  if (const std::int64_t first = all.largest(behind); first > 0) raise(all.ranks() - static_cast<int>(first));
}

namespace detail {

/// Its memory is kept from loop to loop.
std::byte* SharedResults::room(std::size_t bytes) {
  static std::vector<std::byte> memory;
  if (memory.size() < bytes) memory.resize(bytes);
  return memory.data();
}

void SharedResults::prepare(std::span<const std::size_t> bytes) {
  begin_.assign(1, 0);
  for (const std::size_t of_rank : bytes) begin_.push_back(begin_.back() + 1 + of_rank);
  room(begin_.back());
}

void SharedResults::prepare(std::size_t own_bytes) {
  Communicator& all = communicator();
  std::vector<std::size_t> bytes(all.ranks()), begin(all.ranks() + 1);
  bytes[all.rank()] = own_bytes;
  for (int r = 0; r <= all.ranks(); ++r) begin[r] = r * sizeof own_bytes;
  all.gather(std::as_writable_bytes(std::span(bytes)), begin);
  prepare(bytes);
}

void SharedResults::exchange(const RankError& error) {
  Communicator& all = communicator();
  const auto failed = [&](int rank) -> std::byte& { return room()[begin_[rank]]; };
  failed(all.rank()) = std::byte(error ? 1 : 0);
  all.gather({room(), begin_.back()}, begin_);
  for (int r = 0; r < all.ranks(); ++r)
    if (failed(r) != std::byte(0)) error.raise(r);
}

namespace {

constexpr std::size_t largest_parcel = 1U << 29U;

/// swap(begin, end) for the parts of so many bytes that are sent at once.
template <class Swap>
void in_parcels(std::size_t bytes, const Swap& swap) {
  for (std::size_t begin = 0; begin < bytes; begin += largest_parcel)
    swap(begin, std::min(bytes, begin + largest_parcel) - begin);
}

}  // namespace

void send_to_first(std::span<const std::byte> bytes) {
  const auto send = [](std::span<const std::byte> part) {
    const Parcel parcel{.out = part};
    communicator().swap({&parcel, 1});
  };
  const std::size_t size = bytes.size();
  send(std::as_bytes(std::span(&size, 1)));
  in_parcels(size, [&](std::size_t begin, std::size_t count) { send(bytes.subspan(begin, count)); });
}

std::vector<std::byte> receive_from(int rank) {
  const auto receive = [rank](std::span<std::byte> part) {
    const Parcel parcel{.rank = rank, .in = part};
    communicator().swap({&parcel, 1});
  };
  std::size_t size = 0;
  receive(std::as_writable_bytes(std::span(&size, 1)));
  std::vector<std::byte> bytes(size);
  in_parcels(size,
             [&](std::size_t begin, std::size_t count) { receive(std::span(bytes).subspan(begin, count)); });
  return bytes;
}

}  // namespace detail
}  // namespace softgrain
