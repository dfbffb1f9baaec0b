#include "softgrain/io/schema.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/experiment/bpm_step.hpp"
#include "softgrain/experiment/estimate.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

using namespace scope;

Allowed anything() { return {}; }
Allowed positive() { return {.range = {.low = 0, .without_low = true}}; }
Allowed at_least(double low) { return {.range = {.low = low}}; }
Allowed from_to(double low, double high) { return {.range = {.low = low, .high = high}}; }
Allowed between(double low, double high) {
  return {.range = {.low = low, .high = high, .without_low = true, .without_high = true}};
}
Allowed one_of(std::vector<std::string> words) { return {.words = std::move(words)}; }

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const LawChoice& choice : law_choices()) names.emplace_back(choice.name);
  return names;
}

// clang-format off
// A key's name and its place in Case from the same words. The last argument is its scope: none for everywhere.
#define KEY(member, ...) Key{#member, +[](Case& c) -> auto& { return c.member; }, __VA_ARGS__}

std::vector<Key> all_keys() {
  return {
      KEY(experiment.loading, "", one_of({"diametral", "compaction", "isotropic"}),
          "the loading path; diametral: one grain between two plates, the top one moves; compaction: grains in a box "
          "whose lid comes down; isotropic: the same, all four walls come in"),
      KEY(experiment.model, "", one_of({"bpm", "mpm"}),
          "how a grain is modelled; bpm: an aggregate of rigid primary particles that attract each other; mpm: an "
          "elastic body by the material point method"),

      KEY(grain.radius, "mm", positive(), "radius R of the grain", between_plates),
      KEY(grain.density, "kg/m^3", positive(), "density rho; the grain weighs rho pi R^2 per metre of depth"),

      KEY(bpm.primaries, "", from_to(fewest_primaries, 1e6),
          "number of primary particles in a grain; in a box: in each, or in the smallest (bpm.equal)", with_bpm),
      KEY(bpm.size_ratio, "", from_to(1, largest_size_ratio), "largest over smallest primary diameter", with_bpm),
      KEY(bpm.attraction, "N/m", positive(),
          "attraction F0 between touching primaries of the grain, per metre of depth (diametral)", bpm_between_plates),
      KEY(bpm.cohesive_pressure, "MPa", positive(),
          "internal cohesive pressure sigma_I = F0/<a0>, the same in all grains: F0 follows the size of their "
          "primaries (in a box)", bpm_in_a_box),
      KEY(bpm.exponent, "", at_least(1),
          "exponent gamma of F0 (a0/r)^gamma, r the distance of the centres, a0 the sum of the radii", with_bpm),

      KEY(bpm.inner_friction, "", at_least(0), "coefficient of friction mu between the primaries of a grain (in a box)", bpm_in_a_box),
      KEY(bpm.equal, "", one_of({"count", "size"}),
          "what all grains share: the number of primaries, or, to about 5 %, their size (in a box)", bpm_in_a_box),
      KEY(bpm.library, "", from_to(1, 1000), "different aggregates of which the grains are copies (in a box)", bpm_in_a_box),

      KEY(mpm.law, "", one_of(law_names()), "elastic law", with_mpm),
      KEY(mpm.young_modulus, "MPa", positive(), "Young's modulus E", with_mpm),
      KEY(mpm.poisson_ratio, "", between(-1, 0.5), "Poisson's ratio nu", with_mpm),
      KEY(mpm.cells, "", from_to(2, 200), "cells along a side of the grid's inner square; a grain has 14 cells^2 points", with_mpm),
      KEY(mpm.integrator, "", one_of({"implicit", "explicit"}), "backward Euler, or symplectic Euler with lumped masses", total_lagrangian),
      KEY(mpm.formulation, "", one_of({"total_lagrangian", "updated_lagrangian"}),
          "total_lagrangian: on a grid that fits the grain; updated_lagrangian: points move through a lattice that is "
          "reset in each step, always explicit, for comparison (diametral)", with_mpm),
      KEY(mpm.shape_functions, "", one_of({"bilinear", "gimp", "bspline"}), "of the lattice (updated_lagrangian)", updated_lagrangian),
      KEY(mpm.contact_on, "", one_of({"outline", "grid_nodes"}),
          "where contact acts; total_lagrangian: on the outline only", updated_lagrangian),
      KEY(mpm.time_step, "us", at_least(0),
          "time step; 0: the plate moves 1 % of the smallest radius (implicit), or a stable step (explicit, which "
          "divides steps while cells need it, and refuses a longer one than is stable at the start)", with_mpm),
      KEY(mpm.damping, "1/s", at_least(0),
          "rate zeta of the damping f = -zeta m (v - v_walls), v_walls the velocity that the walls give to what lies "
          "between them; 0: none; a free grain slows down by exp(-zeta t)", with_mpm),
      KEY(mpm.tolerance, "", positive(), "largest last correction of Newton's method over the mean grain radius", implicit),

      KEY(contact.friction, "", at_least(0),
          "coefficient of friction mu between grains; diametral test of a bpm grain: between its primaries", with_pairs),
      KEY(contact.wall_friction, "", at_least(0), "coefficient of friction mu against walls"),
      KEY(contact.restitution, "", from_to(0, 1), "Newton's coefficient of restitution e_n", with_bpm),
      KEY(contact.activation, "", one_of({"anticipated", "closed_at_mid_step", "closed_at_end_of_step"}),
          "when a contact is active: always, so that it may close within the step; or when it is closed at mid-step, or "
          "will be at the end of the step", with_bpm),
      KEY(contact.push_out, "", from_to(0, 1), "share beta of an existing overlap that is removed in a step", with_bpm),

      KEY(solver.min_sweeps, "", at_least(1), "sweeps of the contact solver in every step", with_bpm),
      KEY(solver.max_sweeps, "", at_least(1), "sweeps after which a step counts as not converged", with_bpm),
      KEY(solver.tolerance, "", positive(),
          "converged: mean penetration gained in a step over the mean primary diameter is below this", with_bpm),
      KEY(solver.relaxation, "", between(0, 2), "over-relaxation omega of a sweep; 1 is plain Gauss-Seidel", with_bpm),
      KEY(solver.precision, "", one_of({"single", "double"}),
          "of impulses and velocities within the sweeps of a bpm step; double for tolerances below 1e-11", with_bpm),

      KEY(loading.wall_velocity, "m/s", positive(), "velocity of the top plate; isotropic: of opposite walls towards each other, half by each"),
      KEY(loading.max_strain, "", between(0, 3),
          "strain at the end: eps = -ln(1 - d/R), d half the travel of the plate; in a box: eps = ln(h_start/h)"),
      KEY(loading.max_packing_fraction, "", from_to(0, 2),
          "packing fraction Phi_0 of the undeformed grains at the end, if max_strain comes later; 0: none (in a box)", in_a_box),
      KEY(loading.max_stress, "MPa", at_least(0),
          "vertical stress at the end, mean of lid and bottom over 0.1 % of strain; 0: none (in a box)", in_a_box),
      KEY(loading.max_overlap, "", from_to(0, 0.05),
          "mean overlap of primaries in contact, over their mean radius, at the end; 0: none (bpm in a box)", bpm_in_a_box),
      KEY(loading.unload_at, "", positive(),
          "ascending strains at which the plate turns back once; [] for none"),
      KEY(loading.unload_by, "", positive(), "strain given back before loading again", with_unloading),
      KEY(loading.hold, "us", at_least(0), "rest of the plate wherever it turns, and at the end"),
      KEY(loading.hold_stress, "MPa", at_least(0),
          "vertical stress at which the walls leave their path: they keep it for loading.hold, which ends the run; 0: none "
          "(in a box)", in_a_box),

      KEY(time.step, "us", at_least(0),
          "time step dt (bpm); 0: stable step, a 43rd of the period of the bonds between the smallest primaries", with_bpm),

      KEY(sample.seed, "", at_least(0),
          "seed of the random numbers; another seed is another sample of the same grain", with_chance),
      KEY(sample.grains, "", from_to(1, 1e6), "grains in the box", in_a_box),
      KEY(sample.packing_fraction, "", between(0, 0.8), "undeformed grain area over box area at the start", in_a_box),
      KEY(sample.aspect, "", from_to(0.01, 100), "width over height of the box at the start", in_a_box),
      KEY(sample.smallest_diameter, "mm", positive(), "of the grains in the box, uniform between", in_a_box),
      KEY(sample.largest_diameter, "mm", positive(), "of the grains in the box", in_a_box),

      KEY(output.samples, "", from_to(1, 1e6), "rows of series.csv, evenly over the run"),
      KEY(output.snapshots, "", from_to(0, 1e5), "restart points, evenly over the run"),
      KEY(output.vtk, "", anything(), "write .vtp files for ParaView beside the snapshots"),
      KEY(output.report, "", anything(), "write report.html, a page to look at in a browser, when the run is done"),
  };
}

