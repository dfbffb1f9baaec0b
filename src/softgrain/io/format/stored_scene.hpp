#pragma once
#include <filesystem>

#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/format/vtp_writer.hpp"
#include "softgrain/model/model.hpp"

namespace softgrain {

/// The scene of a snapshot that is known to be intact: its particles stay in the file.
class StoredScene {
 public:
  /// Raises IoError.
  explicit StoredScene(const std::filesystem::path& snapshot);

  /// Without particles.
  const Scene& scene() const { return scene_; }
  /// Keeps a reference.
  ParticleRows particles() const;

 private:
  Hdf5Reader file_;
  Scene scene_;
  ArrayShapes particles_;
};

}  // namespace softgrain
