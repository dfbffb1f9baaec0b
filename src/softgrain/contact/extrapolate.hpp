#pragma once

namespace softgrain {

/// x <- x + b (x - x'), x' the number or vector when this was last done; it becomes the x of now.
template <class T>
void extrapolate(T& now, T& before, double b) {
  const T last = now;
  if (b > 0) now += b * (last - before);
  before = last;
}

}  // namespace softgrain
