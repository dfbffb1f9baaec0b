#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "peers/vibrating_blocks.hpp"

namespace softgrain::bench {

/// Builds geomechanics/mpm from its source tree unless it is built there already (in build/softgrain), and
/// returns its program. Raises UsageError if there is no such source, IoError if it does not build.
std::filesystem::path build_geomechanics_mpm(const std::filesystem::path& source);

/// geomechanics/mpm, run as a program of its own on one thread, on files in a temporary folder that goes with
/// the object.
class GeomechanicsMpm {
 public:
  /// How it computes the blocks; the names are its own.
  struct Scheme {
    std::string analysis = "MPMExplicit2D";
    std::string stress_update = "usf";  ///< stresses first (usf), or last, after velocities went through the
                                        ///< points once more (musl)
    int steps_in_duration = 0;
  };
  /// What a run gave.
  struct Outcome {
    double step_seconds = 0;       ///< user CPU time of a step, without start and files [s]
    std::vector<Vec<2>> velocity;  ///< (points) at the end [m/s]
  };

  GeomechanicsMpm(std::filesystem::path program, const VibratingBlocks& blocks);
  GeomechanicsMpm(const GeomechanicsMpm&) = delete;
  GeomechanicsMpm& operator=(const GeomechanicsMpm&) = delete;
  ~GeomechanicsMpm();

  /// Runs it for a quarter of so many steps and for all of them; the difference is the cost. Raises IoError,
  /// with the end of what it said, if it fails.
  Outcome run(const Scheme& scheme, int steps) const;

 private:
  void write_mesh() const;
  void write_points() const;
  void write_analysis(const Scheme& scheme, int steps) const;
  double user_seconds() const;
  std::vector<Vec<2>> read_velocity(int steps) const;

  std::filesystem::path program_, folder_;
  VibratingBlocks blocks_;
};

}  // namespace softgrain::bench