std::vector<TableOfKeys> all_tables() {
  return {
      {"experiment", "What is done, and with which model of a grain."},
      {"grain", "The soft grain."},
      {"bpm", "Bonded particle model: the primary particles of a grain."},
      {"mpm", "Material point method: the elastic material and its grid."},
      {"contact", "Laws of contact."},
      {"solver", "The contact solver: nonlinear Gauss-Seidel."},
      {"loading", "What the plates do."},
      {"time", "Time stepping."},
      {"sample", "The initial state."},
      {"output", "What is written."},
  };
}
// clang-format on
#undef KEY

std::string unloading_not_ascending(const Case& c) {
  const auto& strains = c.loading.unload_at;
  const auto turn = std::adjacent_find(strains.begin(), strains.end(), std::greater_equal<>{});
  if (turn == strains.end()) return "";
  return fmt::format("loading.unload_at must be ascending: {} stands before {}", *turn, *(turn + 1));
}

std::string unloading_after_the_end(const Case& c) {
  const auto& strains = c.loading.unload_at;
  const auto late =
      std::find_if(strains.begin(), strains.end(), [&](double eps) { return eps >= c.loading.max_strain; });
  if (late == strains.end()) return "";
  return fmt::format("loading.unload_at must be below loading.max_strain: {} is not below {}", *late,
                     c.loading.max_strain);
}

