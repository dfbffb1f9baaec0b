#pragma once
#include <memory>
#include <string>

#include "softgrain/io/format/byte_store.hpp"
#include "softgrain/io/format/hdf5_file.hpp"

namespace softgrain {

constexpr std::size_t hash_length = 32;

/// XXH3-128 of the first `size` bytes of a file; it ends the file, so that a flipped bit is found wherever it
/// lies. Raises IoError.
std::string file_hash(ByteStore& file, std::size_t size, const std::string& name);

/// Raises IoError unless it is an HDF5 file with its hash behind it. The library must not see damaged bytes:
/// it may crash on them.
void check_bytes(ByteStore& file, const std::string& name);

/// XXH3-128 over the datasets in the order of their paths: path, 0, 'f' or 'i', rows, columns, values.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void begin(const std::string& path, const ArrayShape& shape);
  void add(const Array& rows);
  /// Of a dataset, of which a chunk at a time is in memory.
  void add(const Hdf5File& file, const std::string& path);
  std::string digest() const;

 private:
  class Hash;
  std::unique_ptr<Hash> hash_;
};

/// Of all datasets of a file.
std::string content_hash(const Hdf5File& file);

}  // namespace softgrain
