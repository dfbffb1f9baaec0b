#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "softgrain/io/format/file.hpp"

namespace softgrain {

/// Bytes that a library reads and writes where it likes. Whoever writes asks for error() at the end: the HDF5
/// library does not end well where it hears of a write that failed.
class ByteStore {
 public:
  ByteStore() = default;
  ByteStore(const ByteStore&) = delete;
  ByteStore& operator=(const ByteStore&) = delete;
  virtual ~ByteStore() = default;

  virtual std::size_t size() const = 0;
  /// False if some of these are not there, or after a write that failed.
  virtual bool read(std::size_t begin, std::span<char> bytes) = 0;
  /// Bytes behind the end lengthen the store.
  virtual void write(std::size_t begin, std::string_view bytes) = 0;
  virtual void resize(std::size_t size) = 0;
  /// errno of the first write that failed; 0 for none.
  int error() const { return error_; }

 protected:
  int error_ = 0;
};

/// In memory.
class MemoryBytes final : public ByteStore {
 public:
  std::size_t size() const override { return bytes_.size(); }
  bool read(std::size_t begin, std::span<char> bytes) override;
  void write(std::size_t begin, std::string_view bytes) override;
  void resize(std::size_t size) override;
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
};

/// Somebody else's, which only can be read.
class ViewedBytes final : public ByteStore {
 public:
  explicit ViewedBytes(std::string_view bytes) : bytes_(bytes) {}
  std::size_t size() const override { return bytes_.size(); }
  bool read(std::size_t begin, std::span<char> bytes) override;
  void write(std::size_t, std::string_view) override;
  void resize(std::size_t) override {}

 private:
  std::string_view bytes_;
};

/// Of a file. What has been written is known to be there when error() is 0 and the file has been synced.
class FileBytes final : public ByteStore {
 public:
  /// A regular file, for reading. Raises IoError.
  explicit FileBytes(const std::filesystem::path& path);
  /// An open one, empty, for reading and writing; keeps the number.
  explicit FileBytes(int descriptor) : descriptor_(descriptor) {}

  std::size_t size() const override { return size_; }
  bool read(std::size_t begin, std::span<char> bytes) override;
  void write(std::size_t begin, std::string_view bytes) override;
  void resize(std::size_t size) override;

 private:
  Descriptor own_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

}  // namespace softgrain
