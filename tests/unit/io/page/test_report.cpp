#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/compress.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "softgrain/io/page/report_chains.hpp"
#include "softgrain/io/page/report_codec.hpp"
#include "softgrain/io/page/report_frame.hpp"
#include "softgrain/io/page/report_page.hpp"
#include "softgrain/io/page/report_run.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;
using softgrain::test::read_text;
using softgrain::test::TemporaryDirectory;

namespace {

/// The numbers behind byte planes of zigzag differences, as the page decodes them.
std::vector<std::uint64_t> decode(const std::string& planes, std::size_t count, std::size_t stride,
                                  int bytes) {
  std::vector<std::uint64_t> q;
  const std::uint64_t modulus = std::uint64_t{1} << 8 * bytes;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t code = 0;
    for (int plane = bytes - 1; plane >= 0; --plane)
      code = 256 * code + static_cast<unsigned char>(planes.at(static_cast<std::size_t>(plane) * count + i));
    const std::uint64_t difference = code % 2 == 0 ? code / 2 : modulus - (code + 1) / 2;
    q.push_back((difference + (i < stride ? 0 : q[i - stride])) % modulus);
  }
  return q;
}

std::string gunzip(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  z_stream stream{};
  REQUIRE(inflateInit2(&stream, 15 + 16) == Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  inflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

/// A payload taken apart.
struct Unpacked {
  nlohmann::json header;
  std::string planes;

  explicit Unpacked(const std::string& payload) {
    const std::string bytes = gunzip(payload, 1 << 22);
    std::size_t size = 0;
    for (int k = 3; k >= 0; --k) size = 256 * size + static_cast<unsigned char>(bytes.at(k));
    header = nlohmann::json::parse(bytes.substr(4, size));
    planes = bytes.substr(4 + size);
  }

  /// All values of a column, one frame after another; none where it is missing.
  std::vector<double> column(const std::string& name) const {
    std::size_t begin = 0;
    for (const auto& info : header.at("arrays")) {
      const std::size_t count = info["count"];
      const int bytes = info["bytes"];
      if (info["name"] == name) {
        std::vector<double> values;
        for (const std::uint64_t q : decode(planes.substr(begin), count, info["stride"], bytes))
          values.push_back(info["low"].get<double>() + info["step"].get<double>() * static_cast<double>(q));
        return values;
      }
      begin += count * static_cast<std::size_t>(bytes);
    }
    return {};
  }
};

/// Polygon of a grain about a point; vertex k at angle 2 pi k / n.
void add_grain(Scene& scene, std::int64_t grain, double x, double y, double radius) {
  auto& position = std::get<std::vector<double>>(scene.outlines["position"].values);
  auto& force = std::get<std::vector<double>>(scene.outlines["force"].values);
  if (!scene.outlines.contains("grain")) scene.outlines["grain"] = {1, std::vector<std::int64_t>{}};
  auto& owner = std::get<std::vector<std::int64_t>>(scene.outlines["grain"].values);
  scene.outlines["position"].columns = scene.outlines["force"].columns = 2;
  constexpr int vertices = 32;
  for (int k = 0; k < vertices; ++k) {
    const double angle = 2 * std::numbers::pi * k / vertices;
    position.insert(position.end(), {x + radius * std::cos(angle), y + radius * std::sin(angle)});
    force.insert(force.end(), {0.0, 0.0});
    owner.push_back(grain);
  }
}

/// Two grains of radius 1 that touch at x = 1, above a floor at y = -1, with four points each.
Scene two_grains() {
  Scene scene;
  add_grain(scene, 0, 0, 0, 1);
  add_grain(scene, 1, 2, 0, 1);
  auto& force = std::get<std::vector<double>>(scene.outlines["force"].values);
  force[0] = -30;             // on grain 0 at angle 0, from grain 1
  force[2 * (32 + 16)] = 20;  // on grain 1 at angle pi, from grain 0
  force[2 * 24 + 1] = 7;      // on grain 0 at angle -pi/2, from the floor
  scene.wall_segments = {-2, -1, 4, -1};
  scene.particles["position"] = {2, std::vector<double>{-.1, 0, .1, 0, 0, .1, 0, -.1,  //
                                                        1.9, 0, 2.1, 0, 2, .1, 2, -.1}};
  scene.particles["radius"] = {1, std::vector<double>(8, 0.1)};
  scene.particles["pressure"] = {1, std::vector<double>{1e5, 3e5, 2e5, 2e5, 4e5, 4e5, 4e5, 4e5}};
  scene.particles["grain"] = {1, std::vector<std::int64_t>{0, 0, 0, 0, 1, 1, 1, 1}};
  return scene;
}

/// A run's directory with these scenes as its snapshots.
RunPaths run_of(const TemporaryDirectory& folder, const std::vector<Scene>& scenes) {
  const RunPaths paths{folder.path()};
  std::filesystem::create_directories(paths.snapshot_folder());
  folder.file("run.json", R"({"state": "done", "message": "a </script> in between"})");
  folder.file("series.csv", "step,time[s],strain\n0,0,0\n1,0.5,0.1\n2,1,0.2");
  for (std::size_t k = 0; k < scenes.size(); ++k)
    write_snapshot(paths.snapshot_folder() / fmt::format("s{:06}.h5", k),
                   {.case_text = "",
                    .checkpoint = {.step = static_cast<std::int64_t>(k),
                                   .time = 0.5 * static_cast<double>(k),
                                   .arrays = {}},
                    .scene = scenes[k],
                    .report = {},
                    .sums = {}});
  return paths;
}

}  // namespace

TEST_CASE("whole numbers of every width come back from byte planes, also where differences wrap around") {
  const std::vector<std::uint32_t> bytes{0, 255, 1, 128, 127, 0, 255, 7},
      shorts{0, 65535, 1, 32768, 40000, 3}, longs{0, 4294967295U, 2147483648U, 5, 70000, 1};
  for (const std::size_t stride : {1U, 2U, 5U})
    for (const auto& [q, width] : {std::pair{bytes, 1}, {shorts, 2}, {longs, 4}}) {
      const std::string planes = encode_whole(q, stride, width);
      CHECK(planes.size() == q.size() * static_cast<std::size_t>(width));
      const auto back = decode(planes, q.size(), stride, width);
      CHECK(std::vector<std::uint32_t>(back.begin(), back.end()) == q);
    }
}

TEST_CASE("differences of 0, -1, 1, -2 have the codes 0, 1, 2, 3, lowest bytes first") {
  CHECK(encode_whole(std::vector<std::uint32_t>{9, 9, 8, 9, 7}, 1, 2) ==
        std::string("\x12\0\1\2\3\0\0\0\0\0", 10));
}

TEST_CASE("reals come back within half a step, and what is not finite as the smallest") {
  std::vector<float> values;
  for (int i = 0; i < 500; ++i) values.push_back(static_cast<float>(std::sin(0.1 * i) - 3));
  values[100] = std::nanf("");
  for (const double step : {0.0, 1e-4, 0.02}) {
    const EncodedArray array = encode_reals(values, 50, step);
    CHECK(array.bytes == (step == 0.02 ? 1 : 2));
    const auto q = decode(array.planes, array.count, 50, array.bytes);
    CHECK(q[100] == 0);
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double value = array.low + array.step * static_cast<double>(q[i]);
      if (i != 100) CHECK(std::fabs(value - values[i]) <= 0.5001 * array.step + 1e-7);
    }
  }
  CHECK(encode_reals({}, 1, 0).count == 0);
}

