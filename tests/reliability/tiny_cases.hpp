#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "support/program_runs.hpp"

namespace softgrain::test {

/// A case that runs in a fraction of a second and unloads on the way.
struct TinyCase {
  std::string name;
  std::string source;  ///< a case file, or the name of a template of `softgrain new`
  Words settings;
  std::size_t turns = 2;  ///< of its path, each a snapshot
};

inline Words with_settings(Words words, const Words& settings) {
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

/// Of the packings in experiments/ whose paths are more than a compaction.
inline Words tiny_path(const std::string& name) {
  if (name == "one_grain_box" || name == "diametral_plastic")
    return {"output.samples=20", "output.snapshots=6", "output.report=false", "mpm.cells=4"};
  Words settings{"output.samples=20", "output.snapshots=6",   "output.report=false",   "sample.grains=6",
                 "mpm.cells=4",       "contact.friction=0.3", "loading.max_strain=0.3"};
  const auto add = [&](const Words& more) { settings.insert(settings.end(), more.begin(), more.end()); };
  if (name == "die" || name == "tablet")
    add({"loading.wall_velocity=\"1 m/s\"", "loading.max_stress=\"0.3 MPa\"", "loading.max_strain=0.5"});
  if (name == "biaxial")
    add({"loading.wall_velocity=\"0.05 m/s\"", "loading.hold=\"40 ms\"", "loading.max_strain=0.12"});
  if (name == "relaxation")
    add({"loading.wall_velocity=\"1 m/s\"", "loading.hold=\"1 ms\"", "loading.rest=0"});
  if (name == "rubber_sand")
    add({"loading.wall_velocity=\"1 m/s\"", "loading.max_strain=0.17", "loading.unload_at=[0.15]",
         "loading.unload_by=0.04", "loading.max_stress=0", "sample.packing_fraction=0.62"});
  if (name == "soft_rigid")
    add({"loading.wall_velocity=\"1 m/s\"", "loading.max_strain=0.17", "loading.unload_at=[0.15]",
         "loading.unload_by=0.04", "loading.max_stress=0", "loading.max_packing_fraction=0",
         "sample.packing_fraction=0.62", "kind.rigid.share=0.5"});
  if (name == "bonded_rigid")
    add({"sample.grains=8", "bpm.primaries=20", "loading.wall_velocity=\"5 m/s\"", "loading.max_strain=0.2",
         "loading.unload_at=[0.16]", "loading.unload_by=0.04", "loading.max_stress=0"});
  if (name == "bonded_elastic")
    add({"sample.grains=8", "bpm.primaries=20", "bpm.inner_friction=0.1", "loading.wall_velocity=\"5 m/s\"",
         "loading.max_strain=0.2", "loading.unload_at=[0.16]", "loading.unload_by=0.04",
         "loading.max_stress=0"});
  if (name == "shapes")
    add({"kind.ellipse.number=2", "kind.square.number=2", "kind.drop.number=2",
         "loading.wall_velocity=\"4 m/s\"", "loading.max_strain=0.48", "sample.packing_fraction=0.58"});
  if (name == "sticky_grains") add({"sample.grains=12", "loading.max_strain=0.35"});
  if (name == "poured") add({"time.step=\"1 ms\"", "loading.max_strain=0.35"});
  if (name == "jamming")
    add({"sample.grains=9", "loading.wall_velocity=\"1 m/s\"", "loading.max_strain=0.15"});
  if (name == "compaction_3d")
    add({"sample.grains=4", "mpm.cells=2", "sample.packing_fraction=0.35", "loading.wall_velocity=\"5 m/s\"",
         "loading.max_strain=0.32", "loading.unload_at=[0.28]", "loading.unload_by=0.05"});
  if (name == "hydrogels")
    add({"sample.grains=4", "mpm.cells=2", "sample.packing_fraction=0.35", "sample.aspect=1",
         "loading.wall_velocity=\"0.25 m/s\"", "loading.max_strain=0.5", "loading.unload_at=[0.45]",
         "loading.unload_by=0.05"});
  if (name == "sphere_walls")
    add({"mpm.cells=2", "contact.wall_friction=0.2", "loading.wall_velocity=\"5 m/s\"",
         "loading.max_strain=0.1", "loading.unload_at=[0.06]", "loading.unload_by=0.03"});
  if (name == "bonded_sphere")
    add({"bpm.primaries=25", "bpm.inner_friction=0.3", "contact.friction=0",
         "loading.wall_velocity=\"5 m/s\"", "loading.max_strain=0.1", "loading.unload_at=[0.06]",
         "loading.unload_by=0.03"});
  if (name == "bonded_spheres")
    add({"bpm.primaries=25", "bpm.library=1", "sample.packing_fraction=0.35",
         "loading.wall_velocity=\"10 m/s\"", "loading.max_strain=0.25", "loading.unload_at=[0.22]",
         "loading.unload_by=0.05"});
  if (name == "shear")
    add({"sample.grains=9", "loading.wall_velocity=\"0.5 m/s\"", "loading.hold=\"20 ms\"",
         "loading.shear_rate=10", "loading.max_shear=0.55", "loading.confining_stress=\"1 MPa\"",
         "time.step=\"20 us\""});
  return settings;
}

/// What makes an example or a template tiny. Friction is on, which makes the path matter.
inline Words tiny_settings(const std::string& name) {
  const bool compaction = name.find("compaction") != std::string::npos;
  const bool bonded = name.find("bpm") != std::string::npos;
  Words settings{"output.samples=20", "output.snapshots=6", "output.report=false",
                 "contact.wall_friction=0.2"};
  const auto add = [&](const Words& more) { settings.insert(settings.end(), more.begin(), more.end()); };
  if (compaction || !bonded) add({"contact.friction=0.3"});
  if (!compaction && bonded) add({"bpm.inner_friction=0.3"});
  if (bonded) add({"bpm.primaries=25", "bpm.library=1"});
  if (!bonded) add({"mpm.cells=4"});
  if (compaction) {
    add({"sample.grains=6", "sample.packing_fraction=0.62", "loading.wall_velocity=\"10 m/s\""});
    add({"loading.max_strain=0.32", "loading.unload_at=[0.28]", "loading.unload_by=0.08",
         "loading.max_stress=0"});
    add(bonded ? Words{"bpm.inner_friction=0.1", "time.step=\"0.2 us\""} : Words{"time.step=\"4 us\""});
  } else {
    const bool small = name.find("plastic") != std::string::npos;  // a fifth of the others' radius
    add({small ? "loading.wall_velocity=\"0.2 m/s\"" : "loading.wall_velocity=\"1 m/s\""});
    add({"loading.max_strain=0.1", "loading.unload_at=[0.06]", "loading.unload_by=0.03"});
    add(bonded ? Words{"time.step=\"0.25 us\""} : Words{"time.step=\"20 us\""});
  }
  return settings;
}

/// Every template and every directory of experiments/, and the integrators and formulations besides.
inline std::vector<TinyCase> tiny_cases() {
  namespace fs = std::filesystem;
  std::vector<TinyCase> cases;
  for (const std::string name : {"diametral-bpm", "diametral-mpm", "compaction-bpm", "compaction-mpm"})
    cases.push_back({name, name, tiny_settings(name)});
  for (const auto& entry : fs::directory_iterator(fs::path(SOFTGRAIN_SOURCE_DIR) / "experiments")) {
    const std::string name = entry.path().filename().string();
    const std::string source = (entry.path() / "case.toml").string();
    if (!fs::exists(source)) continue;
    if (name == "triaxial_3d")
      continue;  // a stress that is kept takes too long: unit/experiment/test_stages_in_space
    if (name == "jamming")
      cases.push_back({name, source, tiny_path(name), 0});
    else if (name == "die" || name == "tablet")
      cases.push_back({name, source, tiny_path(name), 5});
    else if (name == "rubber_sand" || name == "soft_rigid" || name == "bonded_rigid" ||
             name == "bonded_elastic" || name == "compaction_3d" || name == "sphere_walls" ||
             name == "bonded_sphere" || name == "bonded_spheres" || name == "hydrogels")
      cases.push_back({name, source, tiny_path(name)});
    else if (name == "one_grain_box" || name == "diametral_plastic")
      cases.push_back({name, source, tiny_path(name), 3});
    else if (name == "shapes")
      cases.push_back({name, source, tiny_path(name), 0});
    else if (name == "sticky_grains")
      cases.push_back({name, source, tiny_path(name), 1});
    else if (name == "biaxial" || name == "relaxation" || name == "shear" || name == "poured")
      cases.push_back({name, source, tiny_path(name), name == "relaxation" || name == "poured" ? 1U : 2U});
    else
      cases.push_back({name, source, tiny_settings(name)});
    if (name == "sphere_walls") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"mpm.law=\"von_mises\"", "mpm.yield_stress=\"0.3 MPa\""});
      cases.push_back({"plastic-sphere_walls", source, more});
    }
    if (name == "shapes") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"mpm.integrator=explicit", "kind.drop.model=rigid"});
      cases.push_back({"explicit-shapes", source, more, 0});
    }
    if (name == "soft_rigid") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"experiment.dimension=3", "mpm.cells=2", "mpm.poisson_ratio=0.45",
                               "sample.packing_fraction=0.36", "loading.wall_velocity=\"2 m/s\"",
                               "loading.max_strain=0.42", "loading.unload_at=[0.38]"});
      cases.push_back({"space-soft_rigid", source, more});
    }
    if (name == "compaction_3d") {
      Words more = tiny_path(name);
      const std::string stone = (fs::path(SOFTGRAIN_SOURCE_DIR) / "tests/data/surfaces/stone.stl").string();
      more.insert(more.end(), {"experiment.model=rigid", "grain.surface=\"" + stone + "\"", "mpm.cells=3",
                               "contact.friction=0.3", "loading.wall_velocity=\"1 m/s\""});
      cases.push_back({"rigid-surfaces", source, more});
    }
    if (name == "bonded_spheres") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"contact.surface_energy=2", "contact.wall_surface_energy=2"});
      cases.push_back({"sticky-bonded_spheres", source, more});
    }
    if (name == "compaction_3d") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"box.x=\"periodic\"", "box.y=\"periodic\"", "box.z=\"periodic\"",
                               "sample.grains=20", "sample.packing_fraction=0.45", "mpm.law=\"prony\"",
                               "mpm.relaxation_share_1=0.5", "mpm.relaxation_time_1=\"0.1 ms\"",
                               "loading.max_strain=0.16", "loading.unload_at=[0.14]"});
      cases.push_back({"periodic-compaction_3d", source, more});
    }
    if (name == "bonded_rigid") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"experiment.dimension=3", "sample.packing_fraction=0.3"});
      cases.push_back({"space-bonded_rigid", source, more});
    }
    if (name == "soft_rigid") {
      Words more = tiny_path(name);
      more.insert(more.end(), {"mpm.integrator=\"explicit\"", "box.x=\"periodic\"", "sample.grains=9"});
      cases.push_back({"explicit-periodic-soft_rigid", source, more});
    }
  }
  const auto add_variant = [&](const std::string& name, const std::string& base, const Words& more) {
    Words settings = tiny_settings(base);
    settings.insert(settings.end(), more.begin(), more.end());
    cases.push_back({name, base, settings});
  };
  const Words periodic{"box.x=\"periodic\"", "box.y=\"periodic\"", "sample.grains=9",
                       "experiment.loading=\"isotropic\"", "loading.max_strain=0.16"};
  for (const std::string name : {"compaction-bpm", "compaction-mpm", "explicit"}) {
    Words more = periodic;
    more.insert(more.end(), {"loading.unload_at=[0.14]", "loading.unload_by=0.04"});
    if (name == "explicit") more.insert(more.end(), {"mpm.integrator=\"explicit\"", "time.step=0"});
    add_variant("periodic-" + name, name == "explicit" ? "compaction-mpm" : name, more);
  }
  add_variant("sticky-compaction-bpm", "compaction-bpm",
              {"contact.surface_energy=4", "contact.wall_surface_energy=4"});
  add_variant("explicit-compaction", "compaction-mpm", {"mpm.integrator=\"explicit\"", "time.step=0"});
  add_variant("explicit-diametral", "diametral-mpm",
              {"mpm.integrator=\"explicit\"", "time.step=0", "grain.radius=\"1 mm\""});
  add_variant("updated-lagrangian", "diametral-mpm",
              {"mpm.formulation=\"updated_lagrangian\"", "time.step=0", "grain.radius=\"1 mm\"",
               "contact.friction=0", "contact.wall_friction=0"});
  add_variant("updated-lagrangian-box", "compaction-mpm",
              {"mpm.formulation=\"updated_lagrangian\"", "mpm.contact_on=\"grid_nodes\"", "time.step=0"});
  add_variant("updated-lagrangian-implicit", "compaction-mpm",
              {"mpm.formulation=\"updated_lagrangian\"", "mpm.contact_on=\"grid_nodes\"",
               "mpm.lattice_integrator=\"implicit\"", "time.step=0"});
  return cases;
}

/// The case's file in the workshop.
inline std::string case_file(const Workshop& workshop, const TinyCase& tiny) {
  if (std::filesystem::exists(tiny.source)) return tiny.source;
  workshop.softgrain({"new", tiny.name, "--template", tiny.source});
  return tiny.name + "/case.toml";
}

/// Runs the case to its end, silently, into `run`.
inline ProcessResult run_tiny(const Workshop& workshop, const TinyCase& tiny, const std::string& run,
                              const Words& options = {}) {
  Words words = with_settings({"run", case_file(workshop, tiny), "-o", run, "-q"}, tiny.settings);
  words.insert(words.end(), options.begin(), options.end());
  return workshop.softgrain(words);
}

/// Copies a run without the snapshots after its first `kept`, as if it had been cut off there.
inline void copy_cut_off(const Workshop& workshop, const std::string& from, const std::string& to,
                         std::size_t kept) {
  std::filesystem::copy(workshop.path(from), workshop.path(to), std::filesystem::copy_options::recursive);
  const auto snapshots = workshop.snapshots(to);
  for (std::size_t k = kept; k < snapshots.size(); ++k) std::filesystem::remove(snapshots[k]);
}

}  // namespace softgrain::test
