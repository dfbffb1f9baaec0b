#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "support/gravity.hpp"

using namespace softgrain;

namespace {

struct ReferenceRow {
  double t, q, v, p;
};

/// Siconos' trajectory: a line of the row count, then t, gap, velocity and impulse (twice).
std::vector<ReferenceRow> read_reference() {
  std::vector<ReferenceRow> rows;
  gzFile file = gzopen(SOFTGRAIN_TEST_DATA "/timestepping/BouncingBallTS.ref.gz", "rb");
  REQUIRE(file != nullptr);
  char line[256];
  ReferenceRow row{};
  while (gzgets(file, line, sizeof line) != nullptr)
    if (std::sscanf(line, "%lf %lf %lf %lf", &row.t, &row.q, &row.v, &row.p) == 4) rows.push_back(row);
  gzclose(file);
  return rows;
}

}  // namespace

TEST_CASE("the bouncing ball of Siconos is met to 1e-12 over 2001 rows") {
  const double R = 0.1, h = 0.005;
  const auto reference = read_reference();
  REQUIRE(reference.size() == 2001);
  const Wall<2> floor{.point = {0, -R}, .normal = {0, 1}, .velocity = {}};  // so that the gap is the height
  RigidDynamics<2> ball(
      rigid_particles<2>({{0, 1}}, {R}, {1}, {floor}), test::friction(0),
      {.solver = {},
       .law = {.restitution = 0.9, .push_out = 0, .activation = Activation::closed_at_mid_step}},
      0.05);
  double q_error = 0, v_error = 0, p_error = 0;
  for (std::size_t k = 1; k < reference.size(); ++k) {
    ball.step(test::gravity<2>({0, -9.81}), h);
    q_error = std::fmax(q_error, std::abs(ball.particles.position[0][1] - reference[k].q));
    v_error = std::fmax(v_error, std::abs(ball.particles.velocity[0][1] - reference[k].v));
    p_error = std::fmax(p_error, std::abs(-ball.wall_impulse(0)[1] - reference[k].p));
  }
  CHECK(q_error < 1e-12);
  CHECK(v_error < 1e-12);
  CHECK(p_error < 1e-12);
  CHECK(ball.particles.position[0][0] == 0);
}
