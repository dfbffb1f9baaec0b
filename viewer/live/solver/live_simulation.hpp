#pragma once
#include <memory>
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// What the page draws and plots at a moment.
struct LivePicture {
  std::vector<float> outline;  ///< x y of all vertices, each grain's counter-clockwise [m]; elastic grains
  std::vector<int> outline_begin;  ///< (grains + 1) first vertex of each grain
  std::vector<float> disks;        ///< x y [m], radius [m], grain of each primary; bonded grains
  std::vector<float> pressure;     ///< (grains) of each, as virial_pressure gives it [Pa]
  /// x0 y0 x1 y1 [m], normal force [N/m]: of each contact the way from each grain's centre to where it is.
  std::vector<float> chains;
  std::vector<double> numbers;  ///< in the order of live_numbers()
};

/// Names of LivePicture::numbers: columns of series.csv.
const std::vector<std::string>& live_numbers();

/// Grains in a box whose top wall goes where a hand wants it, at most at the speed of the case.
class LiveSimulation {
 public:
  /// Raises UsageError for a case that cannot be simulated.
  explicit LiveSimulation(const Case& c);
  LiveSimulation(LiveSimulation&&) = delete;  // the motion of the top wall asks this one

  /// The top wall goes to this height [m] above the bottom and stays there.
  void drive_to(double height) { goal_ = height; }
  double start_height() const { return start_height_; }  ///< [m]

  /// Raises NumericalError as Simulation::step.
  void step();
  /// Why there is no further step, for the visitor; "" if there is.
  std::string early_end() const { return simulation_->early_end(); }

  /// Stresses are means over the steps since the picture before.
  const LivePicture& picture();

 private:
  double wall_velocity() const;
  void draw_primaries();
  void draw_contacts(const Outlines& outlines);

  std::unique_ptr<Simulation> simulation_;
  std::vector<float> primary_radius_;  // [m]; of bonded grains
  double speed_ = 0, start_height_ = 0, goal_ = 0;
  LivePicture picture_;
};

}  // namespace softgrain
