#include <doctest/doctest.h>
#include <zlib.h>

#include <cstring>
#include <string>

#include "softgrain/io/format/vtp_writer.hpp"

using namespace softgrain;

namespace {

/// Reads one array of a .vtp file as the format is specified by VTK, not as we write it: any number of
/// blocks.
template <class T>
std::vector<T> vtp_array(const std::string& file, const std::string& name) {
  const auto tag = file.find("Name=\"" + name + "\"");
  REQUIRE(tag != std::string::npos);
  const std::string attribute = "offset=\"";
  const auto offset = std::stoull(file.substr(file.find(attribute, tag) + attribute.size()));
  const std::string marker = "<AppendedData encoding=\"raw\">\n_";
  const char* at = file.data() + file.find(marker) + marker.size() + offset;
  const auto next = [&at] {
    std::uint64_t number = 0;
    std::memcpy(&number, at, sizeof number);
    at += sizeof number;
    return number;
  };
  const std::uint64_t blocks = next(), block_size = next(), last_size = next();
  std::vector<std::uint64_t> packed(blocks);
  for (auto& size : packed) size = next();
  std::string raw;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    std::string piece(b + 1 == blocks && last_size > 0 ? last_size : block_size, '\0');
    uLongf size = piece.size();
    REQUIRE(uncompress(reinterpret_cast<Bytef*>(piece.data()), &size, reinterpret_cast<const Bytef*>(at),
                       packed[b]) == Z_OK);
    REQUIRE(size == piece.size());
    raw += piece;
    at += packed[b];
  }
  std::vector<T> values(raw.size() / sizeof(T));
  if (!raw.empty()) std::memcpy(values.data(), raw.data(), raw.size());
  return values;
}

Scene three_disks() {
  Scene scene;
  scene.particles["position"] = {2, std::vector<double>{0, 0, 2, 0.5, 4, 0}};
  scene.particles["radius"] = {1, std::vector<double>{1, 1e-40, 3}};
  scene.particles["velocity"] = {2, std::vector<double>{1, 2, 3, 4, 5, 6}};
  scene.particles["cluster"] = {1, std::vector<std::int64_t>{7, 8, 1LL << 40}};
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{0, 1, 2, 3, 2, 1}};  // the middle one is with a wall
  scene.contacts["force"] = {1, std::vector<double>{10, 20, 30}};
  scene.wall_segments = {-1, 0, 1, 0, -1, 9, 1, 9};
  return scene;
}

}  // namespace

TEST_CASE("ParaView's particles are points in space with their fields as float32, denormals flushed") {
  const Scene disks = three_disks();
  const std::string file = encode_vtp(rows_of_particles(disks));
  CHECK(file.find("NumberOfPoints=\"3\" NumberOfVerts=\"3\" NumberOfLines=\"0\"") != std::string::npos);
  CHECK(file.find("header_type=\"UInt64\"") != std::string::npos);
  CHECK(vtp_array<float>(file, "position") == std::vector<float>{0, 0, 0, 2, 0.5F, 0, 4, 0, 0});
  CHECK(vtp_array<float>(file, "velocity") == std::vector<float>{1, 2, 0, 3, 4, 0, 5, 6, 0});
  CHECK(file.find("Name=\"velocity\" NumberOfComponents=\"3\"") != std::string::npos);
  CHECK(vtp_array<float>(file, "radius") == std::vector<float>{1, 0, 3});
  CHECK(vtp_array<std::int64_t>(file, "cluster") == std::vector<std::int64_t>{7, 8, 1LL << 40});
  CHECK(vtp_array<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{1, 2, 3});
}

TEST_CASE("ParaView's arrays of more than a block come back whole") {
  std::vector<double> x;
  for (int k = 0; k < 400000; ++k) x.push_back(k % 1000 / 7.0);
  Scene scene;
  scene.particles["position"] = {2, x};
  const std::vector<float> position = vtp_array<float>(encode_vtp(rows_of_particles(scene)), "position");
  REQUIRE(position.size() == 600000);
  for (int k = 0; k < 200000; ++k)
    REQUIRE((position[3 * k] == static_cast<float>(x[2 * k]) && position[3 * k + 2] == 0));
}

TEST_CASE("ParaView's contacts are lines between particles with their force, without the other particles") {
  Scene scene = three_disks();
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{2, 1}};
  scene.contacts["force"] = {1, std::vector<double>{10}};
  CHECK(vtp_array<float>(encode_vtp(contacts_of(scene, rows_of_particles(scene))), "position") ==
        std::vector<float>{4, 0, 0, 2, 0.5F, 0});

  const Scene disks = three_disks();
  const std::string file = encode_vtp(contacts_of(disks, rows_of_particles(disks)));
  CHECK(file.find("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"2\"") != std::string::npos);
  CHECK(vtp_array<std::int64_t>(file, "connectivity") == std::vector<std::int64_t>{0, 1, 2, 1});
  CHECK(vtp_array<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{2, 4});
  CHECK(vtp_array<float>(file, "force") == std::vector<float>{10, 30});
}

TEST_CASE("ParaView's contacts between grains join their centres, or a centre and the place at a wall") {
  Scene scene;  // a grain of three points, one of them four times as large as the others, and a grain of one
  scene.particles["position"] = {2, std::vector<double>{0, 0, 3, 0, 3, 3, 10, 10}};
  scene.particles["radius"] = {1, std::vector<double>{1, 2, 1, 1}};
  scene.particles["grain"] = {1, std::vector<std::int64_t>{0, 0, 0, 1}};
  scene.contacts["pair"] = {2, std::vector<std::int64_t>{0, 1, 0, 3}};  // 2 and 3 are walls
  scene.contacts["force"] = {1, std::vector<double>{10, 20}};
  scene.contacts["position"] = {2, std::vector<double>{5, 5, -1, 0.5}};
  const std::string file = encode_vtp(contacts_of(scene, rows_of_particles(scene)));
  CHECK(vtp_array<float>(file, "position") == std::vector<float>{2.5F, 0.5F, 0, 10, 10, 0, -1, 0.5F, 0});
  CHECK(vtp_array<std::int64_t>(file, "connectivity") == std::vector<std::int64_t>{0, 1, 0, 2});
  CHECK(vtp_array<float>(file, "force") == std::vector<float>{10, 20});
}

TEST_CASE("ParaView's walls are one line each, and a scene without contacts is no error") {
  const std::string walls = encode_vtp(walls_of(three_disks()));
  CHECK(vtp_array<float>(walls, "position") == std::vector<float>{-1, 0, 0, 1, 0, 0, -1, 9, 0, 1, 9, 0});
  CHECK(vtp_array<std::int64_t>(walls, "connectivity") == std::vector<std::int64_t>{0, 1, 2, 3});
  CHECK(vtp_array<float>(encode_vtp(contacts_of({}, {})), "position").empty());
}

TEST_CASE("the collection names every part of every frame with its time") {
  const std::string text = pvd_text({{0, "000000"}, {0.5, "000123"}}, "vtk");
  CHECK(text.find(R"(timestep="0.5" part="1" name="contacts" file="vtk/contacts_000123.vtp")") !=
        std::string::npos);
}
