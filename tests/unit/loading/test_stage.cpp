#include "softgrain/loading/stage.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/stages_of_case.hpp"
#include "support/spring_box.hpp"

using namespace softgrain;

namespace {

constexpr double R = 5e-3, height = 36e-3;

Case case_of(LoadingPath path, const Case::Loading& loading) {
  Case c;
  c.experiment.loading = path;
  c.loading = loading;
  c.grain.radius = R;
  return c;
}

struct Leg {
  double velocity = 0, strain = 0;  // of the top wall against the bottom; strain where it ends
  std::int64_t steps = 0;
};

/// The stages of a case as steps of dt really go through them, in a box of this height.
std::vector<Leg> legs_of(const Case& c, double h, double dt) {
  Box<2> box = test::square_box(h);
  Loading loading(stages_of(c), frame_of(c), box);
  test::SpringModel model(0);
  std::vector<Leg> legs;
  const std::int64_t planned = loading.steps_planned(dt);
  std::int64_t step = 0;
  for (; !loading.finished(); ++step) {
    const double time = static_cast<double>(step) * dt;
    loading.drive(box, model, time, dt);
    const double speed = box.walls[bottom_wall].velocity[1] - box.walls[top_wall].velocity[1];
    model.step(box, dt);
    loading.after_step(box, time + dt, dt, {});
    if (loading.number() == static_cast<int>(legs.size())) legs.push_back({-speed, 0, 0});
    REQUIRE(std::abs(speed) <= c.loading.wall_velocity * (1 + 1e-6));
    legs.back().strain = loading.strain(box);
    ++legs.back().steps;
  }
  CHECK(step == planned);
  CHECK_FALSE(loading.at_turning_point());
  return legs;
}

void check_ends(const std::vector<Leg>& legs, const std::vector<double>& strains) {
  REQUIRE(legs.size() == strains.size());
  for (std::size_t k = 0; k < legs.size(); ++k)
    CHECK(legs[k].strain == doctest::Approx(strains[k]).epsilon(1e-9));
}

}  // namespace

TEST_CASE("the strain of a grain is -ln(1 - d/R) with d half the travel of the walls") {
  const StrainMeasure measure{StrainMeasure::Kind::of_grain, 2 * R};
  CHECK(measure.strain(1, 1 - R) == doctest::Approx(std::log(2.0)).epsilon(1e-13));  // d = R/2
  CHECK(measure.strain(2 * R, 2 * R * (1 - 1e-6)) == doctest::Approx(1e-6).epsilon(1e-6));
  for (const double strain : {0.0, 0.01, 0.1, 0.35, 1.0})
    CHECK(measure.strain(0, -measure.travel(strain)) == doctest::Approx(strain).epsilon(1e-13));
}

TEST_CASE("the top wall goes down, turns back at each strain asked for by the strain asked for, and stops") {
  const Case c =
      case_of(LoadingPath::diametral,
              {.wall_velocity = 0.2, .max_strain = 0.35, .unload_at = {0.1, 0.3}, .unload_by = 0.012});
  check_ends(legs_of(c, 2 * R, 0.25e-6), {0.1, 0.088, 0.3, 0.288, 0.35});
}

TEST_CASE("a loading of 60 turns ends where the case says, though a step is longer than its stages") {
  const double dt = 2.5e-4;  // 50 um a step, 0.5 % of strain
  Case::Loading loading{.wall_velocity = 0.2, .max_strain = 0.35, .unload_at = {}, .unload_by = 0.0005};
  std::vector<double> ends;
  for (int turn = 1; turn <= 60; ++turn) {
    loading.unload_at.push_back(0.0051 * turn);
    ends.insert(ends.end(), {0.0051 * turn, 0.0051 * turn - 0.0005});
  }
  ends.push_back(0.35);
  check_ends(legs_of(case_of(LoadingPath::diametral, loading), 2 * R, dt), ends);
  loading.unload_at = {};
  loading.max_strain = 1e-4;
  check_ends(legs_of(case_of(LoadingPath::diametral, loading), 2 * R, dt), {1e-4});
}

