#include "softgrain/experiment/speed_search.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {
namespace {

constexpr int most_tries = 24;

/// Of v_max: the first step where the slope is not known.
constexpr double first_stride = 1e-3;
constexpr double growth = 4;

/// A step by the slope goes a little further, to have the zero between two speeds.
constexpr double overshoot = 1.2;

/// From so many tries on the bracket is halved in every second one.
constexpr int patience = 6;

}  // namespace

bool SpeedSearch::found(double v, double excess) {
  ++tries_;
  if (std::abs(excess) <= accuracy_ || tries_ >= most_tries) return true;
  if (!best_.known || std::abs(excess) <= std::abs(best_.excess)) best_ = {v, excess, true};
  const int side = excess < 0 ? -1 : 1;
  Point& here = side < 0 ? low_ : high_;
  Point& there = side < 0 ? high_ : low_;
  if (side == last_side_ && there.known) there.excess /= 2;
  if (here.known && here.v != v && !there.known) slope_ = (excess - here.excess) / (v - here.v);
  if (side > 0 && here.known && v < here.v) rise_ = (excess_above_ - excess) / (here.v - v);
  if (side > 0) excess_above_ = excess;
  here = {v, excess, true};
  if (there.known && last_side_ != side) slope_ = (excess - there.excess) / (v - there.v);
  last_side_ = side;
  return side < 0 ? v >= v_max_ : v <= -v_max_;
}

double SpeedSearch::next() const {
  if (tries_ == most_tries - 1) return best_.v;
  if (low_.known && high_.known) {
    const double width = high_.v - low_.v;
    if (tries_ > patience && tries_ % 2 == 0) return low_.v + width / 2;
    // where there is no contact below, the line through the last two speeds above
    if (const double meets = high_.v - excess_above_ / rise_; rise_ > 0 && meets > low_.v && meets < high_.v)
      return meets;
    const double share = -low_.excess / (high_.excess - low_.excess);
    return low_.v + std::clamp(share, 0.01, 0.99) * width;
  }
  const Point& here = low_.known ? low_ : high_;
  double stride = first_stride * v_max_ * std::pow(growth, tries_ - 1);
  if (slope_ > 0) stride = overshoot * std::abs(here.excess) / slope_ * std::pow(growth, (tries_ - 1) / 2);
  return std::clamp(here.v + (low_.known ? stride : -stride), -v_max_, v_max_);
}

}  // namespace softgrain
