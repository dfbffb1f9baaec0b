#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "softgrain/core/shared_loop.hpp"

namespace softgrain {

/// parallel_sum over the items of units, where unit u has the items first[u] .. first[u + 1] - 1, at least
/// one; with ranks each adds up the items of its units, and all get the sum, with the bits of one process.
/// add(begin, end, sum) is the sum with the items begin .. end - 1 added to it one after the other; it throws
/// nothing. A chunk whose items lie on two ranks is begun by the one and ended by the other.
template <class T, class Add>
T shared_sum(const Shares& shares, std::span<const int> first, const Add& add) {
  const int count = first.back();
  if (shares.alone()) return parallel_sum<T>(count, [&](int begin, int end) { return add(begin, end, T{}); });
  const double start = process_seconds();
  std::vector<T> part(detail::chunks(count));
  const auto [own, own_end] = shares.own();
  const int begin = first[own], end = first[own_end];
  const auto add_own = [&](int k) {
    part[k] = add(std::max(begin, k * detail::chunk), std::min(end, (k + 1) * detail::chunk), part[k]);
  };
  const int begun = detail::chunks(begin), chunks = detail::chunks(end);  // begun .. chunks - 1 begin here
  parallel_for(chunks - begun, [&](int k) { add_own(begun + k); });
  communicator().account.cpu_shared += process_seconds() - start;
  const auto pass = [&](int k, int rank, bool sends) {
    Parcel parcel{.rank = rank};
    if (sends)
      parcel.out = std::as_bytes(std::span(&part[k], 1));
    else
      parcel.in = std::as_writable_bytes(std::span(&part[k], 1));
    communicator().swap({&parcel, 1});
  };
  const bool goes_on = begin < end && end < count && end % detail::chunk != 0;
  if (goes_on && begun < chunks) pass(chunks - 1, shares.rank_of(own_end), true);
  if (begin < end && begin % detail::chunk != 0) {
    pass(begun - 1, shares.rank_of(own - 1), false);
    add_own(begun - 1);
    if (goes_on && begun == chunks) pass(chunks - 1, shares.rank_of(own_end), true);
  }
  const auto unit_of_last = [&](int k) {
    const int last = std::min(count, (k + 1) * detail::chunk) - 1;
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), last) - first.begin()) - 1;
  };
  shared_for(
      shares, detail::chunks(count), unit_of_last, [](int) {},
      [&](int k, Message& message) { message(part[k]); });
  T sum{};
  for (const T& p : part) sum += p;
  return sum;
}

}  // namespace softgrain