TEST_CASE("a stage counts from the travel really made, whatever came before") {
  const Case c = case_of(LoadingPath::diametral, {.wall_velocity = 0.2, .max_strain = 0.1, .unload_at = {}});
  const double dt = 0.25e-6;
  Box<2> box({{{0, 0}, {0, 1}, {}}, {{0, 2 * R}, {0, -1}, {}}});
  Loading loading(stages_of(c), frame_of(c), box);
  box.walls[top_wall].point[1] -= 0.7 * 0.2 * dt;  // ahead of the loading
  const test::SpringModel model(0);
  for (double time = 0; !loading.finished(); time += dt) {
    loading.drive(box, model, time, dt);
    for (Wall<2>& wall : box.walls) wall.point += dt * wall.velocity;
    loading.after_step(box, time + dt, dt, {});
  }
  CHECK(loading.strain(box) == doctest::Approx(0.1).epsilon(1e-9));
}

TEST_CASE("the top wall of a box comes down to eps = ln(h_start/h) at its speed, and rests where it turns") {
  const double dt = 1e-7, v = 5;
  Case::Loading loading{.wall_velocity = v, .max_strain = 0.3, .unload_at = {}};
  const auto one = legs_of(case_of(LoadingPath::compaction, loading), height, dt);
  check_ends(one, {0.3});
  CHECK(one[0].velocity == -v);
  CHECK(one[0].steps == std::ceil(height * (1 - std::exp(-0.3)) / (v * dt)));
  loading.unload_at = {0.1, 0.25};
  loading.unload_by = 0.02;
  loading.hold = 50e-6;
  const auto legs = legs_of(case_of(LoadingPath::compaction, loading), height, dt);
  const double strain[] = {0.1, 0.08, 0.25, 0.23, 0.3}, velocity[] = {-v, v, -v, v, -v};
  REQUIRE(legs.size() == 10);
  for (std::size_t k = 0; k < 5; ++k) {
    CHECK(legs[2 * k].velocity == velocity[k]);
    CHECK(legs[2 * k].strain == doctest::Approx(strain[k]).epsilon(1e-9));
    CHECK(legs[2 * k + 1].velocity == 0);
    CHECK(legs[2 * k + 1].steps == 500);
  }
}

TEST_CASE("a packing fraction ends the loading where undeformed grains fill it, and leaves out later turns") {
  Case::Loading loading{.wall_velocity = 5, .max_strain = 0.4, .unload_at = {0.1, 0.3}};
  loading.max_packing_fraction = 0.85;
  const auto legs = legs_of(case_of(LoadingPath::compaction, loading), height, 1e-7);
  REQUIRE(legs.size() == 3);
  CHECK(0.7 * std::exp(legs.back().strain) == doctest::Approx(0.85).epsilon(1e-9));
  const auto both = legs_of(case_of(LoadingPath::isotropic, loading), height, 1e-7);
  CHECK(both.size() == 1);  // Phi_0 = Phi_start e^(2 eps) is there before the first turn
  CHECK(0.7 * std::exp(2 * both.back().strain) == doctest::Approx(0.85).epsilon(1e-9));
  loading.max_packing_fraction = 2;
  CHECK(legs_of(case_of(LoadingPath::compaction, loading), height, 1e-7).back().strain ==
        doctest::Approx(0.4).epsilon(1e-9));
}

TEST_CASE("a loading that cannot be followed is refused with the key and the value") {
  const auto make = [](const Case::Loading& loading) {
    check_loading(case_of(LoadingPath::diametral, loading));
  };
  CHECK_THROWS_WITH_AS(make({.wall_velocity = -1}), "loading.wall_velocity must be > 0, got -1 m/s",
                       UsageError);
  CHECK_THROWS_WITH_AS(make({.max_strain = 0}), "loading.max_strain must be > 0, got 0", UsageError);
  CHECK_THROWS_AS(make({.max_strain = 0.2, .unload_at = {0.1, 0.2}}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1, 0.05}}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1}, .unload_by = 0.11}), UsageError);
  CHECK_THROWS_AS(make({.unload_at = {0.1}, .unload_by = 0}), UsageError);
  CHECK_THROWS_WITH_AS(make({.max_strain = 0.2, .unload_at = {0.1, 0.25}, .unload_by = 0.01}),
                       "loading.unload_at must rise and stay below loading.max_strain 0.2, with 0 < "
                       "loading.unload_by 0.01 < each; got 0.25",
                       UsageError);
}

