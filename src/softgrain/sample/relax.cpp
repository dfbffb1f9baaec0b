#include "softgrain/sample/relax.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "softgrain/geometry/images.hpp"

namespace softgrain {

template <int Dim>
PeriodicCell<Dim> cell_of(const BoxSampleOf<Dim>& sample) {
  PeriodicCell<Dim> cell{.repeats = sample.repeats};
  for (int k = 0; k < Dim; ++k)
    if (sample.repeats[static_cast<std::size_t>(k)]) cell.edges(k, k) = sample.size()[k];
  return cell;
}

template <int Dim>
double push_apart(BoxSampleOf<Dim>& sample, double clearance, double widest) {
  double worst = 0;
  std::vector<Vec<Dim>> centres;
  const Vec<Dim> size = sample.size();
  for (PlacedGrainOf<Dim>& grain : sample.grains) {
    const double reach = (1 + clearance) * grain.radius;
    for (int k = 0; k < Dim; ++k) {
      if (sample.repeats[k]) continue;
      const double inside = std::clamp(grain.centre[k], reach, size[k] - reach);
      worst = std::max(worst, std::abs(inside - grain.centre[k]));
      grain.centre[k] = inside;
    }
    centres.push_back(grain.centre);
  }
  const double reach = 2 * (1 + clearance) * widest;
  const PeriodicCell<Dim> cell = cell_of(sample);
  const bool repeats = cell.any();  // others have moved on since
  for_each_close_pair<Dim>(centres, cell, reach, [&](int i, int j, const Vec<Dim>& apart, const auto&) {
    PlacedGrainOf<Dim>&a = sample.grains[i], &b = sample.grains[j];
    const Vec<Dim> d = repeats ? apart : b.centre - a.centre;
    const double distance = norm(d), overlap = (1 + clearance) * (a.radius + b.radius) - distance;
    if (!(overlap > 0)) return;
    worst = std::max(worst, overlap);
    // two in one corner: apart in any direction
    const Vec<Dim> push = distance > 0 ? (0.3 * overlap / distance) * d : Vec<Dim>{0.3 * overlap};
    a.centre -= push;
    b.centre += push;
  });
  return worst;
}

namespace {

template <int Dim>
using Places = std::vector<Vec<Dim>>;

/// The largest component, by magnitude.
template <int Dim>
double largest_of(const Places<Dim>& vectors) {
  double most = 0;
  for (const Vec<Dim>& v : vectors)
    for (int d = 0; d < Dim; ++d) most = std::max(most, std::abs(v[d]));
  return most;
}

/// Grown grains as soft bodies of stiffness 1 and mass 1.
template <int Dim>
class Overlaps {
 public:
  Overlaps(const BoxSampleOf<Dim>& sample, double clearance)
      : size_(sample.size()), repeats_(sample.repeats), cell_(cell_of(sample)) {
    for (const auto& grain : sample.grains) {
      radius_.push_back((1 + clearance) * grain.radius);
      widest_ = std::max(widest_, radius_.back());
    }
  }

  /// -dE/dx [m]; returns the largest overlap [m].
  double forces(const Places<Dim>& x, Places<Dim>& force) {
    renew_pairs(x);
    force.assign(x.size(), {});
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int k = 0; k < Dim; ++k) {
        if (repeats_[static_cast<std::size_t>(k)]) continue;
        const double low = radius_[i] - x[i][k], high = x[i][k] + radius_[i] - size_[k];
        force[i][k] += std::max(0.0, low) - std::max(0.0, high);
        worst = std::max({worst, low, high});
      }
    for (const Pair& pair : pairs_) {
      const Vec<Dim> d = x[pair.b] + pair.shift - x[pair.a];
      const double distance = norm(d), overlap = radius_[pair.a] + radius_[pair.b] - distance;
      if (!(overlap > 0)) continue;
      const Vec<Dim> push = distance > 0 ? (overlap / distance) * d : Vec<Dim>{overlap};
      force[pair.a] -= push;
      force[pair.b] += push;
      worst = std::max(worst, overlap);
    }
    return worst;
  }

 private:
  struct Pair {
    std::size_t a, b;
    Vec<Dim> shift;  // of the image of b that is near
  };

  /// All that may touch before a grain has moved by half of the skin.
  void renew_pairs(const Places<Dim>& x) {
    const double skin = 0.3 * widest_;
    double moved = 0;
    for (std::size_t i = 0; i < listed_at_.size(); ++i) moved = std::max(moved, norm(x[i] - listed_at_[i]));
    if (!listed_at_.empty() && moved < skin / 2) return;
    listed_at_ = x;
    pairs_.clear();
    for_each_close_pair<Dim>(x, cell_, 2 * widest_ + skin,
                             [&](int i, int j, const Vec<Dim>& d, const auto& image) {
                               const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
                               if (norm(d) < radius_[a] + radius_[b] + skin)
                                 pairs_.push_back({a, b, cell_.shift(image)});
                             });
  }

  Vec<Dim> size_;
  std::array<bool, Dim> repeats_;
  PeriodicCell<Dim> cell_;
  std::vector<double> radius_;
  double widest_ = 0;
  Places<Dim> listed_at_;
  std::vector<Pair> pairs_;
};

}  // namespace

template <int Dim>
bool relax(BoxSampleOf<Dim>& sample, double clearance, double tolerance) {
  constexpr int most_steps = 20000, before_faster = 5;
  constexpr double first_step = 0.1, longest_step = 0.5, first_mixing = 0.1;
  constexpr double balanced = 1e-3;  // forces over overlaps of what is jammed
  Overlaps<Dim> overlaps(sample, clearance);
  Places<Dim> x, v(sample.grains.size()), force;
  for (const auto& grain : sample.grains) x.push_back(grain.centre);
  double dt = first_step, mixing = first_mixing;
  int downhill = 0;
  for (int step = 0; step < most_steps; ++step) {
    const double worst = overlaps.forces(x, force);
    for (std::size_t i = 0; i < x.size(); ++i) sample.grains[i].centre = x[i];
    if (worst <= tolerance) return true;
    if (largest_of<Dim>(force) < balanced * worst) return false;
    double power = 0, speed = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      power += dot(force[i], v[i]);
      speed += dot(v[i], v[i]);
      size += dot(force[i], force[i]);
    }
    const double towards = power > 0 ? mixing * std::sqrt(speed / size) : 0;
    const double kept = power > 0 ? 1 - mixing : 0;
    downhill = power > 0 ? downhill + 1 : 0;
    if (power <= 0) dt *= 0.5, mixing = first_mixing;
    if (downhill > before_faster) dt = std::min(1.1 * dt, longest_step), mixing *= 0.99;
    for (std::size_t i = 0; i < x.size(); ++i) {
      v[i] = kept * v[i] + (towards + dt) * force[i];
      x[i] += dt * v[i];
    }
  }
  return false;
}

template PeriodicCell<2> cell_of(const BoxSample&);
template PeriodicCell<3> cell_of(const BoxSampleOf<3>&);
template double push_apart(BoxSample&, double, double);
template double push_apart(BoxSampleOf<3>&, double, double);
template bool relax(BoxSample&, double, double);
template bool relax(BoxSampleOf<3>&, double, double);

}  // namespace softgrain
