#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "softgrain/contact/tangents.hpp"
#include "softgrain/mixed/primary_neighbours.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;

namespace {

constexpr double R = 1e-3, r = 0.2e-3;

/// An elastic disk about the origin, and primaries round it at some gap.
struct Crowd {
  SoftGrains grains{{test::placed(test::disk(6), R, {})},
                    make_law(MaterialLaw::neo_hookean, test::parameters(1e6, 0.3)),
                    1000};
  RigidParticles<2> primaries;
  OutlineState outline;
  std::vector<Vec<2>> velocity;
  std::vector<double> inverse_mass;

  explicit Crowd(double gap) {
    std::vector<Vec<2>> place;
    for (int k = 0; k < 7; ++k) {
      const double angle = 0.9 * k + 0.1;
      place.push_back((R + r + gap) * Vec<2>{std::cos(angle), std::sin(angle)});
    }
    primaries = rigid_particles<2>(place, std::vector<double>(7, r), std::vector<double>(7, 3e-4), {});
    primaries.grain.assign(7, 0);
    std::vector<Vec<2>> x;
    grains.gather_outline(x);
    outline.start = outline.position = x;
    outline.dt = 1e-6;
    velocity.assign(x.size(), {});
    for (std::size_t v = 0; v < x.size(); ++v)
      inverse_mass.push_back(1 / (1e-5 * (1 + 0.1 * static_cast<double>(v % 5))));
  }
};

}  // namespace

TEST_CASE("primaries at a disk are met by its curve and by its vertices, and no others are") {
  Crowd crowd(-0.01e-3);
  const std::vector<PrimaryContact> found =
      PrimaryNeighbours().detect(crowd.grains, crowd.outline, crowd.primaries);
  for (int i = 0; i < 7; ++i) {
    const auto curve = std::find_if(found.begin(), found.end(),
                                    [&](const PrimaryContact& c) { return c.primary == i && c.vertex < 0; });
    REQUIRE(curve != found.end());
    CHECK(std::abs(curve->gap + 0.01e-3) < 1e-3 * r);  // the curve leaves the circle by less
    CHECK(norm(curve->normal + (1 / norm(crowd.primaries.position[i])) * crowd.primaries.position[i]) < 0.02);
  }
  int vertices = 0;
  for (int v = 0; v < crowd.grains.outline_size(); ++v)
    for (int i = 0; i < 7; ++i)
      vertices += norm(crowd.outline.position[v] - crowd.primaries.position[i]) - r < 0 ? 1 : 0;
  const auto touching = std::count_if(found.begin(), found.end(),
                                      [](const PrimaryContact& c) { return c.vertex >= 0 && c.gap < 0; });
  CHECK(touching == vertices);
  CHECK(std::is_sorted(found.begin(), found.end(),
                       [](const PrimaryContact& a, const PrimaryContact& b) { return a.key() < b.key(); }));
  Crowd apart(0.2e-3);
  CHECK(PrimaryNeighbours().detect(apart.grains, apart.outline, apart.primaries).empty());
}

TEST_CASE("contacts that were looked for before are those that a first look finds") {
  Crowd crowd(0.02e-3);
  PrimaryNeighbours kept;
  kept.detect(crowd.grains, crowd.outline, crowd.primaries);
  for (int step = 0; step < 12; ++step) {  // towards the disk, and along it
    for (Vec<2>& x : crowd.primaries.position)
      x += -0.01 * r / norm(x) * x + 0.05 * r / norm(x) * perpendicular(x);
    const auto now = kept.detect(crowd.grains, crowd.outline, crowd.primaries),
               anew = PrimaryNeighbours().detect(crowd.grains, crowd.outline, crowd.primaries);
    REQUIRE(now.size() == anew.size());
    REQUIRE(!now.empty());
    for (std::size_t c = 0; c < now.size(); ++c) {
      CHECK(now[c].key() == anew[c].key());
      CHECK(now[c].gap == anew[c].gap);
      CHECK(now[c].normal == anew[c].normal);
    }
  }
}

TEST_CASE("an impulse changes the velocity of its contact by W, and momentum and spin by what it says") {
  Crowd crowd(-0.005e-3);
  const std::vector<PrimaryContact> found =
      PrimaryNeighbours().detect(crowd.grains, crowd.outline, crowd.primaries);
  PrimaryContactSystem system(found, crowd.outline, crowd.velocity, crowd.inverse_mass, crowd.primaries);
  for (int c = 0; c < system.size(); ++c)
    for (int k = 0; k < 2; ++k) {
      Vec<2> dp;
      dp[k] = 3e-4;
      const Vec<2> before = system.relative_velocity(c);
      const auto momentum = [&] {
        Vec<2> sum;
        for (std::size_t v = 0; v < crowd.velocity.size(); ++v)
          sum += (1 / crowd.inverse_mass[v]) * crowd.velocity[v];
        for (int i = 0; i < 7; ++i) sum += crowd.primaries.mass[i] * crowd.primaries.velocity[i];
        return sum;
      };
      const Vec<2> total = momentum();
      const int i = found[c].primary;
      const double spin = crowd.primaries.spin[i][0];
      system.apply_impulse(c, dp);
      const Vec<2> change = system.relative_velocity(c) - before, expected = system.delassus_block(c) * dp;
      CHECK(norm(change - expected) < 1e-12 * norm(expected));
      CHECK(norm(momentum() - total) < 1e-14);
      // -r x P over I, times r: I = m r^2/2
      const double turned = -2 * dp[1] / crowd.primaries.mass[i];
      CHECK(std::abs(crowd.primaries.spin[i][0] - spin - turned) < 1e-12);
    }
  // at the start the gap at the end of the step over dt is what a contact asks for
  Crowd still(-0.005e-3);
  PrimaryContactSystem at_rest(found, still.outline, still.velocity, still.inverse_mass, still.primaries);
  for (int c = 0; c < at_rest.size(); ++c)
    CHECK(std::abs(at_rest.relative_velocity(c)[0] * still.outline.dt / found[c].gap - 1) < 1e-12);
}
