#include <doctest/doctest.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <numeric>
#include <random>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/format/snapshot.hpp"
#include "support/file_size_limit.hpp"
#include "support/temporary_directory.hpp"

using namespace softgrain;

namespace {

std::vector<double> ramp(std::size_t size) {
  std::vector<double> values(size);
  std::iota(values.begin(), values.end(), 1.0 / 3);
  return values;
}

Snapshot small_snapshot() {
  Snapshot snapshot;
  snapshot.case_text = "[grain]\nradius = 0.005\n";
  snapshot.checkpoint = {.step = 123, .time = 0.1, .arrays = {}};
  snapshot.checkpoint.arrays["position"] = {2, ramp(40)};
  snapshot.checkpoint.arrays["contact/id"] = {1, std::vector<std::int64_t>{3, -1, 1LL << 62}};
  snapshot.checkpoint.arrays["contact/impulse"] = {3, std::vector<double>{}};
  snapshot.scene.particles["radius"] = {1, ramp(20)};
  snapshot.scene.contacts["pair"] = {2, std::vector<std::int64_t>{0, 1, 1, 2}};
  snapshot.scene.wall_segments = {0, 0, 1, 0};
  snapshot.report = {
      .steps = 123, .steps_converged = 120, .sweeps = 2000, .residual_max = 3e-4, .overlap_max = 1e-5};
  snapshot.sums = {.steps = 3,
                   .sweeps = 9,
                   .residual_mean = 1e-6,
                   .residual_max = 2e-6,
                   .overlap_mean = 0.1,
                   .overlap_max = 0.3};
  snapshot.wall_seconds = 12.5;
  snapshot.cpu_seconds = 11.5;
  return snapshot;
}

bool same(const std::map<std::string, Array>& a, const std::map<std::string, Array>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.first == y.first && x.second.columns == y.second.columns &&
                  x.second.values == y.second.values;
         });
}

bool same(const Snapshot& a, const Snapshot& b) {
  const auto totals = [](const Snapshot& s) {
    return std::tuple(s.case_text, s.checkpoint.step, s.checkpoint.time, s.wall_seconds, s.cpu_seconds,
                      s.report.steps, s.report.steps_converged, s.report.sweeps, s.report.residual_max,
                      s.report.overlap_max, s.scene.wall_segments);
  };
  const auto sums = [](const Snapshot& s) {
    return std::tuple(s.sums.steps, s.sums.sweeps, s.sums.residual_mean, s.sums.residual_max,
                      s.sums.overlap_mean, s.sums.overlap_max);
  };
  return totals(a) == totals(b) && sums(a) == sums(b) && same(a.checkpoint.arrays, b.checkpoint.arrays) &&
         same(a.scene.particles, b.scene.particles) && same(a.scene.contacts, b.scene.contacts);
}

bool refused(const std::string& bytes) {
  try {
    decode_snapshot(bytes, "snapshot");
    return false;
  } catch (const IoError&) {
    return true;
  }
}

std::string hash_of_bytes(const std::string& bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string hash_of(const Snapshot& snapshot) {
  return Hdf5Reader(encode_snapshot(snapshot, "a"), "a").text_attribute("content_hash");
}

}  // namespace

TEST_CASE("a snapshot gives back every number, shape and name that it was given") {
  const Snapshot original = small_snapshot();
  CHECK(same(decode_snapshot(encode_snapshot(original, "a"), "a"), original));
}

TEST_CASE("no flipped bit of a snapshot is accepted") {
  const std::string bytes = encode_snapshot(small_snapshot(), "a");
  std::mt19937 random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    CHECK(refused(damaged));
  }
}

TEST_CASE("no snapshot that was cut short, lengthened or overwritten is accepted") {
  const std::string bytes = encode_snapshot(small_snapshot(), "a");
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial) CHECK(refused(bytes.substr(0, random() % bytes.size())));
  for (int trial = 0; trial < 200; ++trial) {
    std::string damaged = bytes;
    const std::size_t length = 1 + random() % 64, begin = random() % (bytes.size() - length);
    for (std::size_t k = 0; k < length; ++k) damaged[begin + k] ^= static_cast<char>(1 + random() % 255);
    CHECK(refused(damaged));
  }
  CHECK(refused(bytes + "0"));
  CHECK(refused(""));
}

TEST_CASE(
    "damaged values behind a forged hash are found by HDF5's checksums or by the hash of the contents") {
  const std::string bytes = encode_snapshot(small_snapshot(), "a");
  const std::string contents = bytes.substr(0, bytes.size() - 32);
  const std::vector<double> position = ramp(40);
  const std::string values(reinterpret_cast<const char*>(position.data()), 8 * position.size());
  const std::size_t begin = contents.find(values);
  REQUIRE(begin != std::string::npos);
  std::mt19937 random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    std::string damaged = contents;
    damaged[begin + random() % values.size()] ^= static_cast<char>(1 << random() % 8);
    damaged += hash_of_bytes(damaged);
    CHECK(refused(damaged));
  }
}

TEST_CASE("the content hash is XXH3-128 over path, type, shape and values of each dataset in order") {
  Snapshot snapshot = small_snapshot();
  const std::string file = encode_snapshot(snapshot, "a");
  const Hdf5Reader reader(file, "a");
  std::string stream;
  const auto add = [&stream](const void* data, std::size_t size) {
    stream.append(static_cast<const char*>(data), size);
  };
  for (const std::string& path : reader.datasets()) {
    const Array array = reader.read(path);
    add(path.c_str(), path.size() + 1);
    stream += array.values.index() == 0 ? 'f' : 'i';
    std::visit(
        [&](const auto& values) {
          const std::uint64_t shape[2] = {values.size() / array.columns, array.columns};
          add(shape, sizeof shape);
          add(values.data(), 8 * values.size());
        },
        array.values);
  }
  CHECK(reader.text_attribute("content_hash") == hash_of_bytes(stream));
  CHECK(file.ends_with(hash_of_bytes(file.substr(0, file.size() - 32))));
}

