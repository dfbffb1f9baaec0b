#include "softgrain/io/format/snapshot_hashes.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <variant>

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

class Xxh3 {
 public:
  Xxh3() { XXH3_128bits_reset(&state_); }
  void add(const void* data, std::size_t size) { XXH3_128bits_update(&state_, data, size); }
  void add(std::uint64_t number) { add(&number, sizeof number); }
  std::string digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  XXH3_state_t state_;
};

}  // namespace

std::string file_hash(ByteStore& file, std::size_t size, const std::string& name) {
  constexpr std::size_t at_once = 1 << 20;
  Xxh3 hash;
  std::string bytes;
  for (std::size_t begin = 0; begin < size; begin += bytes.size()) {
    bytes.resize(std::min(at_once, size - begin));
    if (!file.read(begin, bytes)) throw IoError(fmt::format("{}: the disk does not give it back", name));
    hash.add(bytes.data(), bytes.size());
  }
  return hash.digest();
}

void check_bytes(ByteStore& file, const std::string& name) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::string begin(signature.size(), '\0'), hash(hash_length, '\0');
  if (!file.read(0, begin) || begin != signature)
    throw IoError(fmt::format("{}: not a snapshot: no HDF5 file, or one without its beginning", name));
  const std::size_t size = file.size() - std::min(file.size(), hash_length);
  if (!file.read(size, hash) || hash != file_hash(file, size, name))
    throw IoError(fmt::format("{}: not a snapshot, or a damaged one: the hash at its end is wrong", name));
}

class ContentHash::Hash : public Xxh3 {};

ContentHash::ContentHash() : hash_(std::make_unique<Hash>()) {}
ContentHash::~ContentHash() = default;

void ContentHash::begin(const std::string& path, const ArrayShape& shape) {
  hash_->add(path.c_str(), path.size() + 1);
  hash_->add(shape.integers ? "i" : "f", 1);
  hash_->add(shape.rows);
  hash_->add(shape.columns);
}

void ContentHash::add(const Array& rows) {
  std::visit([this](const auto& values) { hash_->add(values.data(), values.size() * sizeof values[0]); },
             rows.values);
}

void ContentHash::add(const Hdf5File& file, const std::string& path) {
  file.read_in_blocks(
      path, [&](const ArrayShape& shape) { begin(path, shape); }, [this](const Array& rows) { add(rows); });
}

std::string ContentHash::digest() const { return hash_->digest(); }

std::string content_hash(const Hdf5File& file) {
  ContentHash hash;
  for (const std::string& path : file.datasets()) hash.add(file, path);
  return hash.digest();
}

}  // namespace softgrain
