#include "softgrain/io/case/case_forms.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace softgrain {
namespace {

// clang-format off
FormKey stands_for(std::string name, std::vector<std::string> keys, std::string_view text, std::vector<std::string> later = {}) {
  return {std::move(name), Takes::as_key, std::move(keys), text, {}, std::move(later)};
}
FormKey word(std::string name, std::vector<std::string> words, std::vector<std::string> later, std::string_view text) {
  return {std::move(name), Takes::word, {}, text, std::move(words), std::move(later)};
}
FormKey number(std::string name, std::string_view unit, Range range, std::string_view text) {
  return {std::move(name), Takes::number, {}, text, {}, {}, unit, range};
}

std::vector<FormKey> all_forms() {
  const Range any, positive{.low = 0, .without_low = true};
  return {

      {"kind.name", Takes::text, {}, "name of the kind, for [[pair]], for --set kind.NAME.key=value and for the column kind of a sample's file; several kinds need one each"},
      stands_for("kind.model", {"experiment.model"}, "model of these grains; kinds of all models mix, bonded and elastic ones in the plane with mpm.integrator explicit"),
      stands_for("kind.number", {"sample.grains"}, "grains of this kind in the box"),
      number("kind.share", "", positive, "share of the area of sample.grains grains that this kind has, in proportion; all kinds have one, or all a number"),
      stands_for("kind.shape", {"grain.shape"}, "shape of the undeformed grain; left out: a disk, or outline or surface where one is given"),
      stands_for("kind.aspect", {"grain.aspect"}, "long over short axis of an ellipse"),
      stands_for("kind.sides", {"grain.sides"}, "of a regular polygon"),
      stands_for("kind.outline", {"grain.outline"}, "of a shape of its own: a CSV file, or a list of points"),
      stands_for("kind.surface", {"grain.surface"}, "of a shape of its own in space: an STL or PLY file"),
      stands_for("kind.density", {"grain.density"}, "density of the material"),
      stands_for("kind.diameter", {"sample.smallest_diameter", "sample.largest_diameter"}, "diameter of all grains of this kind; a table for a law of diameters"),
      stands_for("kind.diameter.distribution", {"sample.sizes"}, "law of the diameters; left out: list where there are values, lognormal where there is a median"),
      stands_for("kind.diameter.smallest", {"sample.smallest_diameter"}, "smallest diameter, or lower cut-off"),
      stands_for("kind.diameter.largest", {"sample.largest_diameter"}, "largest diameter, or upper cut-off"),
      stands_for("kind.diameter.median", {"sample.median_diameter"}, "median of a lognormal law before it is cut off"),
      stands_for("kind.diameter.deviation", {"sample.deviation"}, "standard deviation of ln d of a lognormal law before it is cut off"),
      stands_for("kind.diameter.values", {"sample.diameters"}, "diameters of a list"),
      stands_for("kind.diameter.shares", {"sample.shares"}, "share of the grains' area that each diameter of the list has"),
      stands_for("kind.diameter.numbers", {"sample.numbers"}, "how many grains have each diameter of the list, in proportion"),
      stands_for("kind.law.name", {"mpm.law"}, "law of the material (mpm)"),
      stands_for("kind.law.attraction", {"bpm.attraction"}, "attraction between touching primaries (bpm between walls)"),
      stands_for("kind.law.force", {"bpm.force"}, "the same in space"),
      stands_for("kind.law.cohesive_pressure", {"bpm.cohesive_pressure"}, "internal cohesive pressure (bpm in a box)"),
      stands_for("kind.law.exponent", {"bpm.exponent"}, "exponent of the attraction (bpm)"),
      stands_for("kind.law.inner_friction", {"bpm.inner_friction"}, "friction between primaries of one grain (bpm)"),
      stands_for("kind.cells", {"mpm.cells"}, "resolution of a grain (mpm)"),
      stands_for("kind.primaries", {"bpm.primaries"}, "resolution of a grain (bpm)"),

      {"pair.between", Takes::texts, {}, "the two sides: names of kinds, or \"wall\""},
      stands_for("pair.friction", {"contact.friction", "contact.wall_friction"}, "coefficient of friction mu between the two: of grains, or of a grain and a wall"),
      stands_for("pair.surface_energy", {"contact.surface_energy", "contact.wall_surface_energy"}, "surface energy w of adhesion between the two: of grains, or of a grain and a wall; 0: they do not adhere"),
      stands_for("pair.adhesion_range", {"contact.adhesion_range"}, "gap up to which the two attract each other"),

      {"sample.file", Takes::text, {}, "a CSV file with the places of the grains, instead of random ones: see below; from the folder of the case file"},

      {"stage.name", Takes::text, {}, "name of the stage"},
      number("stage.repeat", "", {.low = 1}, "how often the stages from repeat_from to this one are done, this time included"),
      stands_for("stage.set.contact.friction", {"contact.friction"}, "from the begin of the stage on, as all that `set` changes: between grains"),
      stands_for("stage.set.contact.wall_friction", {"contact.wall_friction"}, "against walls"),
      stands_for("stage.set.solver.tolerance", {"solver.tolerance"}, "of the contact solver (bpm)"),
      stands_for("stage.set.mpm.tolerance", {"mpm.tolerance"}, "of Newton's method (implicit mpm)"),
      stands_for("stage.set.mpm.damping", {"mpm.damping"}, "of grains (mpm)"),
      {"stage.repeat_from", Takes::text, {}, "name of the stage from which on is repeated; left out: this one alone"},
      number("stage.until.time", "ms", positive, "time since the stage began"),
      number("stage.until.strain", "", any, "compressive strain of yy since the start of the run, as the column strain has it; in space of zz"),
      number("stage.until.strain_xx", "", any, "the same of xx, ln(w_start/w)"),
      number("stage.until.strain_yy", "", any, "the same of yy in space"),
      number("stage.until.strain_xy", "", any, "shear strain gamma of a periodic cell since the start of the run"),
      number("stage.until.packing_fraction", "", positive, "packing fraction Phi_0 of the undeformed grains"),
      number("stage.until.overlap", "", positive, "mean overlap of the contacts, as the column overlap_mean has it"),
      number("stage.until.rest", "", positive, "kinetic over stored energy, below which the grains are at rest"),
  };
}

/// What walls of a part do, and the stress on them that ends a stage.
void add_forms_of(std::string_view part, std::string_view walls, std::vector<FormKey>& all) {
  const Range any, positive{.low = 0, .without_low = true}, not_negative{.low = 0};
  const std::string name = fmt::format("stage.{}", part);
  all.push_back(word(name, {"rest", "quasi-static"}, {}, walls));
  all.push_back(number(name + ".velocity", "m/s", any, "at which they come together, half by each of a pair; below 0: apart"));
  all.push_back(number(name + ".rate", "1/s", any, "of the strain, compression positive"));
  all.push_back(number(name + ".stress", "MPa", positive, "that they keep, compression positive, of a pair in the mean"));
  all.push_back(number(name + ".speed", "m/s", positive, "of walls that keep a stress, at most; left out: loading.wall_velocity, or where other parts move 50 times that until they have met the grains, and then no limit"));
  all.push_back(number(name + ".stress_amplitude", "MPa", positive, "of the wave that is added to the stress"));
  all.push_back(number(name + ".strain_amplitude", "", {.low = 0, .high = 1, .without_low = true}, "of the wave of the strain about that where the stage began"));
  all.push_back(number(name + ".period", "ms", positive, "of the wave"));
  all.push_back(word(name + ".wave", {"sine", "triangle"}, {}, "form of the wave; left out: sine"));
  all.push_back(number(fmt::format("stage.until.stress_{}", part), "MPa", not_negative, "mean over 0.1 % of strain, of a pair of both walls; 0: the walls are let go"));
}
// clang-format on

/// The same of the shear of a periodic cell.
// clang-format off
void add_shear(std::vector<FormKey>& all) {
  const Range any, positive{.low = 0, .without_low = true};
  all.push_back(word("stage.xy", {"rest", "quasi-static"}, {}, "shear of a cell that is periodic in x and y; \"rest\" where nothing is said of it"));
  all.push_back(number("stage.xy.rate", "1/s", any, "of the shear strain; above 0 what lies higher goes to +x"));
  all.push_back(number("stage.xy.stress", "MPa", any, "shear stress that the cell keeps, -stress_xy of the columns: it has the sign of the shear that it brings about"));
  all.push_back(number("stage.xy.speed", "m/s", positive, "of the upper end against the lower one, at most; left out: loading.wall_velocity, where other parts move 50 times that"));
  all.push_back(number("stage.xy.stress_amplitude", "MPa", positive, "of the wave that is added to the stress"));
  all.push_back(number("stage.xy.strain_amplitude", "", positive, "of the wave of the shear strain about that where the stage began"));
  all.push_back(number("stage.xy.period", "ms", positive, "of the wave"));
  all.push_back(word("stage.xy.wave", {"sine", "triangle"}, {}, "form of the wave; left out: sine"));
  all.push_back(number("stage.until.stress_xy", "MPa", any, "the same stress, mean over 0.1 % of strain"));
}
// clang-format on

void add_stages(std::vector<FormKey>& all) {
  add_forms_of("yy", "bottom and top wall, in space the two along y; \"rest\" where nothing is said of them",
               all);
  add_forms_of("xx", "left and right wall, in the same way", all);
  add_forms_of("zz", "bottom and top wall in space, in the same way", all);
  add_forms_of("bottom", "the bottom wall alone", all);
  add_forms_of("top", "the top wall alone", all);
  add_forms_of("left", "the left wall alone", all);
  add_forms_of("right", "the right wall alone", all);
  add_shear(all);
}

}  // namespace

