#include <doctest/doctest.h>

#include "reliability/tiny_cases.hpp"

using namespace softgrain::test;

namespace {

/// The same last state, bit for bit, and the same rows but for the wall time.
bool same_runs(const Workshop& workshop, const std::string& a, const std::string& b) {
  return workshop.last_hash(a) == workshop.last_hash(b) && workshop.series(a) == workshop.series(b);
}

/// The run "whole", cut off after the first `kept` snapshots and resumed, ends as it did: kept = first ..
/// end - 1.
void check_resumed_from(const Workshop& workshop, std::size_t first, std::size_t end) {
  for (std::size_t kept = first; kept < end; ++kept) {
    const std::string part = "part" + std::to_string(kept);
    CAPTURE(part);
    copy_cut_off(workshop, "whole", part, kept);
    CHECK(workshop.softgrain({"resume", part, "-q", "-j", "3"}).exit_code == 0);
    CHECK(same_runs(workshop, part, "whole"));
  }
}

}  // namespace

TEST_CASE(
    "whatever the case, a run cut off at any snapshot and resumed is the run that was not, to the bit") {
  for (const TinyCase& tiny : tiny_cases()) {
    const Workshop workshop;
    CAPTURE(tiny.name);
    const ProcessResult whole = run_tiny(workshop, tiny, "whole", {"-j", "1"});
    CAPTURE(whole.err);
    REQUIRE(whole.exit_code == 0);
    const std::size_t snapshots = workshop.snapshots("whole").size();
    REQUIRE(snapshots == 7 + tiny.turns);  // the first state, six even shares of the run, and the turns
    // five and six: one is the state at a turn, the other in the middle of unloading; of an example
    // the latter alone
    const std::size_t first = tiny.source.starts_with('/') ? 6 : 5;
    check_resumed_from(workshop, torture() ? 1 : first, torture() ? snapshots : 7);
  }
}

TEST_CASE("a run whose stages set friction, tolerance and damping goes on from any snapshot, to the bit") {
  for (const std::string model : {"mpm", "bpm"}) {
    CAPTURE(model);
    const Workshop workshop;
    const std::string set =
        model == "mpm" ? "mpm = { damping = 100, tolerance = 1e-5 }" : "solver.tolerance = 1e-6";
    workshop.file("case.toml",
                  "[experiment]\nmodel = '" + model +
                      "'\n[sample]\ngrains = 6\npacking_fraction = 0.62\n[bpm]\nprimaries = "
                      "25\nlibrary = 1\n[mpm]\ncells = 4\n[output]\nsamples = 20\nsnapshots = "
                      "6\nreport = false\n[[stage]]\nyy = { velocity = '5 m/s' }\nuntil.strain = "
                      "0.25\n[[stage]]\nyy = { velocity = '5 m/s' }\nuntil.strain = 0.3\nset = { "
                      "contact.friction = 0.3, contact.wall_friction = 0.2, " +
                      set +
                      " }\n[[stage]]\nyy = { velocity = '-5 m/s' }\nuntil.strain = 0.28\nset = { "
                      "contact.friction = 0 }\n");
    const ProcessResult whole = workshop.softgrain({"run", "case.toml", "-q", "-o", "whole", "-j", "1"});
    CAPTURE(whole.err);
    REQUIRE(whole.exit_code == 0);
    const std::size_t snapshots = workshop.snapshots("whole").size();
    REQUIRE(snapshots == 9);
    check_resumed_from(workshop, 1, snapshots);
  }
}

TEST_CASE(
    "kinds of which one flows and one does not go on from any snapshot, and on any threads, to the bit") {
  for (const std::string integrator : {"implicit", "explicit"}) {
    CAPTURE(integrator);
    const Workshop workshop;
    workshop.file(
        "case.toml",
        "[experiment]\nmodel = 'mpm'\nloading = 'compaction'\n[mpm]\ncells = 4\nintegrator = '" + integrator +
            "'\n[sample]\npacking_fraction = 0.62\n[contact]\nfriction = 0.2\n[loading]\nwall_velocity = '5 "
            "m/s'\nmax_strain = 0.3\n[output]\nsamples = 20\nsnapshots = 4\nreport = false\n[[kind]]\nname = "
            "'rubber'\nnumber = 4\nlaw.young_modulus = '10 MPa'\n[[kind]]\nname = 'lead'\nnumber = "
            "5\ndensity "
            "= 4000\nlaw = { name = 'von_mises', young_modulus = '50 MPa', yield_stress = '1 MPa' "
            "}\n[[pair]]\n"
            "between = ['lead', 'rubber']\nfriction = 0.5\n");
    const ProcessResult whole = workshop.softgrain({"run", "case.toml", "-q", "-o", "whole", "-j", "1"});
    CAPTURE(whole.err);
    REQUIRE(whole.exit_code == 0);
    CHECK(workshop.softgrain({"run", "case.toml", "-q", "-o", "on4", "-j", "4"}).exit_code == 0);
    CHECK(same_runs(workshop, "on4", "whole"));
    const std::size_t snapshots = workshop.snapshots("whole").size();
    REQUIRE(snapshots >= 4);
    check_resumed_from(workshop, 1, snapshots);
  }
}

TEST_CASE("a run that stops wherever its time is up and goes on, many times, is the run that did not") {
  for (const std::string name : {"diametral-bpm", "compaction-mpm"}) {
    CAPTURE(name);
    const Workshop workshop;
    const TinyCase tiny{name, name, tiny_settings(name)};
    REQUIRE(run_tiny(workshop, tiny, "whole").exit_code == 0);
    const Words stop{"--stop-after", "0.02 s"};
    CHECK(run_tiny(workshop, tiny, "parts", stop).exit_code == 75);
    for (int part = 0; part < repeats(5, 50); ++part)
      workshop.softgrain({"resume", "parts", "-q", stop[0], stop[1]});
    CHECK(workshop.softgrain({"resume", "parts", "-q"}).exit_code == 0);
    CHECK(same_runs(workshop, "parts", "whole"));
  }
}

TEST_CASE("the number of threads changes no bit of a result, with friction, in both models") {
  for (const TinyCase& tiny : tiny_cases()) {
    if (tiny.source.starts_with('/')) continue;  // an example: its model is among the templates
    const Workshop workshop;
    CAPTURE(tiny.name);
    REQUIRE(run_tiny(workshop, tiny, "one", {"-j", "1"}).exit_code == 0);
    for (const std::string& threads : torture() ? Words{"2", "3", "4", "8"} : Words{"4"}) {
      CAPTURE(threads);
      REQUIRE(run_tiny(workshop, tiny, "on" + threads, {"-j", threads}).exit_code == 0);
      CHECK(same_runs(workshop, "on" + threads, "one"));
    }
  }
}
