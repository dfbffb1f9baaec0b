#include <doctest/doctest.h>

#include <functional>
#include <limits>

#include "reliability/tiny_cases.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/lattice/updated_lagrangian.hpp"
#include "softgrain/rigid/step.hpp"
#include "softgrain/soft/implicit_step.hpp"
#include "support/soft_grains.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

/// What breaks down, and what the message must say of it.
struct Breakdown {
  std::string base;
  Words settings;
  Words words;
};

const std::vector<Breakdown> breakdowns{
    // walls too fast
    {"compaction-mpm",
     {"mpm.integrator=\"explicit\"", "time.step=0", "loading.wall_velocity=\"250 m/s\"",
      "loading.unload_at=[]"},
     {"turned inside out", "use a smaller time step"}},
    {"compaction-mpm",
     {"mpm.integrator=\"explicit\"", "time.step=0", "loading.wall_velocity=\"1e5 m/s\"",
      "loading.unload_at=[]"},
     {"step 1: wall 1 moves by", "use a smaller time step"}},
    {"diametral-mpm",
     {"mpm.formulation=\"updated_lagrangian\"", "time.step=0", "loading.wall_velocity=\"1e5 m/s\"",
      "loading.unload_at=[]"},
     {"step 1: wall 1 moves by", "use a smaller time step"}},
    // laws that do not resist inversion
    {"diametral-mpm",
     {"mpm.law=\"st_venant_kirchhoff\"", "loading.unload_at=[]", "loading.max_strain=1.2"},
     {"turned inside out in grain 0"}},
    {"diametral-mpm",
     {"mpm.law=\"st_venant_kirchhoff\"", "loading.unload_at=[]", "loading.max_strain=1.2",
      "mpm.integrator=\"explicit\"", "time.step=0", "loading.wall_velocity=\"10 m/s\""},
     {"grain 0 is turned inside out"}},
    {"diametral-bpm", {"bpm.inner_friction=1e300"}, {"step 1: the velocity of particle 0 is not finite"}},
    {"diametral-mpm",
     {"loading.wall_velocity=\"1e5 m/s\"", "loading.unload_at=[]", "loading.max_strain=2"},
     {"step 1: the implicit step failed", "of the explicit step", "in grain 0"}},
    // a tolerance that no iteration reaches
    {"diametral-mpm",
     {"mpm.tolerance=1e-17"},
     {"step 1: the implicit step failed even at dt = 7.81e-08 s",
      "Newton's method does not converge in grain 0", "a larger mpm.tolerance"}},
    // walls that leave no room
    {"diametral-bpm",
     {"loading.max_strain=2.9", "loading.unload_at=[]", "loading.wall_velocity=\"20 m/s\""},
     {"primaries overlap by", "use a smaller time.step"}},
    {"compaction-mpm",
     {"loading.max_strain=2.9", "mpm.law=\"corotated\"", "mpm.cells=2", "sample.grains=3"},
     {"the implicit step failed", "of the explicit step", "in grain "}},
};

/// The message of the error that the next step ends with.
std::string error_of(const std::function<void()>& step) {
  try {
    step();
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "no error";
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE(
    "numbers that break down are code 3 with the step, what broke, where, the remedy and an intact last "
    "state") {
  for (const auto& [base, settings, words] : breakdowns) {
    const Workshop workshop;
    CAPTURE(base);
    TinyCase tiny{base, base, tiny_settings(base)};
    tiny.settings.insert(tiny.settings.end(), settings.begin(), settings.end());
    const ProcessResult result = run_tiny(workshop, tiny, "out");
    CAPTURE(result.err);
    CHECK(result.exit_code == 3);
    CHECK(result.err.find("error: step ") == 0);
    for (const std::string& word : words) CHECK(result.err.find(word) != std::string::npos);
    CHECK(result.err.find("use a ") != std::string::npos);
    CHECK(result.err.find("the last good state is out/snap/s") != std::string::npos);
    CHECK(workshop.intact("out"));
    CHECK(nlohmann::json::parse(read_text(workshop.path("out/run.json"))).at("state") == "failed");
  }
}

TEST_CASE("a NaN ends the step in which it comes up, and the grain or particle is named") {
  RigidDynamics<2> rigid(
      rigid_particles<2>({{0, 0}, {2.1, 0}}, {1, 1}, {1, 1}, {}), [](int, int) { return 0.3; }, {}, 0.5);
  const auto not_a_force = [](const auto&, auto force) { force[1] = {not_a_number, 0}; };
  CHECK(error_of([&] { rigid.step(not_a_force, 0.01); }) ==
        "the velocity of particle 0 is not finite; use a smaller time step");  // they touch

  const auto shape = disk(2);
  const SoftGrains grains({placed(shape, 1e-3, {0, 0}), placed(shape, 1e-3, {2.1e-3, 0})},
                          make_law(MaterialLaw::corotated, 1e6, 0.3), 1000);
  ImplicitDynamics implicit(grains, {floor_at(-1e-3)}, {});
  implicit.grains.batches[0].velocity[0][0].set(1, not_a_number);
  const std::string message = error_of([&] { implicit.step(1e-6); });
  CAPTURE(message);
  CHECK(message.find("of the explicit step") != std::string::npos);
  CHECK(message.find("in grain 1") != std::string::npos);

  UpdatedLagrangianDynamics lagrangian({disk_of_points(1e-3, {}, 2e-4, 24)}, {floor_at(-1e-3)},
                                       make_law(MaterialLaw::neo_hookean, 1e6, 0.3), 1000, {.cell = 2e-4});
  lagrangian.grains[0].velocity[3] = {not_a_number, 0};
  CHECK(error_of([&] { lagrangian.step(1e-6); }) ==
        "a velocity of grain 0 is not finite; use a smaller time step");
}

TEST_CASE("a step that fails is divided, given up far below the explicit one, and taken back as it was") {
  const SoftGrains grains({placed(disk(2), 1e-3, {0, 0})}, make_law(MaterialLaw::neo_hookean, 1e6, 0.3),
                          1000);
  ImplicitDynamics dynamics(
      grains, {floor_at(-0.5e-3), {.point = {0, -0.6e-3}, .normal = {0, -1}, .velocity = {0, 1}}}, {});
  std::vector<Vec<2>> before, after;
  dynamics.grains.gather_outline(before);
  const std::string message = error_of([&] { dynamics.step(256e-6); });
  CAPTURE(message);
  CHECK(message.find("of the explicit step") != std::string::npos);
  dynamics.grains.gather_outline(after);
  CHECK(after == before);
  CHECK(dynamics.box.walls[1].point[1] == -0.6e-3);
}