TEST_CASE("a sine and a triangle begin at 0, reach 1 after a quarter and -1 after three") {
  for (const Wave wave : {Wave::sine, Wave::triangle}) {
    const double at[] = {0, 0.25, 0.5, 0.75, 1, 1.25}, value[] = {0, 1, 0, -1, 0, 1};
    for (int k = 0; k < 6; ++k)
      CHECK(wave_at(wave, 3 * at[k], 3) == doctest::Approx(value[k]).epsilon(1e-12));
  }
  CHECK(wave_at(Wave::triangle, 0.125, 1) == doctest::Approx(0.5));
  CHECK(wave_at(Wave::sine, 0.125, 1) == doctest::Approx(std::sqrt(0.5)));
}

TEST_CASE("a group of stages is repeated as often as it is asked for, and a group within a group too") {
  const auto stage = [](const char* name, int repeat = 1, const char* from = "") {
    return Stage{.name = name, .until = {.time = 1}, .repeat = repeat, .repeat_from = from};
  };
  const auto names = [](const std::vector<Stage>& stages) {
    std::string text;
    for (const Stage& s : without_repeats(stages)) text += s.name;
    return text;
  };
  CHECK(names({stage("a"), stage("b"), stage("c", 3, "b"), stage("d")}) == "abcbcbcd");
  CHECK(names({stage("a", 3)}) == "aaa");
  CHECK(names({stage("a"), stage("b", 2), stage("c", 2, "a")}) == "abbcabbc");
  CHECK_THROWS_WITH_AS(names({stage("a", 2, "z")}), "repeat_from = \"z\": no stage before has this name",
                       UsageError);
  CHECK_THROWS_AS(names({stage("a", 200'000)}), UsageError);
}

TEST_CASE("stages that contradict themselves or may never end are refused") {
  const auto fault = [](std::vector<Drive> drives, Until until) {
    return fault_of({.name = "s", .drives = std::move(drives), .until = until});
  };
  const Drive yy{.part = Part::yy, .control = Control::velocity, .value = 1};
  CHECK(fault({yy}, {.time = 1}).empty());
  CHECK(fault({yy, {.part = Part::top}}, {.time = 1}) == "yy and top both move one wall: give one of them");
  CHECK(fault({yy, {.part = Part::xx}, {.part = Part::left}}, {.time = 1}).starts_with("xx and left"));
  CHECK(fault({{.part = Part::bottom}, {.part = Part::top}}, {.time = 1}).empty());
  CHECK(fault({yy}, {}).starts_with("it never ends: give until"));
  CHECK(fault({yy}, {.strain = {std::nullopt, 0.2}}).starts_with("it never ends, as nothing moves xx"));
  const Drive keeps{.part = Part::xx, .control = Control::stress, .value = 1e6};
  CHECK(fault({keeps}, {.rest = 1e-3}).find("give until.time too") != std::string::npos);
  CHECK(fault({keeps, yy}, {.rest = 1e-3}).empty());  // it stops at a strain of 3
  CHECK(fault({{.part = Part::yy, .control = Control::strain, .amplitude = 0.1}}, {.time = 1})
            .find("needs a period") != std::string::npos);
  Drive pulls = keeps;
  pulls.amplitude = 2e6;
  pulls.period = 1;
  CHECK(fault({pulls}, {.time = 1}).find("would pull the grains") != std::string::npos);
  CHECK_THROWS_WITH_AS(check_stages({{.until = {.time = 1}}, {}}),
                       "stage 1: it never ends: give until, as in until = { time = \"1 ms\" }", UsageError);
}
