#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/kinds.hpp"

namespace softgrain {

/// For which cases a key of the case file does anything.
struct Scope {
  std::string_view words;  ///< completes "it acts only ...": "on bpm"
  bool (*covers)(const Case&);
};

namespace scope {

inline bool is_bpm(const Case& c) { return has_bonded(c); }
inline bool is_mpm(const Case& c) { return is_elastic(c); }
inline bool is_outlined(const Case& c) { return !is_bonded(c); }
inline bool is_updated_lagrangian(const Case& c) {
  return is_mpm(c) && c.mpm.formulation == Formulation::updated_lagrangian;
}
inline bool is_total_lagrangian(const Case& c) { return is_outlined(c) && !is_updated_lagrangian(c); }

inline constexpr Scope everywhere{"", [](const Case&) { return true; }};
inline constexpr Scope with_bpm{"on bpm", is_bpm};
inline constexpr Scope with_mpm{"on mpm", is_mpm};
inline constexpr Scope with_outlines{"on mpm and rigid", is_outlined};
inline bool has_shape(const Case& c, ShapeOfGrain shape) { return is_outlined(c) && c.grain.shape == shape; }
inline constexpr Scope ellipses{"on ellipses",
                                [](const Case& c) { return has_shape(c, ShapeOfGrain::ellipse); }};
inline constexpr Scope polygons{"on polygons",
                                [](const Case& c) { return has_shape(c, ShapeOfGrain::polygon); }};
inline constexpr Scope outlines{"on grains of shape \"outline\"",
                                [](const Case& c) { return has_shape(c, ShapeOfGrain::outline); }};
inline constexpr Scope surfaces{"on grains of shape \"surface\"",
                                [](const Case& c) { return has_shape(c, ShapeOfGrain::surface); }};
inline constexpr Scope turned{
    "on a grain between walls that is no disk",
    [](const Case& c) { return is_outlined(c) && !is_in_a_box(c) && c.grain.shape != ShapeOfGrain::disk; }};
inline constexpr Scope in_a_box{"in a box", is_in_a_box};
inline constexpr Scope between_walls{"between walls", [](const Case& c) { return !is_in_a_box(c); }};
inline constexpr Scope bpm_in_a_box{"on bpm in a box",
                                    [](const Case& c) { return is_bpm(c) && is_in_a_box(c); }};
inline constexpr Scope bpm_between_walls{"on bpm between walls",
                                         [](const Case& c) { return is_bpm(c) && !is_in_a_box(c); }};
inline constexpr Scope bpm_between_walls_in_plane{"on bpm between walls in the plane", [](const Case& c) {
                                                    return bpm_between_walls.covers(c) && !is_in_space(c);
                                                  }};
inline constexpr Scope bpm_between_walls_in_space{"on bpm between walls in space", [](const Case& c) {
                                                    return bpm_between_walls.covers(c) && is_in_space(c);
                                                  }};
inline constexpr Scope total_lagrangian{"on total_lagrangian mpm", is_total_lagrangian};
inline constexpr Scope updated_lagrangian{"on updated_lagrangian mpm", is_updated_lagrangian};
inline bool is_implicit(const Case& c) {
  const Integrator integrator = is_updated_lagrangian(c) ? c.mpm.lattice_integrator : c.mpm.integrator;
  return is_outlined(c) && integrator == Integrator::backward_euler;
}
inline constexpr Scope implicit{"on implicit mpm", is_implicit};
inline constexpr Scope with_pairs{"between the grains of a box",
                                  [](const Case& c) { return is_in_a_box(c) && c.sample.grains > 1; }};
inline bool can_adhere(const Case& c) { return is_bpm(c) || (is_total_lagrangian(c) && !is_in_space(c)); }
inline constexpr Scope adhering{"on bpm and on outlines in the plane (total_lagrangian mpm, rigid)",
                                can_adhere};
inline constexpr Scope adhering_pairs{
    "between grains of bpm, or outlines in the plane (total_lagrangian mpm, rigid), in a box",
    [](const Case& c) { return can_adhere(c) && with_pairs.covers(c); }};
inline bool is_placed(const Case& c) { return is_in_a_box(c) && !c.sample.placed.empty(); }
inline bool is_random(const Case& c) {
  return is_in_a_box(c) && (c.sample.placed.empty() || c.sample.places == Places::pour);
}
inline bool has_sizes(const Case& c, SizeLaw law) { return is_random(c) && c.sample.sizes == law; }
inline constexpr Scope with_chance{"on bpm, random grains in a box or placed spheres", [](const Case& c) {
                                     return is_bpm(c) || is_random(c) || (is_placed(c) && is_in_space(c));
                                   }};
inline constexpr Scope placed{"in a box of placed grains (sample.file)", is_placed};
inline constexpr Scope placed_in_space{"on placed spheres (sample.file)",
                                       [](const Case& c) { return is_placed(c) && is_in_space(c); }};
inline constexpr Scope box_in_space{"in a box in space",
                                    [](const Case& c) { return is_in_a_box(c) && is_in_space(c); }};
inline constexpr Scope random{"on random grains in a box", is_random};
inline constexpr Scope random_between{
    "on random grains in a box, with sample.sizes uniform or lognormal",
    [](const Case& c) { return is_random(c) && c.sample.sizes != SizeLaw::list; }};
inline constexpr Scope lognormal{"with sample.sizes lognormal",
                                 [](const Case& c) { return has_sizes(c, SizeLaw::lognormal); }};
inline constexpr Scope listed{"with sample.sizes list",
                              [](const Case& c) { return has_sizes(c, SizeLaw::list); }};
inline bool is_path(const Case& c, LoadingPath path) {
  return c.experiment.loading == path && c.stages.empty();
}
/// Of the paths that go to a strain and may turn.
inline bool turns(const Case& c) {
  return is_path(c, LoadingPath::diametral) || is_path(c, LoadingPath::compaction) ||
         is_path(c, LoadingPath::isotropic);
}
inline constexpr Scope with_stages{"in a box, along [[stage]]",
                                   [](const Case& c) { return is_in_a_box(c) && !c.stages.empty(); }};
inline constexpr Scope with_short_path{"on paths that are not stages",
                                       [](const Case& c) { return c.stages.empty(); }};
inline constexpr Scope turning{"on diametral, compaction and isotropic paths", turns};
inline constexpr Scope packing_turning{"on compaction and isotropic paths",
                                       [](const Case& c) { return turns(c) && is_in_a_box(c); }};
inline constexpr Scope to_a_fraction{
    "on compaction, isotropic and relaxation paths",
    [](const Case& c) { return (turns(c) && is_in_a_box(c)) || is_path(c, LoadingPath::relaxation); }};
inline constexpr Scope to_a_stress{"in a box, on paths that are not stages",
                                   [](const Case& c) { return is_in_a_box(c) && c.stages.empty(); }};
inline constexpr Scope bpm_to_an_overlap{"on bpm in a box, on compaction, isotropic and relaxation paths",
                                         [](const Case& c) { return is_bpm(c) && to_a_fraction.covers(c); }};
inline constexpr Scope biaxial{"on biaxial and triaxial paths", [](const Case& c) {
                                 return is_path(c, LoadingPath::biaxial) || is_path(c, LoadingPath::triaxial);
                               }};
inline constexpr Scope quasi_static{"where a speed or a rate is \"quasi-static\"",
                                    [](const Case& c) { return c.loading.quasi_static; }};
inline constexpr Scope shearing{"on shear paths",
                                [](const Case& c) { return is_path(c, LoadingPath::shear); }};
inline constexpr Scope confining{"on biaxial, triaxial and shear paths",
                                 [](const Case& c) { return biaxial.covers(c) || shearing.covers(c); }};
inline constexpr Scope die{"on die paths", [](const Case& c) { return is_path(c, LoadingPath::die); }};
inline constexpr Scope relaxing{"on relaxation paths",
                                [](const Case& c) { return is_path(c, LoadingPath::relaxation); }};
inline constexpr Scope with_unloading{"with loading.unload_at",
                                      [](const Case& c) { return turns(c) && !c.loading.unload_at.empty(); }};

}  // namespace scope

/// "note: time.step and solver.tolerance have no effect on mpm between walls: they act only on bpm": a line
/// for each scope that the keys of these full names have and the case lacks.
std::vector<std::string> notes_on_effect(const Case& the_case, const std::vector<std::string>& keys);

}  // namespace softgrain
