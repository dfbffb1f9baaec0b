#include "softgrain/io/case/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgrain/bpm/aggregate.hpp"
#include "softgrain/io/case/words.hpp"
#include "softgrain/material/any_law.hpp"

namespace softgrain {
namespace {

using namespace scope;

Range anything() { return {}; }
Range its_words() { return {}; }
Range positive() { return {.low = 0, .without_low = true}; }
Range positive_up_to(double high) { return {.low = 0, .high = high, .without_low = true}; }
Range at_least(double low) { return {.low = low}; }
Range from_to(double low, double high) { return {.low = low, .high = high}; }
Range between(double low, double high) {
  return {.low = low, .high = high, .without_low = true, .without_high = true};
}

template <class Enum>
WordMember words_in(std::string_view (*word)(const Case&), bool (*assign)(Case&, std::string_view)) {
  return {[] {
            std::vector<std::string> words;
            for (const Word<Enum>& entry : words_of<Enum>()) words.emplace_back(entry.word);
            return words;
          },
          word, assign};
}

/// What leads from a case to a value of it; to an enum through its words.
template <class Place>
Member member_of(Place place) {
  using T = std::decay_t<decltype(place(std::declval<Case&>()))>;
  if constexpr (std::is_enum_v<T>) {
    return words_in<T>([](const Case& c) { return word_of(Place{}(c)); },
                       [](Case& c, std::string_view word) {
                         const std::optional<T> value = value_of<T>(word);
                         if (value) Place{}(c) = *value;
                         return value.has_value();
                       });
  } else {
    return MemberOf<T>(place);
  }
}

// clang-format off
// A key's name and its place in Case from the same words. The last argument is its scope: none for everywhere.
#define KEY(member, ...) Key{#member, member_of([](auto& c) -> auto& { return c.member; }), __VA_ARGS__}

std::vector<Key> all_keys() {
  return {
      KEY(experiment.loading, "", its_words(),
          "the loading path (docs/guide/loading.md); diametral: one grain between two walls, the top one moves; the others: "
          "grains in a box; biaxial in the plane, triaxial in space; stages: what the tables [[stage]] say, as where they stand alone"),
      KEY(experiment.model, "", its_words(),
          "how a grain is modelled; bpm: an aggregate of rigid primary particles that attract each other; mpm: an "
          "elastic body by the material point method; rigid: a rigid body, which meets others as those of mpm do"),
      KEY(experiment.dimension, "", from_to(2, 3),
          "of space; 2: disks, everything per metre of depth; 3: spheres, not yet with all the rest "
          "(docs/guide/three-dimensions.md)"),

      KEY(grain.radius, "mm", positive(), "radius R of the grain", between_walls),
      KEY(grain.density, "kg/m^3", positive(), "density rho; the grain weighs rho pi R^2 per metre of depth"),
      KEY(grain.shape, "", its_words(), "of the undeformed grain; all but a disk lie in the circle of the grain's diameter, about their centre of area; left out: outline or surface where one is given", with_outlines),
      KEY(grain.aspect, "", from_to(1, 20), "long over short axis of an ellipse; of an elastic one at most 10", ellipses),
      KEY(grain.sides, "", from_to(3, 100), "of a regular polygon, at most 4 mpm.cells", polygons),
      KEY(grain.outline, "", anything(), "of the shape outline: a CSV file with the columns x, y, corner (below), from the folder of the case file; or its points [x, y], at a corner [x, y, 1]", outlines),
      KEY(grain.surface, "", anything(), "of rigid grains in space, a closed surface that is seen from its centre of mass: an STL or PLY file beside the case file; or vertices [x, y, z] and triangles [i, j, k], as [[...], [...]]", surfaces),
      KEY(grain.angle, "deg", anything(), "by which one grain between two walls is turned, counter-clockwise; an ellipse lies along x, a polygon has a corner there", turned),

      KEY(bpm.primaries, "", from_to(fewest_primaries, 1e6),
          "number of primary particles in a grain; in a box: in each, or in the smallest (bpm.equal)", with_bpm),
      KEY(bpm.size_ratio, "", from_to(1, largest_size_ratio), "largest over smallest primary diameter", with_bpm),
      KEY(bpm.attraction, "N/m", positive(),
          "attraction F0 between touching primaries of the grain, per metre of depth (diametral)", bpm_between_walls_in_plane),
      KEY(bpm.force, "N", positive(), "the same attraction F0 in space (diametral)", bpm_between_walls_in_space),
      KEY(bpm.cohesive_pressure, "MPa", positive(),
          "internal cohesive pressure sigma_I = F0/<a0>, in space F0/<a0>^2, the same in all grains: F0 follows the size of their "
          "primaries (in a box)", bpm_in_a_box),
      KEY(bpm.exponent, "", at_least(1),
          "exponent gamma of F0 (a0/r)^gamma, r the distance of the centres, a0 the sum of the radii", with_bpm),
      KEY(bpm.inner_friction, "", at_least(0), "coefficient of friction mu between the primaries of a grain", with_bpm),
      KEY(bpm.equal, "", its_words(),
          "what all grains share: the number of primaries, or, to about 5 %, their size (in a box)", bpm_in_a_box),
      KEY(bpm.library, "", from_to(1, 1000), "different aggregates of which the grains are copies (in a box)", bpm_in_a_box),

      KEY(mpm.law, "", its_words(), "law of the material", with_mpm),
      KEY(mpm.cells, "", from_to(2, 200), "cells along a side of the grid's inner square; a grain has 14 cells^2 points and 4 cells vertices, a rigid one the vertices alone; in space: of the inner cube, 32 cells^3 points, 6 where left out", with_outlines),
      KEY(mpm.integrator, "", its_words(), "backward Euler, or symplectic Euler with lumped masses; in space explicit, also where it is left out", total_lagrangian),
      KEY(mpm.formulation, "", its_words(),
          "total_lagrangian: on a grid that fits the grain; updated_lagrangian: points move through a lattice that is "
          "reset in each step, for comparison, between walls that no stress moves", with_mpm),
      KEY(mpm.lattice_integrator, "", its_words(),
          "of the lattice (updated_lagrangian): symplectic Euler, or backward Euler on its nodes, as in the paper", updated_lagrangian),
      KEY(mpm.shape_functions, "", its_words(), "of the lattice (updated_lagrangian)", updated_lagrangian),
      KEY(mpm.contact_on, "", its_words(),
          "where contact acts; total_lagrangian: on the outline only", updated_lagrangian),
      KEY(mpm.damping, "1/s", at_least(0),
          "rate zeta of the damping f = -zeta m (v - v_walls), v_walls the velocity that the walls give to what lies "
          "between them; 0: none; a free grain slows down by exp(-zeta t)", with_outlines),
      KEY(mpm.tolerance, "", positive_up_to(0.01), "largest last correction of Newton's method over the mean grain radius", implicit),

      KEY(contact.friction, "", at_least(0),
          "coefficient of friction mu between grains; never inside one: bpm.inner_friction", with_pairs),
      KEY(contact.wall_friction, "", at_least(0), "coefficient of friction mu against walls"),
      KEY(contact.surface_energy, "J/m^2", at_least(0),
          "surface energy w of adhesion between grains: what it takes to part a unit of their surface; bpm: of the face that each pair of primaries stands for, as wide as the two radii together; 0: they do not adhere", adhering_pairs),
      KEY(contact.wall_surface_energy, "J/m^2", at_least(0), "the same between grains and walls", adhering),
      KEY(contact.adhesion_range, "um", at_least(0),
          "gap delta up to which surfaces that adhere attract each other, by a stress that falls from 2 w/delta to 0; auto: "
          "so that the zone of parting spans three vertices; bpm: a quarter of the mean distance of primaries", adhering, "auto"),
      KEY(contact.restitution, "", from_to(0, 1), "Newton's coefficient of restitution e_n", with_bpm),
      KEY(contact.activation, "", its_words(),
          "when a contact is active: always, so that it may close within the step; or when it is closed at mid-step, or "
          "will be at the end of the step", with_bpm),
      KEY(contact.push_out, "", from_to(0, 1), "share beta of an existing overlap that is removed in a step", with_bpm),

      KEY(solver.min_sweeps, "", at_least(1), "sweeps of the contact solver in every step", with_bpm),
      KEY(solver.max_sweeps, "", at_least(1), "sweeps after which a step counts as not converged", with_bpm),
      KEY(solver.tolerance, "", positive(),
          "converged: mean overlap gained in a step over the mean primary diameter is below this", with_bpm),
      KEY(solver.relaxation, "", between(0, 2), "over-relaxation omega of a sweep; 1 is plain Gauss-Seidel", with_bpm),
      KEY(solver.precision, "", its_words(),
          "of impulses and velocities within the sweeps of a bpm step; double for tolerances below 1e-11", with_bpm),

      KEY(loading.wall_velocity, "m/s", positive(), "velocity of the top wall; isotropic, biaxial, triaxial: of opposite walls towards each other, half by each; of walls that keep a stress: at most; stages: left out, the fastest of theirs; quasi-static: as loading.inertial_number says", everywhere, "quasi-static"),
      KEY(loading.max_strain, "", between(0, 3),
          "strain at the end: eps = -ln(1 - d/R), d half the travel of the wall; in a box: eps = ln(h_start/h); die: at "
          "which max_stress must be reached", with_short_path),
      KEY(loading.max_packing_fraction, "", from_to(0, 2),
          "packing fraction Phi_0 of the undeformed grains at the end, if max_strain comes later; 0: none (in a box)", to_a_fraction),
      KEY(loading.max_stress, "MPa", at_least(0),
          "vertical stress at the end, mean of top and bottom over 0.1 % of strain; 0: none; die: of the top wall, which "
          "then keeps it for loading.hold (in a box)", to_a_stress),
      KEY(loading.max_overlap, "", from_to(0, 0.05),
          "mean overlap of primaries in contact, over their mean radius, at the end; 0: none (bpm in a box)", bpm_to_an_overlap),
      KEY(loading.unload_at, "", positive(),
          "ascending strains at which the wall turns back once; [] for none", turning),
      KEY(loading.unload_by, "", positive(), "strain given back before loading again", with_unloading),
      KEY(loading.hold, "us", at_least(0), "rest of the wall wherever it turns, and at the end; biaxial, triaxial, die: for which the stress is kept before it goes on; die: of the rest after ejection too; relaxation: of the rest", with_short_path),
      KEY(loading.hold_stress, "MPa", at_least(0),
          "vertical stress at which the walls leave their path: those that move keep it for loading.hold, which ends the run; "
          "isotropic: xx and yy each, in space zz too; 0: none (in a box)", packing_turning),
      KEY(loading.confining_stress, "MPa", at_least(0), "that the side walls keep (biaxial, triaxial), that the periodic cell keeps (shear)", confining),
      KEY(loading.shear_rate, "1/s", positive(), "of the shear strain; quasi-static: as loading.inertial_number says (shear)", shearing, "quasi-static"),
      KEY(loading.inertial_number, "", positive(),
          "I of a speed or rate that is \"quasi-static\", at the stress that the loading names, in a box a hundredth of "
          "the grains' own where it names none; one grain: at its own: E, the yield stress or sigma_I", quasi_static),
      KEY(loading.max_shear, "", positive(), "shear strain at the end (shear)", shearing),
      KEY(loading.rest, "", at_least(0), "kinetic over stored energy, below which the rest ends before loading.hold is over; 0: none (relaxation)", relaxing),
      KEY(loading.eject, "", anything(), "whether the side walls go apart after unloading until they bear nothing, then the top wall again, and all rest for loading.hold (die)", die),

      KEY(time.step, "us", at_least(0),
          "time step dt; auto: bpm: a 43rd of the period of the bonds between the smallest primaries; implicit mpm: the "
          "wall moves 1 % of the smallest radius; explicit mpm: a stable step, which is divided while cells need it", everywhere, "auto"),

      KEY(sample.seed, "", at_least(0), "seed of the random numbers; another seed is another sample of the same grain", with_chance),
      KEY(sample.places, "", its_words(), "of the grains at the start; pour: as they lie after a fall along -y into a box of the width that packing_fraction and aspect mean", random),
      KEY(sample.grains, "", from_to(1, 1e6), "grains in the box", random),
      KEY(sample.packing_fraction, "", between(0, 1), "undeformed grain area (volume in space) over that of the box at the start, below 0.8", random),
      KEY(sample.aspect, "", from_to(1e-4, 1e4), "width over height of the box at the start; in space its base is a square", random),
      KEY(sample.sizes, "", its_words(),
          "law of the diameters, by number of grains; uniform between smallest and largest; lognormal with a median, cut "
          "off below smallest and above largest; list: sample.diameters; left out: list where diameters are given, lognormal "
          "where a median is", random),
      KEY(sample.smallest_diameter, "mm", positive(), "of the grains in the box, or lower cut-off", random_between),
      KEY(sample.largest_diameter, "mm", positive(), "of the grains in the box, or upper cut-off", random_between),
      KEY(sample.median_diameter, "mm", positive(), "median of lognormal sizes before they are cut off", lognormal),
      KEY(sample.deviation, "", between(0, 3), "standard deviation of ln d of lognormal sizes before they are cut off", lognormal),
      KEY(sample.diameters, "mm", positive(), "diameters of the list", listed),
      KEY(sample.shares, "", positive(), "share of the grains' area that each diameter of the list has, in proportion", listed),
      KEY(sample.numbers, "", positive(),
          "how many grains have each diameter of the list, in proportion; neither shares nor numbers: as many of each", listed),
      KEY(sample.placed, "", anything(),
          "the grains in their places, [x, y, radius, angle] of each in m and rad, and the number of its kind but 0: what a run writes for sample.file", placed),
      KEY(sample.placed_z, "m", anything(), "z of each of sample.placed in space", placed_in_space),
      KEY(box.x, "", its_words(), "what ends the box along x: walls, or its own image", in_a_box),
      KEY(box.y, "", its_words(), "the same along y; periodic only if x is", in_a_box),
      KEY(box.z, "", its_words(), "the same along z in space; periodic only if x and y are", box_in_space),
      KEY(box.gravity_x, "m/s^2", anything(), "acceleration of gravity along x", in_a_box),
      KEY(box.gravity_y, "m/s^2", anything(), "the same along y: -9.81 m/s^2 pulls down, in space sideways", in_a_box),
      KEY(box.gravity_z, "m/s^2", anything(), "the same along z, upwards in space", box_in_space),
      KEY(box.open_top, "", anything(),
          "the box has no top wall until a stage moves `top` or `yy`; so long its height is that of the highest grain", with_stages),
      KEY(box.width, "mm", at_least(0), "of the box of placed grains; auto: from the first to the last point of all grains", placed, "auto"),
      KEY(box.height, "mm", at_least(0), "of the box of placed grains; auto: from the lowest to the highest point of all grains", placed, "auto"),
      KEY(box.depth, "mm", at_least(0), "of the box of placed spheres along y; auto: as far as the grains reach", placed_in_space, "auto"),

      KEY(output.samples, "", from_to(1, 1e6), "rows of series.csv, evenly over the run"),
      KEY(output.snapshots, "", from_to(0, 1e5), "restart points, evenly over the run"),
      KEY(output.snapshot_every, "min", at_least(0), "wall time since the last restart point after which another one is written; 0: none"),
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
      {"loading", "What the walls do."},
      {"time", "Time stepping."},
      {"sample", "The initial state."},
      {"box", "What holds the grains."},
      {"output", "What is written."},
  };
}
// clang-format on
#undef KEY

/// Of the parameter of this number: where it lies, and the laws that take it.
template <std::size_t Number>
struct ParameterPlace {
  static constexpr const MaterialParameter& parameter = material_parameters[Number];
  static double& member(Case& c) { return c.mpm.material.*parameter.value; }
  static bool acts(const Case& c) { return is_mpm(c) && law_choice(c.mpm.law).takes(parameter.value); }
  static std::string_view words() {
    static const std::string text = [] {
      std::vector<std::string_view> takers;
      for (const LawChoice& choice : law_choices())
        if (choice.takes(parameter.value)) takers.push_back(choice.name);
      if (takers.size() == law_choices().size()) return std::string(with_mpm.words);
      return fmt::format("with mpm.law {}", fmt::join(takers, " or "));
    }();
    return text;
  }
};

template <std::size_t... Number>
std::vector<Key> keys_of_parameters(std::index_sequence<Number...>) {
  const auto key = []<class Place>(Place) {
    const MaterialParameter& p = Place::parameter;
    return Key{fmt::format("mpm.{}", p.name),
               MemberOf<double>(Place::member),
               p.unit,
               {.low = p.low,
                .high = p.high,
                .without_low = !p.from_low && std::isfinite(p.low),
                .without_high = std::isfinite(p.high)},
               p.text,
               {Place::words(), Place::acts}};
  };
  return {key(ParameterPlace<Number>{})...};
}

/// One for each of material_parameters.
std::vector<Key> material_keys() {
  return keys_of_parameters(std::make_index_sequence<material_parameters.size()>{});
}

}  // namespace

const std::vector<Key>& case_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all = all_keys();
    const std::vector<Key> material = material_keys();
    all.insert(std::ranges::find(all, "mpm.law", &Key::name) + 1, material.begin(), material.end());
    return all;
  }();
  return keys;
}

const std::vector<TableOfKeys>& case_tables() {
  static const std::vector<TableOfKeys> tables = all_tables();
  return tables;
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