TEST_CASE("the content hash knows the state, not how long it took") {
  const Snapshot original = small_snapshot();
  Snapshot slower = original, other = original;
  slower.wall_seconds += 1;
  slower.cpu_seconds += 1;
  std::get<std::vector<double>>(other.checkpoint.arrays["position"].values)[7] = std::nextafter(7.0, 8.0);
  CHECK(hash_of(slower) == hash_of(original));
  CHECK(hash_of(other) != hash_of(original));
}

TEST_CASE("a snapshot that does not fit on the disk leaves the one before it and nothing else") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "s000123.h5";
  const Snapshot original = small_snapshot();
  write_snapshot(path, original);
  Snapshot larger = original;
  larger.checkpoint.arrays["position"] = {2, ramp(4000)};
  std::string message;
  try {
    const test::FileSizeLimit limit(16384);
    write_snapshot(path, larger);
  } catch (const IoError& error) {
    message = error.what();
  }
  const auto bytes = encode_snapshot(larger, path.string()).size();
  CHECK(message.find(fmt::format("{}: cannot write {} bytes", path.string(), bytes)) == 0);
  CHECK(same(read_snapshot(path), original));
  const auto files = std::filesystem::directory_iterator(directory.path());
  CHECK(std::distance(begin(files), end(files)) == 1);
}

namespace {

/// Particles that come in parts of these numbers of rows, as an array of numbers that go up.
ParticleParts in_parts(const std::vector<std::size_t>& rows) {
  const std::size_t all = std::accumulate(rows.begin(), rows.end(), std::size_t{0});
  ParticleParts parts;
  parts.count = static_cast<int>(rows.size());
  parts.arrays["stress"] = {.rows = all, .columns = 4};
  parts.arrays["grain"] = {.rows = all, .columns = 1, .integers = true};
  parts.rows = [rows](int part) {
    const std::size_t first = std::accumulate(rows.begin(), rows.begin() + part, std::size_t{0});
    const std::vector<double> whole = ramp(4 * (first + rows[part]));
    Arrays arrays;
    arrays["stress"] = {
        4, std::vector<double>(whole.begin() + static_cast<std::ptrdiff_t>(4 * first), whole.end())};
    arrays["grain"] = {1, std::vector<std::int64_t>(rows[part], part)};
    return arrays;
  };
  return parts;
}

}  // namespace

TEST_CASE("particles that come in parts are those of a snapshot that had them whole") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "s000123.h5";
  const std::vector<std::size_t> rows{70000, 1, 0, 3, 40000};  // chunks have 32768 rows of stress
  const std::size_t all = 110004;
  Snapshot whole = small_snapshot();
  whole.scene.particles = {};
  write_snapshot(path, whole, {.particles = in_parts(rows)});
  whole.scene.particles["stress"] = {4, ramp(4 * all)};
  std::vector<std::int64_t> grain(70000, 0);
  for (const auto& [part, count] : {std::pair{1, 1}, {3, 3}, {4, 40000}})
    grain.insert(grain.end(), static_cast<std::size_t>(count), part);
  whole.scene.particles["grain"] = {1, grain};
  CHECK(same(read_snapshot(path), whole));
  CHECK(Hdf5Reader(path).text_attribute("content_hash") == hash_of(whole));
}

TEST_CASE("a snapshot whose parts are not all there, or whose maker fails, leaves nothing") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "s000123.h5";
  ParticleParts parts = in_parts({5, 5});
  const auto rows = parts.rows;
  parts.rows = [&](int part) { return part == 0 ? rows(part) : Arrays{}; };
  CHECK_THROWS_AS(write_snapshot(path, small_snapshot(), {.particles = parts}), IoError);
  parts.rows = [](int) -> Arrays { throw NumericalError("no stress"); };
  CHECK_THROWS_WITH_AS(write_snapshot(path, small_snapshot(), {.particles = parts}), "no stress",
                       NumericalError);
  {
    const test::FileSizeLimit limit(16384);
    CHECK_THROWS_AS(write_snapshot(path, small_snapshot(), {.particles = in_parts({70000})}), IoError);
  }
  CHECK(std::filesystem::is_empty(directory.path()));
}

TEST_CASE("who reads what a run needs to go on checks the scene without taking it") {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "s000123.h5";
  write_snapshot(path, small_snapshot());
  const Snapshot snapshot = read_snapshot(path, SnapshotParts::to_go_on);
  CHECK(same(snapshot.checkpoint.arrays, small_snapshot().checkpoint.arrays));
  CHECK(snapshot.report.sweeps == 2000);
  CHECK(snapshot.scene.particles.empty());
}

TEST_CASE("a snapshot of a later format, or with contents that are not those of its hash, is refused") {
  const auto snapshot_of_version = [](std::int64_t version) {
    Hdf5Writer file("a");
    file.write_attribute("format", std::string_view("softgrain-snapshot"));
    file.write_attribute("version", version);
    file.write_attribute("complete", std::int64_t{1});
    file.write_attribute("content_hash", std::string_view("0123"));
    const std::string bytes(file.finish());
    return bytes + hash_of_bytes(bytes);
  };
  CHECK_THROWS_WITH_AS(decode_snapshot(snapshot_of_version(2), "a"),
                       "a: snapshot of version 2; this program reads 1", IoError);
  CHECK_THROWS_WITH_AS(decode_snapshot(snapshot_of_version(1), "a"), "a: damaged: its content hash is wrong",
                       IoError);
}