const std::vector<FormKey>& form_keys() {
  static const std::vector<FormKey> keys = [] {
    std::vector<FormKey> all = all_forms(), material;
    add_stages(all);
    for (const MaterialParameter& p : material_parameters)
      material.push_back(
          stands_for(fmt::format("kind.law.{}", p.name), {fmt::format("mpm.{}", p.name)}, p.text));
    all.insert(std::ranges::find(all, "kind.law.name", &FormKey::name) + 1, material.begin(), material.end());
    return all;
  }();
  return keys;
}

const std::vector<TableOfKeys>& form_tables() {
  static const std::vector<TableOfKeys> tables{
      {"kind",
       "A kind of grains, instead of [grain], [sample] and the material's keys of [mpm] or [bpm]. Several "
       "kinds\n"
       "(rigid, elastic and bonded grains, in a box) mix in one sample; what [grain], [mpm], [bpm] "
       "and [sample] say\n"
       "then holds for the kinds that do not say it themselves."},
      {"pair",
       "What acts between two kinds, or a kind and the walls, instead of [contact]; of several kinds\n"
       "contact.friction and "
       "contact.wall_friction are those of the pairs that have no table."},
      {"stage",
       "A part of the loading path of grains in a box, one after the other, instead of a short form of "
       "[loading]."},
  };
  return tables;
}

const FormKey* find_form(std::string_view name) {
  const auto found = std::ranges::find(form_keys(), name, &FormKey::name);
  return found == form_keys().end() ? nullptr : &*found;
}

const std::vector<OldKey>& old_keys() {
  static const std::vector<OldKey> keys{{"mpm.time_step", "time.step"}};
  return keys;
}

}  // namespace softgrain
