#pragma once
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <exception>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "softgrain/core/communicator.hpp"
#include "softgrain/core/parallel.hpp"

namespace softgrain {

/// Which rank works on which of a run's units (grains, or batches of them): each on units that lie one after
/// the other, of about the same weight in all. Without ranks, all on all. For tests the environment variable
/// SOFTGRAIN_PARTITION, a number from 1 on, gives them parts of random sizes instead.
class Shares {
 public:
  Shares() = default;
  /// weight: of each unit, >= 0.
  explicit Shares(std::span<const double> weight);

  bool alone() const { return begin_.empty(); }
  bool mine(int unit) const {
    const auto r = static_cast<std::size_t>(communicator().rank());
    return alone() || (begin_[r] <= unit && unit < begin_[r + 1]);
  }
  /// This rank's units begin .. end - 1.
  struct Range {
    int begin = 0, end = std::numeric_limits<int>::max();
  };
  Range own() const {
    const auto r = static_cast<std::size_t>(communicator().rank());
    return alone() ? Range{} : Range{begin_[r], begin_[r + 1]};
  }
  /// That has the unit.
  int rank_of(int unit) const {
    return alone()
               ? 0
               : static_cast<int>(std::upper_bound(begin_.begin(), begin_.end(), unit) - begin_.begin()) - 1;
  }
  /// (ranks + 1) the first of the items 0 .. count - 1 of each rank, where unit_of(item) does not decrease.
  template <class UnitOf>
  std::vector<int> first_items(int count, const UnitOf& unit_of) const {
    std::vector<int> first;
    for (int item = 0; const int begin : begin_) {
      while (item < count && unit_of(item) < begin) ++item;
      first.push_back(item);
    }
    first.back() = count;
    return first;
  }

 private:
  std::vector<int> begin_;  // (ranks + 1) units, or empty
};

/// Numbers that are sent as they lie in memory: those of lanes too, which copy themselves.
template <class T>
inline constexpr bool is_plain = std::is_trivially_copyable_v<T> ||
                                 (std::is_trivially_destructible_v<T> && std::is_standard_layout_v<T>);

/// What ranks send each other of the results of an item. They are named once, for whoever measures, sends or
/// receives them.
class Message {
 public:
  /// That only counts bytes; or that moves them between memory and `place`.
  Message() = default;
  Message(std::byte* place, bool sends) : place_(place), sends_(sends) {}

  template <class T>
  void operator()(std::span<T> values) {
    static_assert(is_plain<T>);
    move(values.data(), values.size_bytes());
  }
  template <class T>
  void operator()(std::vector<T>& values) {  // as many as all ranks know of
    (*this)(std::span<T>(values));
  }
  template <class T>
  requires is_plain<T>
  void operator()(T& value) { move(&value, sizeof value); }
  /// values[i] for each of these indices.
  template <class T>
  void at(std::span<const int> indices, std::span<T> values) {
    static_assert(is_plain<T>);
    if (place_ == nullptr) {
      bytes_ += indices.size() * sizeof(T);
      return;
    }
    std::byte* place = place_ + bytes_;
    bytes_ += indices.size() * sizeof(T);
    if (sends_)
      for (const int i : indices) std::memcpy(place, &values[i], sizeof(T)), place += sizeof(T);
    else
      for (const int i : indices) std::memcpy(&values[i], place, sizeof(T)), place += sizeof(T);
  }
  /// A list whose length only its own rank knows: only in loops with Lengths::told.
  template <class T>
  void list(std::vector<T>& values) {
    std::size_t size = values.size();
    (*this)(size);
    if (place_ != nullptr && !sends_) values.resize(size);
    (*this)(values);
  }

  std::size_t bytes() const { return bytes_; }

 private:
  void move(void* memory, std::size_t size) {
    if (place_ != nullptr && size > 0)
      sends_ ? std::memcpy(place_ + bytes_, memory, size) : std::memcpy(memory, place_ + bytes_, size);
    bytes_ += size;
  }
  std::byte* place_ = nullptr;
  bool sends_ = false;
  std::size_t bytes_ = 0;
};

/// value of the first rank, on all of them.
template <class T>
void tell_all(T& value) {
  static_assert(is_plain<T>);
  std::vector<std::size_t> begin(communicator().ranks() + 1, sizeof value);
  begin.front() = 0;
  communicator().gather(std::as_writable_bytes(std::span(&value, 1)), begin);
}

/// Do all ranks know how long the results of all items are, or must they be told?
enum class Lengths { known, told };

/// An error on its way from one rank to all.
class RankError {
 public:
  template <class Work>
  void catch_from(const Work& work) {
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
    }
  }
  explicit operator bool() const { return error_ != nullptr; }
  /// On this rank alone, if it has one.
  void raise_here() const {
    if (error_ != nullptr) std::rethrow_exception(error_);
  }
  /// On all ranks at once: the error of the first rank that has one, if any has.
  void raise_first() const;
  /// On all ranks: that of `rank`, which has one.
  [[noreturn]] void raise(int rank) const;

