#include <doctest/doctest.h>

#include <cmath>

#include "softgrain/experiment/adhesion_of_case.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/case/case_text.hpp"
#include "support/case_refusal.hpp"

using namespace softgrain;
using namespace softgrain::test;

namespace {

constexpr double pi = 3.14159265358979;

const std::string sticky = R"([experiment]
loading = "compaction"
model = "mpm"
[mpm]
cells = 8
young_modulus = "1 MPa"
poisson_ratio = 0.3
[sample]
smallest_diameter = "1 mm"
largest_diameter = "2 mm"
[contact]
surface_energy = "40 mJ/m^2"
)";

const std::string kinds = R"([[kind]]
name = "soft"
share = 1
[[kind]]
name = "hard"
share = 1
[[pair]]
between = ["hard", "soft"]
friction = 0.5
surface_energy = "0.2 J/m^2"
adhesion_range = "3 um"
[[pair]]
between = ["soft", "wall"]
surface_energy = "0.1 J/m^2"
[[pair]]
between = ["hard", "hard"]
surface_energy = 0
)";

Case parse_sticky(const std::string& text, const std::vector<std::string>& sets = {}) {
  return parse_case(text, "case.toml", sets);
}

}  // namespace

TEST_CASE("the range of adhesion follows from the grid, so that three segments part at a time") {
  const Case c = parse_sticky(sticky);
  const std::vector<PairAdhesion> pairs = adhesion_of(c);
  REQUIRE(pairs.size() == 1);  // walls do not attract
  CHECK(pairs.front().kind == 0);
  CHECK(pairs.front().other == 0);
  CHECK(pairs.front().law.surface_energy == 0.04);
  const double E_star = 1e6 / (1 - 0.09) / 2, segment = pi * 2e-3 / 32, sigma = pairs.front().law.strength();
  CHECK(pi / 4 * E_star * 0.04 / (sigma * sigma) == doctest::Approx(3 * segment));
  CHECK(advise_on_adhesion(c).zone == doctest::Approx(3));
  CHECK(advise_on_adhesion(c).reach == doctest::Approx(0.5e-3 / pairs.front().law.range));

  const Case given =
      parse_sticky(sticky, {"contact.adhesion_range=2 um", "contact.wall_surface_energy=0.01"});
  REQUIRE(adhesion_of(given).size() == 2);
  for (const PairAdhesion& pair : adhesion_of(given)) CHECK(pair.law.range == 2e-6);
  CHECK(advise_on_adhesion(given).zone < 1);
  CHECK(std::isinf(advise_on_adhesion(parse_sticky(sticky, {"contact.surface_energy=0"})).zone));
}

TEST_CASE("pairs of kinds adhere as their tables say, others as the table of contact does") {
  const Case c = parse_sticky(sticky + kinds);
  const auto law_of = [&](int kind, int other) {
    for (const PairAdhesion& pair : adhesion_of(c))
      if (pair.kind == kind && pair.other == other) return pair.law;
    return Adhesion{};
  };
  CHECK(law_of(0, 0).surface_energy == 0.04);
  CHECK(law_of(1, 0).surface_energy == 0.2);
  CHECK(law_of(1, 0).range == 3e-6);
  CHECK(law_of(0, PairAdhesion::wall).surface_energy == 0.1);
  CHECK_FALSE(law_of(1, PairAdhesion::wall).any());
  CHECK_FALSE(law_of(1, 1).any());
  const Case again = parse_sticky(resolved_case_text(c));
  CHECK(resolved_case_text(again) == resolved_case_text(c));
  CHECK(adhesion_of(again).size() == adhesion_of(c).size());
}

TEST_CASE("of one kind a pair says what the table of contact says") {
  const Case c = parse_sticky(
      "[experiment]\nloading = 'compaction'\nmodel = 'mpm'\n[[kind]]\nname = 'a'\n[[pair]]\nbetween = ['a', "
      "'wall']\nsurface_energy = '1 J/m^2'\nadhesion_range = '5 um'\n");
  CHECK(c.contact.wall_surface_energy == 1);
  CHECK(c.contact.surface_energy == 0);
  CHECK(c.contact.adhesion_range == 5e-6);
}

TEST_CASE("a surface energy below zero is refused with its place and unit") {
  CHECK(mentions(refusal(sticky + "wall_surface_energy = '-1 J/m^2'\n"),
                 "case.toml:13:23: error: contact.wall_surface_energy = "));
  CHECK(mentions(refusal(sticky + "wall_surface_energy = '1 MPa'\n"), "a force per length"));
  CHECK(mentions(refusal(sticky + kinds + "adhesion_range = '-1 um'\n"), "pair.adhesion_range = "));
}
