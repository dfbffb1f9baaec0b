#pragma once
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/state/array.hpp"

namespace softgrain {

/// The bytes of a file in memory, as the HDF5 library allocated them: large ones are not copied.
class FileImage {
 public:
  operator std::string_view() const { return {bytes_.get(), size_}; }  // NOLINT: it is these bytes

 private:
  friend class Hdf5Writer;
  struct Free {
    void operator()(char* bytes) const { std::free(bytes); }
  };
  std::unique_ptr<char, Free> bytes_;
  std::size_t size_ = 0;
};

/// Builds an HDF5 file in memory, so that a full disk can never leave half a file behind: the finished bytes
/// go to disk in one piece. Format of HDF5 1.10, every dataset chunked with a Fletcher-32 checksum. Every
/// return value of the library is checked: raises IoError naming `name`.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::string name);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset, float64 or int64, of shape (rows, columns), or (rows) when there is one column.
  /// `path` is absolute, as "/scene/walls"; missing groups are made.
  void write(const std::string& path, const Array& array);
  /// Attributes of the root group.
  void write_attribute(const std::string& name, double value);
  void write_attribute(const std::string& name, std::int64_t value);
  void write_attribute(const std::string& name, std::string_view value);
  /// Closes the file and returns its bytes; nothing may be written afterwards.
  FileImage finish();

 private:
  std::string name_;
  FileImage image_;
  std::int64_t file_ = -1;  ///< HDF5's identifier
};

/// Reads an HDF5 file, held whole in memory. Raises IoError, naming the file and the object, for whatever is
/// missing, damaged or of another type.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);
  /// From the bytes of a file; `name` stands for it in messages.
  Hdf5Reader(std::string_view bytes, std::string name);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  /// Is there a group or dataset of this absolute path?
  bool has(const std::string& path) const;
  /// Absolute paths of all datasets, sorted.
  std::vector<std::string> datasets() const;
  /// Any dataset of integers or floats; the first dimension counts rows, the others make up the columns.
  Array read(const std::string& path) const;
  /// The same, converted, flat and row-major.
  std::vector<double> read_reals(const std::string& path) const;
  std::vector<std::int64_t> read_integers(const std::string& path) const;

  /// Attributes of the root group.
  double real_attribute(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name) const;
  std::string text_attribute(const std::string& name) const;

 private:
  void open(std::string_view bytes);

  std::string name_;
  std::size_t size_ = 0;    ///< bytes of the file
  std::int64_t file_ = -1;  ///< HDF5's identifier
};

/// Version of the HDF5 library in use, as "1.10.8".
std::string hdf5_version();

}  // namespace softgrain
