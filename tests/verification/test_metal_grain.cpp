#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/soft/implicit_step.hpp"
#include "softgrain/soft/soft_view.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, yield = 1e5;

struct Metal {
  double young = 100, hardening = 0;  ///< over the yield stress
  int cells = 16;
  double speed = 0.2, dt = 1e-5;
};

class PressedMetal {
 public:
  explicit PressedMetal(const Metal& metal) : metal_(metal), dynamics_(made_of(metal)) {}

  /// Until the centre has come so near to the plates, in R; F/(sigma_y R) there.
  double force_at(double approach) {
    const double way = metal_.speed * metal_.dt / (2 * R);
    while (approach_ < approach - way / 2) {
      dynamics_.step(metal_.dt);
      approach_ += way;
    }
    return force();
  }
  /// Lifts the plate slowly until nothing presses; what the grain gives back, in R.
  double recovery() {
    const double turn = approach_, slow = 0.2, dt = metal_.dt;
    double before = 0, now = force();
    dynamics_.box.walls[1].velocity[1] *= -slow;
    while (now > 1e-2) {
      before = now;
      dynamics_.step(dt);
      approach_ -= slow * metal_.speed * dt / (2 * R);
      now = force();
    }
    dynamics_.box.walls[1].velocity[1] /= -slow;
    return turn - approach_ + now / (before - now) * slow * metal_.speed * dt / (2 * R);
  }
  const ImplicitDynamics& dynamics() const { return dynamics_; }

 private:
  static ImplicitDynamics made_of(const Metal& metal) {
    const auto shape = test::disk(metal.cells);
    double reach = 0;
    for (const Vec<2>& X : shape->grid.outline()) reach = std::max(reach, X[1] * R);
    const AnyLaw law = make_law(MaterialLaw::von_mises, {.young_modulus = metal.young * yield,
                                                         .poisson_ratio = 0.3,
                                                         .yield_stress = yield,
                                                         .hardening_modulus = metal.hardening * yield});
    return {{{test::placed(shape, R, {0, 0})}, law, 990},
            {test::floor_at(-reach), {.point = {0, reach}, .normal = {0, -1}, .velocity = {0, -metal.speed}}},
            {}};
  }
  double force() const {
    return (dynamics_.wall_impulse(1)[1] - dynamics_.wall_impulse(0)[1]) / (2 * metal_.dt * yield * R);
  }

  Metal metal_;
  ImplicitDynamics dynamics_;
  double approach_ = 0;
};

}  // namespace

// References: finite elements of a quarter disk by an independent program, on five meshes and with two kinds
// of elements, good to 1 % (docs/decisions/0038).
TEST_CASE("a metal grain between walls follows the finite elements, and springs back as little") {
  PressedMetal press({});
  const std::vector<std::pair<double, double>> reference{{0.05, 1.003}, {0.1, 1.197}};
  for (const auto& [approach, force] : reference) {
    CAPTURE(approach);
    CHECK(press.force_at(approach) == doctest::Approx(force).epsilon(0.05));
  }
  const double recovery = press.recovery();
  CHECK(std::abs(recovery / 0.01044 - 1) < 0.05);
  const auto& work = press.dynamics().work;
  CHECK(work.flow > 0.95 * work.walls);  // nearly all is gone
  CHECK(stored_energy(press.dynamics().grains) < 0.02 * work.walls);
}

TEST_CASE(
    "a metal grain does not lock: 16 cells within 5 % at d/R = 0.2, E/sigma_y = 1000, 8 cells within 8 %") {
  CHECK(PressedMetal({.young = 1000}).force_at(0.2) == doctest::Approx(1.602).epsilon(0.05));
  CHECK(PressedMetal({.young = 1000, .cells = 8}).force_at(0.2) == doctest::Approx(1.602).epsilon(0.08));
}

TEST_CASE("a metal grain that hardens carries more, as the finite elements say") {
  PressedMetal press({.young = 1000, .hardening = 10, .cells = 8});
  CHECK(press.force_at(0.1) == doctest::Approx(2.446).epsilon(0.05));
  CHECK(press.force_at(0.2) == doctest::Approx(5.060).epsilon(0.05));
}