std::string unloading_below_zero(const Case& c) {
  const auto& strains = c.loading.unload_at;
  if (strains.empty() || c.loading.unload_by < strains.front()) return "";
  return fmt::format("loading.unload_by must be below the first of loading.unload_at: {} is not below {}",
                     c.loading.unload_by, strains.front());
}

std::string sweeps_reversed(const Case& c) {
  if (c.solver.min_sweeps <= c.solver.max_sweeps) return "";
  return fmt::format("solver.min_sweeps must not be above solver.max_sweeps: {} is above {}",
                     c.solver.min_sweeps, c.solver.max_sweeps);
}

std::string restitution_anticipated(const Case& c) {
  if (c.experiment.model != "bpm" || c.contact.restitution == 0 || c.contact.activation != "anticipated")
    return "";
  return fmt::format(
      "contact.restitution {} needs contact.activation \"closed_at_mid_step\" or \"closed_at_end_of_step\": "
      "anticipated contacts stop the particles before they touch",
      c.contact.restitution);
}

std::string diameters_reversed(const Case& c) {
  if (c.sample.smallest_diameter <= c.sample.largest_diameter) return "";
  return fmt::format("sample.smallest_diameter must not be above sample.largest_diameter: {} m is above {} m",
                     c.sample.smallest_diameter, c.sample.largest_diameter);
}

