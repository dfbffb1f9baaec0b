#pragma once
#include <memory>

#include "softgrain/experiment/plate_path.hpp"
#include "softgrain/experiment/simulation.hpp"

namespace softgrain {

/// The walls of another path, at speeds that are given as a function of time; all of it is one leg.
class GivenPath final : public PlatePath {
 public:
  /// Raises UsageError for a duration that is not positive.
  GivenPath(std::shared_ptr<const PlatePath> own, PlateMotion motion, double dt);

  std::int64_t steps() const override { return steps_; }
  /// Asks the motion once a step. Raises UsageError for an answer that is not finite.
  double plate_velocity(std::int64_t step, double travel) const override;
  bool approaches(std::int64_t step) const override { return plate_velocity(step, 0) < 0; }
  std::array<double, 4> shares() const override { return own_->shares(); }
  int leg(std::int64_t) const override { return 0; }
  double strain(double height_start, double height) const override {
    return own_->strain(height_start, height);
  }

 private:
  std::shared_ptr<const PlatePath> own_;
  PlateMotion motion_;
  double dt_ = 0;
  std::int64_t steps_ = 0;
  mutable std::int64_t asked_for_ = -1;
  mutable double answer_ = 0;  // [m/s]
};

}  // namespace softgrain
