#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "softgrain/model/model.hpp"

namespace softgrain {

/// What a .vtp file of ParaView holds: points, and cells: lines between two points, quads, or else every
/// point.
struct PolyData {
  std::vector<double> positions;  ///< x y for each point, in space x y z [m]
  std::size_t columns = 2;        ///< of the positions
  bool has_lines = false;
  std::vector<std::int64_t> lines;          ///< pairs of point indices
  std::vector<std::int64_t> quads;          ///< four point indices each
  std::map<std::string, Array> point_data;  ///< one row per point
  std::map<std::string, Array> cell_data;   ///< one row per cell
};

/// Particles that lie elsewhere, as in a snapshot: those of a large packing are nowhere whole.
struct ParticleRows {
  ArrayShapes arrays;
  std::function<Array(const std::string& name, std::size_t first, std::size_t count)> rows;
};
/// Those of a scene, to which it keeps a reference.
ParticleRows rows_of_particles(const Scene& scene);

/// A line between the particles of each contact; contacts with something else than a particle (an index
/// outside) are left out. Of contacts between grains a line between the centres, and from the centre to the
/// place of contact with a wall.
PolyData contacts_of(const Scene& scene, const ParticleRows& particles);
PolyData walls_of(const Scene& scene);
/// The outlines of grains in space, as quads.
PolyData surfaces_of(const Scene& scene);

/// The bytes of a .vtp file: appended raw blocks, zlib, 64 bit headers, reals as float32 with denormal
/// numbers flushed to zero. Two columns become three (z = 0), as ParaView's vectors.
std::string encode_vtp(const PolyData& data);
std::string encode_vtp(const ParticleRows& particles);

/// Writes particles_, contacts_ and walls_`label`.vtp into the folder; in space surfaces_ too.
void write_scene(const std::filesystem::path& folder, const std::string& label, const Scene& scene,
                 const ParticleRows& particles);

/// One time of the collection that ParaView opens.
struct Frame {
  double time = 0;    ///< [s]
  std::string label;  ///< of its files
};

/// The text of a .pvd file: every frame with its parts in `folder`, in space with the surfaces.
std::string pvd_text(const std::vector<Frame>& frames, const std::string& folder, bool in_space = false);

}  // namespace softgrain
