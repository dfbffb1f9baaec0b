#include "softgrain/io/case/surface_file.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/mesh_file.hpp"

namespace softgrain {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_file = 16'000'000;

std::string bytes_of(const fs::path& path) {
  std::error_code unknown;
  require(!path.empty() && (!fs::exists(path, unknown) || fs::is_regular_file(path, unknown)), "not a file");
  std::string bytes;
  try {
    bytes = read_beginning(path, largest_file + 1);
  } catch (const IoError& error) {
    throw UsageError(error.what());
  }
  require(bytes.size() <= largest_file,
          "larger than 16 MB; reduce the mesh, a grain has a few hundred vertices");
  return bytes;
}

}  // namespace

TriangleMesh surface_of_file(const std::string& name, Origin origin, CaseDraft& draft) {
  fs::path path = name;
  if (origin.set < 0) path = fs::path(draft.sources->front().name).parent_path() / path;
  try {
    MeshText text = read_mesh(bytes_of(path));
    try {
      const StarSurface closed(text.mesh);  // says what is wrong with it
      return std::move(text.mesh);
    } catch (const MeshFault& fault) {
      throw UsageError(
          fmt::format("{}: {}", text.place[static_cast<std::size_t>(fault.triangle)], fault.what()));
    }
  } catch (const UsageError& error) {
    draft.add(origin, fmt::format("grain.surface: {}: {}", path.string(), error.what()));
    draft.invalid.insert("grain.surface");
  }
  return {};
}

}  // namespace softgrain