std::string too_many_steps(const Case& c) {
  constexpr double most = 1e12;
  const double steps = estimate(c).steps;
  if (steps <= most) return "";
  return fmt::format("about {:.1g} time steps are too many: raise the time step or loading.wall_velocity",
                     steps);
}

std::string too_dense_from_the_start(const Case& c) {
  const double last = c.loading.max_packing_fraction;
  if (c.experiment.loading == "diametral" || last == 0 || last > c.sample.packing_fraction) return "";
  return fmt::format("loading.max_packing_fraction must be above sample.packing_fraction: {} is not above {}",
                     last, c.sample.packing_fraction);
}

std::string cannot_hold_a_stress(const Case& c) {
  if (c.loading.hold_stress == 0) return "";
  if (c.experiment.loading == "diametral")
    return "loading.hold_stress needs a box: experiment.loading \"compaction\" or \"isotropic\"";
  return c.loading.hold > 0 ? "" : "loading.hold_stress needs loading.hold > 0: for how long";
}

std::string formulation_cannot(const Case& c) {
  const bool updated = c.mpm.formulation == "updated_lagrangian";
  if (c.experiment.model != "mpm") return "";
  if (updated && c.experiment.loading != "diametral")
    return fmt::format(
        "mpm.formulation \"updated_lagrangian\" needs experiment.loading \"diametral\", not \"{}\"",
        c.experiment.loading);
  if (!updated && c.mpm.contact_on != "outline")
    return fmt::format("mpm.contact_on \"{}\" needs mpm.formulation \"updated_lagrangian\"",
                       c.mpm.contact_on);
  return "";
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = without_low ? value > low : value >= low;
  const bool below = without_high ? value < high : value <= high;
  return above && below;
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high)
    return fmt::format("in {}{}, {}{}", without_low ? '(' : '[', low, high, without_high ? ')' : ']');
  if (has_low) return fmt::format("{} {}", without_low ? ">" : ">=", low);
  if (has_high) return fmt::format("{} {}", without_high ? "<" : "<=", high);
  return "";
}

const std::vector<Key>& case_keys() {
  static const std::vector<Key> keys = all_keys();
  return keys;
}

const std::vector<TableOfKeys>& case_tables() {
  static const std::vector<TableOfKeys> tables = all_tables();
  return tables;
}

const std::vector<Relation>& case_relations() {
  static const std::vector<Relation> relations{
      {{"loading.unload_at"}, unloading_not_ascending},
      {{"loading.unload_at", "loading.max_strain"}, unloading_after_the_end},
      {{"loading.unload_by", "loading.unload_at"}, unloading_below_zero},
      {{"solver.min_sweeps", "solver.max_sweeps"}, sweeps_reversed},
      {{"sample.smallest_diameter", "sample.largest_diameter"}, diameters_reversed},
      {{"time.step"}, bond_step_too_long},
      {{"contact.restitution", "contact.activation"}, restitution_anticipated},
      {{"time.step", "mpm.time_step", "loading.wall_velocity", "loading.max_strain", "grain.radius",
        "grain.density", "bpm.attraction", "bpm.cohesive_pressure", "bpm.primaries", "bpm.size_ratio",
        "bpm.exponent", "sample.smallest_diameter"},
       too_many_steps},
      {{"mpm.formulation", "mpm.contact_on", "experiment.loading"}, formulation_cannot},
      {{"loading.max_packing_fraction", "sample.packing_fraction"}, too_dense_from_the_start},
      {{"loading.hold_stress", "loading.hold", "experiment.loading"}, cannot_hold_a_stress},
  };
  return relations;
}

const Key* find_key(std::string_view name) {
  for (const Key& key : case_keys())
    if (key.name == name) return &key;
  return nullptr;
}

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const Key& key : case_keys()) names.push_back(key.name);
  return names;
}

}  // namespace softgrain
