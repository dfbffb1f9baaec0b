#include "softgrain/io/format/mesh_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

#include "support/meshes.hpp"

using namespace softgrain;

namespace {

using test::text_stl;

template <class T>
std::string bytes_of(T value, bool big = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big) bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes = "solid, says a program that writes binary files";
  bytes.resize(80, ' ');
  bytes += bytes_of(static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    bytes.append(12, '\0');
    for (const int v : t)
      for (int k = 0; k < 3; ++k)
        bytes += bytes_of(static_cast<float>(mesh.vertex[static_cast<std::size_t>(v)][k]));
    bytes.append(2, '\0');
  }
  return bytes;
}

enum class Ply { text, little, big };

/// With a colour of each vertex, quads where two triangles come from one, and an element that is no one's.
std::string ply(const TriangleMesh& mesh, Ply format) {
  const bool big = format == Ply::big, text = format == Ply::text;
  const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  std::string out = fmt::format(
      "ply\nformat {} 1.0\ncomment made here\nelement vertex {}\nproperty uchar red\nproperty double x\n"
      "property float y\nproperty double z\nelement mark 1\nproperty list uchar short numbers\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      names[static_cast<int>(format)], mesh.vertex.size(), mesh.triangle.size());
  for (const Vec<3>& x : mesh.vertex)
    out += text
               ? fmt::format("200 {} {} {}\n", x[0], x[1], x[2])
               : "\xc8" + bytes_of(x[0], big) + bytes_of(static_cast<float>(x[1]), big) + bytes_of(x[2], big);
  out += text ? "2 -7 8\n" : "\x02" + bytes_of(std::int16_t{-7}, big) + bytes_of(std::int16_t{8}, big);
  for (const auto& t : mesh.triangle)
    out += text ? fmt::format("3 {} {} {}\n", t[0], t[1], t[2])
                : "\x03" + bytes_of(t[0], big) + bytes_of(t[1], big) + bytes_of(t[2], big);
  return out;
}

std::string refusal(const std::string& bytes) {
  try {
    read_mesh(bytes);
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

bool says(const std::string& bytes, const std::string& words) {
  return refusal(bytes).find(words) != std::string::npos;
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  return text.replace(text.find(old), old.size(), replacement);
}

}  // namespace

TEST_CASE("a cube reads the same from STL and PLY, in text and binary, of either byte order") {
  const TriangleMesh cube = test::cube_mesh(0.5, {1, 2, 3});
  for (const std::string& bytes : {text_stl(cube), binary_stl(cube), ply(cube, Ply::text),
                                   ply(cube, Ply::little), ply(cube, Ply::big)}) {
    const MeshText read = read_mesh(bytes);
    CHECK(read.mesh.vertex.size() == 8);
    REQUIRE(read.mesh.triangle.size() == 12);
    CHECK(read.place.size() == 12);
    const StarSurface surface(read.mesh);
    CHECK(norm(surface.centre() - Vec<3>{1, 2, 3}) < 1e-12);
    CHECK(std::abs(surface.reach() / (0.5 * std::sqrt(3)) - 1) < 1e-12);
  }
  CHECK(read_mesh(text_stl(cube)).place[1] == "line 9");
  CHECK(read_mesh(binary_stl(cube)).place[1] == "byte 134");
  CHECK(read_mesh(ply(cube, Ply::text)).place[0] == "line 23");
}

TEST_CASE("faces of more corners become triangles, and those without area are left out") {
  const std::string box =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 7\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n3 0 0 1\n";
  const MeshText read = read_mesh(box);
  CHECK(read.mesh.triangle.size() == 12);
  CHECK(std::abs(StarSurface(read.mesh).volume() - 8 / std::pow(3, 1.5)) < 1e-12);
}

TEST_CASE("a damaged mesh is refused with its line or byte") {
  const TriangleMesh cube = test::cube_mesh(0.5);
  const std::string text = text_stl(cube), binary = binary_stl(cube), in_ply = ply(cube, Ply::text);
  CHECK(says(with(text, "vertex -0.5 -0.5 -0.5", "vertex -0.5 half -0.5"), "line 4: 'half' is not a number"));
  CHECK(says(with(text, "vertex -0.5 -0.5 -0.5", "vertex -0.5 -0.5"), "line 4: 'vertex' stands within"));
  CHECK(says(with(text, "vertex -0.5 -0.5 -0.5", "vertex nan 0 0"), "line 4: a coordinate is not a finite"));
  CHECK(says(with(text, "endfacet\n", ""), "line 8: a facet begins within another one"));
  CHECK(says(with(text, "outer loop", "outer lop\nloop"), "line 4: 'loop' is no word"));
  CHECK(says(text.substr(0, text.rfind("endfacet")), "within a facet: it is cut off"));
  CHECK(says(binary.substr(0, 200), "byte 200: the file ends within triangle 3 of the 12"));
  CHECK(says(with(in_ply, "3 0 2 1", "3 0 2 8"), "line 23: a face names vertex 8, but there are 8"));
  CHECK(says(with(in_ply, "3 0 2 1", "2 0 2"), "line 23: a face has 2 corners"));
  CHECK(says(with(in_ply, "200 ", ""), "line 14: the line has fewer numbers"));
  CHECK(says(with(in_ply, "end_header", "end"), "the header has no 'end_header'"));
  CHECK(says(with(in_ply, "property double z\n", ""), "the header names no property z"));
  CHECK(says(with(in_ply, "property double z", "property number z"), "line 8: 'number' is no type"));
  CHECK(says("a table", "line 1: neither STL"));
  CHECK(says(with(ply(cube, Ply::big), "element vertex 8", "element vertex 9"), "byte "));
}

TEST_CASE("no beginning of a mesh, and no changed byte, does more than a refusal") {
  const TriangleMesh cube = test::cube_mesh(0.5);
  for (const std::string& whole : {text_stl(cube), binary_stl(cube), ply(cube, Ply::text),
                                   ply(cube, Ply::little), ply(cube, Ply::big)}) {
    for (std::size_t size = 0; size + 12 < whole.size(); size += 3)
      CHECK_FALSE(refusal(whole.substr(0, size)).empty());
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ 0x55);
      refusal(changed);
    }
  }
}