 private:
  std::exception_ptr error_;
};

namespace detail {

/// Each rank's part of a gathered message: a byte that tells of an error, and the results.
class SharedResults {
 public:
  /// bytes: of the results of each rank; or own_bytes, if the others' are not known here.
  void prepare(std::span<const std::size_t> bytes);
  void prepare(std::size_t own_bytes);
  /// Where the results of a rank are.
  std::byte* results(int rank) { return room() + begin_[rank] + 1; }
  /// On all ranks; raises the error of the first that has one.
  void exchange(const RankError& error);

 private:
  static std::byte* room(std::size_t bytes = 0);
  std::vector<std::size_t> begin_;
};

void send_to_first(std::span<const std::byte> bytes);
std::vector<std::byte> receive_from(int rank);

}  // namespace detail

/// parallel_for over items 0 .. count - 1, each on the rank that has its unit; then all ranks have the
/// results of all items. result(i, message) names the memory that work(i) has written and that others read.
/// What it does not name stays as it was on the other ranks. An error reaches all ranks as parallel_for would
/// raise it.
template <class UnitOf, class Work, class Result>
void shared_for(const Shares& shares, int count, const UnitOf& unit_of, const Work& work,
                const Result& result, Lengths lengths = Lengths::known) {
  if (shares.alone()) return parallel_for(count, work);
  const std::vector<int> first = shares.first_items(count, unit_of);
  const int me = communicator().rank(), ranks = communicator().ranks();
  RankError error;
  const double begin = process_seconds();
  error.catch_from([&] { parallel_for(first[me + 1] - first[me], [&](int k) { work(first[me] + k); }); });
  communicator().account.cpu_shared += process_seconds() - begin;
  const auto pass = [&](int rank, Message message) {
    for (int i = first[rank]; i < first[rank + 1]; ++i) result(i, message);
    return message.bytes();
  };
  detail::SharedResults shared;
  if (lengths == Lengths::known) {
    std::vector<std::size_t> bytes;
    for (int r = 0; r < ranks; ++r) bytes.push_back(pass(r, {}));
    shared.prepare(bytes);
  } else {
    shared.prepare(pass(me, {}));
  }
  pass(me, {shared.results(me), true});
  shared.exchange(error);
  for (int r = 0; r < ranks; ++r)
    if (r != me) pass(r, {shared.results(r), false});
}

/// The same where item i is of unit i.
template <class Work, class Result>
void shared_for(const Shares& shares, int count, const Work& work, const Result& result,
                Lengths lengths = Lengths::known) {
  shared_for(
      shares, count, [](int i) { return i; }, work, result, lengths);
}

/// The first rank gets what result(i, message) names of the items 0 .. count - 1 of the others, which get
/// nothing: for what it writes. It holds the messages of one rank at a time.
template <class UnitOf, class Result>
void collect(const Shares& shares, int count, const UnitOf& unit_of, const Result& result) {
  if (shares.alone()) return;
  const std::vector<int> first = shares.first_items(count, unit_of);
  const auto pass = [&](int rank, Message message) {
    for (int i = first[rank]; i < first[rank + 1]; ++i) result(i, message);
    return message.bytes();
  };
  const int me = communicator().rank();
  if (me > 0) {
    std::vector<std::byte> bytes(pass(me, {}));
    pass(me, {bytes.data(), true});
    return detail::send_to_first(bytes);
  }
  for (int r = 1; r < communicator().ranks(); ++r) {
    std::vector<std::byte> bytes = detail::receive_from(r);
    pass(r, {bytes.data(), false});
  }
}

/// work() on one rank; the first rank gets what result(message) names of it, all lengths told. An error of
/// work() stays on its rank, where it is raised; the first one gets nothing then.
template <class Work, class Result>
void tell_first(int rank, const Work& work, const Result& result) {
  const int me = communicator().rank();
  if (me == rank) {
    RankError error;
    error.catch_from(work);
    if (me == 0) return error.raise_here();
    Message count;
    if (!error) result(count);
    std::vector<std::byte> bytes(count.bytes());
    Message message(bytes.data(), true);
    if (!error) result(message);
    detail::send_to_first(bytes);
    error.raise_here();
  } else if (me == 0) {
    std::vector<std::byte> bytes = detail::receive_from(rank);
    Message message(bytes.data(), false);
    if (!bytes.empty()) result(message);
  }
}

/// work(i) for those of the units 0 .. count - 1 that are this rank's; the others know nothing of it.
template <class Work>
void own_for(const Shares& shares, int count, const Work& work) {
  if (shares.alone()) return parallel_for(count, work);
  const double begin = process_seconds();
  const auto [first, end] = shares.own();
  parallel_for(std::min(end, count) - first, [&, first = first](int k) { work(first + k); });
  communicator().account.cpu_shared += process_seconds() - begin;
}

}  // namespace softgrain
