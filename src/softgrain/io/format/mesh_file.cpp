#include "softgrain/io/format/mesh_file.hpp"

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "softgrain/io/format/mesh_builder.hpp"

namespace softgrain {
namespace {

constexpr std::size_t stl_header = 84, stl_triangle = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t k = 0; k < 4; ++k)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
  return number;
}

/// 80 bytes of any text, the number of triangles, and 50 bytes of each: normal, three corners, two bytes.
MeshText read_binary_stl(std::string_view bytes) {
  const std::size_t count = little_endian(bytes, 80);
  require(
      bytes.size() >= stl_header + stl_triangle * count,
      "byte {}: the file ends within triangle {} of the {} that byte 80 announces: it is cut off; copy it "
      "again",
      bytes.size(), (bytes.size() - stl_header) / stl_triangle + 1, count);
  MeshBuilder mesh;
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t begin = stl_header + stl_triangle * t;
    const std::string place = fmt::format("byte {}", begin);
    std::array<int, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      Vec<3> x;
      for (std::size_t i = 0; i < 3; ++i)
        x[static_cast<int>(i)] = std::bit_cast<float>(little_endian(bytes, begin + 12 + 12 * k + 4 * i));
      corner[k] = mesh.vertex(x, place);
    }
    mesh.polygon(corner, place);
  }
  return mesh.take();
}

/// solid NAME, then of each triangle: facet normal, outer loop, three vertices, endloop, endfacet.
MeshText read_text_stl(std::string_view text) {
  MeshBuilder mesh;
  LineReader lines(text);
  std::vector<int> corner;
  std::string facet;
  bool open = false, ended = false;
  while (lines.next()) {
    const std::vector<std::string> words = lines.words();
    const std::string& first = words.front();
    if (first == "facet") {
      require(!open, "{}: a facet begins within another one: 'endfacet' is missing before it", lines.place());
      open = true, facet = lines.place();
      corner.clear();
    } else if (first == "vertex") {
      require(open && words.size() == 4,
              "{}: 'vertex' stands within a facet and has three numbers, as in 'vertex 0 0 1'",
              lines.place());
      Vec<3> x;
      for (int k = 0; k < 3; ++k) x[k] = number_of(words[static_cast<std::size_t>(k) + 1], lines.place());
      corner.push_back(mesh.vertex(x, lines.place()));
    } else if (first == "endfacet") {
      require(open && corner.size() == 3, "{}: the facet that ends here has {} vertices instead of 3",
              lines.place(), corner.size());
      mesh.polygon(corner, facet);
      open = false;
    } else if (first == "endsolid") {
      ended = true;
    } else {
      require(
          first == "solid" || first == "outer" || first == "endloop",
          "{}: '{}' is no word of an STL file in text; a binary one has 84 bytes and 50 for each triangle",
          lines.place(), first.substr(0, 20));
    }
  }
  require(!open && ended, "{}: the file ends {}: it is cut off; copy it again", lines.place(),
          open ? "within a facet" : "without 'endsolid'");
  return mesh.take();
}

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < stl_header) return false;
  const std::size_t count = little_endian(bytes, 80);
  if (bytes.size() == stl_header + stl_triangle * count) return true;
  constexpr std::size_t begin = 1000;  // of a text, which has no zeros
  return !bytes.starts_with("solid") || bytes.substr(0, begin).find('\0') != std::string_view::npos;
}

}  // namespace

double number_of(const std::string& word, const std::string& place) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  require(!word.empty() && end == word.c_str() + word.size(), "{}: '{}' is not a number", place,
          word.substr(0, 20));
  return number;
}

MeshText read_mesh(std::string_view bytes) {
  if (bytes.starts_with("ply")) return read_ply(bytes);
  if (is_binary_stl(bytes)) return read_binary_stl(bytes);
  require(
      bytes.starts_with("solid"),
      "line 1: neither STL, which begins with 'solid' or is binary, nor PLY, which begins with 'ply'; save "
      "the surface in one of these formats");
  return read_text_stl(bytes);
}

}  // namespace softgrain