TEST_CASE("base64 is that of RFC 4648 and gzip that of zlib") {
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
  const std::string text(100000, 'x');
  const std::string packed = compressed(text, Container::gzip, 6);
  CHECK(gunzip(packed, 200000) == text);
  CHECK(packed.size() < 1000);
}

TEST_CASE("forces on outlines are those between the nearest grains and walls, the mean of both sides") {
  const auto chains = chains_between_outlines(two_grains());
  REQUIRE(chains.size() == 2);
  CHECK(chains[0].a == 0);
  CHECK(chains[0].b == 1);
  CHECK(chains[0].force == doctest::Approx(25));  // |-30 - 20| / 2
  CHECK(chains[1].a == 0);
  CHECK(chains[1].b == 2);  // the floor
  CHECK(chains[1].force == doctest::Approx(7));
}

TEST_CASE("a frame has each grain's area, centroid and mean pressure") {
  const ReportFrame frame = frame_of(two_grains());
  const double area = 16 * std::sin(2 * std::numbers::pi / 32);  // of a regular polygon with 32 vertices
  CHECK(frame.columns.at("grain.area")[1] == doctest::Approx(area));
  CHECK(frame.columns.at("grain.x")[1] == doctest::Approx(2));
  CHECK(std::fabs(frame.columns.at("grain.y")[1]) < 1e-6F);
  CHECK(frame.columns.at("grain.pressure")[0] == doctest::Approx(2e5));
  CHECK(frame.columns.at("outline.x")[32] == doctest::Approx(1));  // from the centroid
  CHECK(frame.columns.at("particle.x")[4] == doctest::Approx(-0.1));
}

TEST_CASE("points merge in fours within a grain, keeping their area, and not across grains") {
  ReportFrame frame = frame_of(two_grains());
  CHECK_FALSE(can_merge(frame, 8));
  REQUIRE(can_merge(frame, 4));
  merge_particles(frame, 4);
  CHECK(frame.columns.at("particle.pressure") == std::vector<float>{2e5F, 4e5F});
  CHECK(frame.columns.at("particle.grain") == std::vector<float>{0, 1});
  CHECK(frame.columns.at("particle.radius")[0] == doctest::Approx(0.2));
}

