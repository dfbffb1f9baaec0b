#include "peers/geomechanics_mpm.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "softgrain/core/error.hpp"

namespace softgrain::bench {
namespace {

std::string end_of(const std::filesystem::path& log) {
  std::ostringstream text;
  text << std::ifstream(log).rdbuf();
  const std::string all = text.str();
  return all.substr(all.size() - std::min(all.size(), std::size_t{2000}));
}

/// Runs a program with its arguments on one thread, with what it says in `log`; its user CPU time [s]. Raises
/// IoError, with the end of the log, if it fails.
double run_program(std::vector<std::string> words, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    setenv("OMP_NUM_THREADS", "1", 1);
    if (dup2(out, STDOUT_FILENO) >= 0 && dup2(out, STDERR_FILENO) >= 0)
      execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) ||
      WEXITSTATUS(status) != 0)
    throw IoError(fmt::format("{} failed:\n{}", words[0], end_of(log)));
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// What we read of a row of its table of points.
struct Velocity {
  std::int64_t id;
  double x, y;
};

}  // namespace

std::filesystem::path build_geomechanics_mpm(const std::filesystem::path& source) {
  require(std::filesystem::exists(source / "include/solvers/mpm_explicit.h"),
          "SOFTGRAIN_MPM_SOURCE={}: there is no source tree of geomechanics/mpm", source.string());
  const std::filesystem::path build = source / "build/softgrain";
  if (!std::filesystem::exists(build / "mpm")) {
    std::filesystem::create_directories(build);
    fmt::print("mpm_peer: building geomechanics/mpm in {}; see build.log there\n", build.string());
    std::fflush(stdout);
    run_program({BUILD_GEOMECHANICS_MPM, source.string(), build.string()}, build / "build.log");
  }
  return build / "mpm";
}

GeomechanicsMpm::GeomechanicsMpm(std::filesystem::path program, const VibratingBlocks& blocks)
    : program_(std::move(program)), blocks_(blocks) {
  std::string name = (std::filesystem::temp_directory_path() / "softgrain-mpm-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw IoError(fmt::format("cannot make the folder {}", name));
  folder_ = name;
  write_mesh();
  write_points();
}

GeomechanicsMpm::~GeomechanicsMpm() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

GeomechanicsMpm::Outcome GeomechanicsMpm::run(const Scheme& scheme, int steps) const {
  const int few = std::max(1, steps / 4);
  write_analysis(scheme, few);
  const double start = user_seconds();
  write_analysis(scheme, steps);
  const double seconds = (user_seconds() - start) / (steps - few);
  return {.step_seconds = seconds, .velocity = read_velocity(steps)};
}

/// The cells of all blocks, those between them and a margin of one cell.
void GeomechanicsMpm::write_mesh() const {
  const int columns = blocks_.count * (blocks_.cells + blocks_.gap), rows = blocks_.cells + 2;
  std::ofstream mesh(folder_ / "mesh.txt");
  mesh << fmt::format("{} {}\n", (columns + 1) * (rows + 1), columns * rows);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh << fmt::format("{} {}\n", i * blocks_.h, j * blocks_.h);
  const auto node = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh << fmt::format("{} {} {} {}\n", node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
}

/// Where the points are, their cells (it would look through all cells for each point) and stresses.
void GeomechanicsMpm::write_points() const {
  const int columns = blocks_.count * (blocks_.cells + blocks_.gap);
  std::ofstream position(folder_ / "points.txt"), cell(folder_ / "cells.txt"),
      stress(folder_ / "stresses.txt");
  const std::vector<Vec<2>> x = blocks_.positions();
  position << x.size() << '\n';
  stress << x.size() << '\n';
  for (int p = 0; p < blocks_.points(); ++p) {
    position << fmt::format("{} {}\n", x[p][0], x[p][1]);
    cell << fmt::format(
        "{} {}\n", p,
        static_cast<int>(x[p][1] / blocks_.h) * columns + static_cast<int>(x[p][0] / blocks_.h));
    // 2 G epsilon: no change of volume, no shear
    const double normal =
        blocks_.E / (1 + blocks_.nu) * blocks_.displacement_gradient(blocks_.from_corner(p))(0, 0);
    stress << fmt::format("{} {} 0 0 0 0\n", normal, -normal);
  }
}

void GeomechanicsMpm::write_analysis(const Scheme& scheme, int steps) const {
  std::ofstream(folder_ / "mpm.json") << fmt::format(
      R"({{"title": "free blocks in Lame's mode",
 "mesh": {{"mesh": "mesh.txt", "io_type": "Ascii2D", "check_duplicates": false, "isoparametric": false,
   "node_type": "N2D", "cell_type": "ED2Q4", "particle_cells": "cells.txt",
   "particles_stresses": {{"type": "file", "location": "stresses.txt"}}}},
 "particles": [{{"generator": {{"type": "file", "io_type": "Ascii2D", "material_id": [0], "pset_id": 0,
   "particle_type": "P2D", "check_duplicates": false, "location": "points.txt"}}}}],
 "materials": [{{"id": 0, "type": "LinearElastic2D", "density": {}, "youngs_modulus": {}, "poisson_ratio": {}}}],
 "external_loading_conditions": {{"gravity": [0, 0]}},
 "analysis": {{"type": "{}", "mpm_scheme": "{}", "velocity_update": "flip", "locate_particles": true,
   "dt": {}, "nsteps": {}, "uuid": "blocks",
   "scheme_settings": {{"nonlinear": false, "quasi_static": false, "beta": 0.25, "gamma": 0.5}},
   "linear_solver": {{"assembler_type": "EigenImplicit2D", "solver_type": "IterativeEigen"}}}},
 "post_processing": {{"path": "results/", "output_steps": {}}}}}
)",
      blocks_.rho, blocks_.E, blocks_.nu, scheme.analysis, scheme.stress_update,
      blocks_.duration() / scheme.steps_in_duration, steps, steps);
}

double GeomechanicsMpm::user_seconds() const {
  return run_program({program_.string(), "-p", "1", "-f", folder_.string() + "/"}, folder_ / "log.txt");
}

std::vector<Vec<2>> GeomechanicsMpm::read_velocity(int steps) const {
  const std::string name = (folder_ / fmt::format("results/blocks/particles{}.h5", steps)).string();
  const hid_t file = H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw IoError(fmt::format("cannot read {}", name));
  const hid_t table = H5Dopen(file, "table", H5P_DEFAULT), row = H5Tcreate(H5T_COMPOUND, sizeof(Velocity));
  H5Tinsert(row, "id", HOFFSET(Velocity, id), H5T_NATIVE_INT64);
  H5Tinsert(row, "velocity_x", HOFFSET(Velocity, x), H5T_NATIVE_DOUBLE);
  H5Tinsert(row, "velocity_y", HOFFSET(Velocity, y), H5T_NATIVE_DOUBLE);
  std::vector<Velocity> rows(blocks_.points());
  const herr_t read = H5Dread(table, row, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Tclose(row), H5Dclose(table), H5Fclose(file);
  if (read < 0) throw IoError(fmt::format("cannot read the points of {}", name));
  std::vector<Vec<2>> velocity(rows.size());
  for (const Velocity& point : rows) velocity.at(point.id) = {point.x, point.y};
  return velocity;
}

}  // namespace softgrain::bench