TEST_CASE("a run's payload holds its frames, provenance and series, without a torn last row") {
  const TemporaryDirectory folder;
  std::vector<Scene> scenes(3, two_grains());
  for (double& y : scenes[2].wall_segments) y -= 0.25;
  const ReportRun run = encode_run(run_of(folder, scenes), "press");
  CHECK(run.frames == 3);
  CHECK(run.warnings.empty());
  const Unpacked page(run.payload);
  CHECK(page.header.at("name") == "press");
  CHECK(page.header.at("run").at("state") == "done");
  CHECK(page.header.at("series") == "step,time[s],strain\n0,0,0\n1,0.5,0.1\n");
  CHECK(page.header.at("times") == std::vector<double>{0, 0.5, 1});
  CHECK(page.header.at("contacts") == std::vector<int>{2, 2, 1});  // the floor leaves
  CHECK(page.header.at("points_merged") == 4);
  CHECK(page.column("contact.b") == std::vector<double>{1, 2, 1, 2, 1});
  const auto floor = page.column("wall.y0");
  REQUIRE(floor.size() == 3);
  CHECK(floor[1] == doctest::Approx(-1).epsilon(1e-4));
  CHECK(floor[2] == doctest::Approx(-1.25).epsilon(1e-4));
  CHECK(page.column("particle.pressure").size() == 2);  // never changes: once
}

TEST_CASE("a damaged snapshot is left out with a warning") {
  const TemporaryDirectory folder;
  const RunPaths paths = run_of(folder, {two_grains(), two_grains(), two_grains()});
  folder.file("snap/s000001.h5", "no snapshot");
  const ReportRun run = encode_run(paths, "press");
  CHECK(run.frames == 2);
  REQUIRE(run.warnings.size() == 1);
  CHECK(run.warnings[0].find("s000001.h5") != std::string::npos);
  CHECK(Unpacked(run.payload).header.at("steps") == std::vector<int>{0, 2});
}

TEST_CASE(
    "primaries beyond the limit are shown at fewer times, and long series in fewer rows, the last among "
    "them") {
  const TemporaryDirectory folder;
  std::vector<Scene> scenes(8);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    scenes[k].particles["position"] = {2, std::vector<double>{0.1 * static_cast<double>(k), 0, 1, 1}};
    scenes[k].particles["radius"] = {1, std::vector<double>{0.1, 0.2}};
  }
  const RunPaths paths = run_of(folder, scenes);
  folder.file("series.csv", "step\n0\n1\n2\n3\n4\n");
  const Unpacked page(encode_run(paths, "press", {.particles = 6, .contacts = 10, .rows = 2}).payload);
  CHECK(page.header.at("steps") == std::vector<int>{0, 3, 6, 7});
  CHECK(page.header.at("snapshots_every") == 3);
  CHECK(page.header.at("series") == "step\n0\n3\n4\n");
}

TEST_CASE("a page holds the title, escaped, and each payload, and nothing can end its script early") {
  const auto page =
      report_text("<title><!--title--></title>|<!--runs-->|", "a<b & c", {"\x01\x02\x03", "foobar"});
  CHECK(
      page ==
      "<title>a&lt;b &amp; c</title>|<script type=\"application/octet-stream\" class=\"run\">AQID</script>\n"
      "<script type=\"application/octet-stream\" class=\"run\">Zm9vYmFy</script>\n|");
}

TEST_CASE("the page inside the program is the committed one and asks nothing of the network") {
  CHECK(report_template ==
        read_text(std::string(SOFTGRAIN_SOURCE_DIR) + "/viewer/dist/report_template.html"));
  CHECK(report_template.find("default-src 'none'") != std::string_view::npos);
  for (const char* outside : {"src=\"http", "href=\"http", "url(http", "@import"})
    CHECK(report_template.find(outside) == std::string_view::npos);
}

TEST_CASE("what is not a run is refused with what to do, and leaves no page") {
  const TemporaryDirectory folder;
  const auto page = folder.path() / "page.html";
  CHECK_THROWS_AS(write_report({folder.path() / "nowhere"}, page), UsageError);
  CHECK_THROWS_AS(write_report({folder.path()}, page), UsageError);
  folder.file("run.json", "{}");
  CHECK_THROWS_WITH_AS(write_report({folder.path()}, page), doctest::Contains("no snapshots"), UsageError);
  folder.file("run.json", "torn {");
  CHECK_THROWS_AS(write_report({folder.path()}, page), UsageError);
  CHECK_FALSE(std::filesystem::exists(page));
}
