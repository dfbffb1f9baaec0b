#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "softgrain/io/format/byte_store.hpp"
#include "softgrain/state/array.hpp"

namespace softgrain {

/// An open HDF5 file. Every return value of the library is checked: raises IoError, naming the file and the
/// object, for whatever is missing, damaged or of another type.
class Hdf5File {
 public:
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Is there a group or dataset of this absolute path?
  bool has(const std::string& path) const;
  /// Absolute paths of all datasets, sorted.
  std::vector<std::string> datasets() const;
  /// Of any dataset of integers or floats; the first dimension counts rows, the others make up the columns.
  ArrayShape shape(const std::string& path) const;
  Array read(const std::string& path) const;
  /// Its rows first .. first + count - 1.
  Array read_rows(const std::string& path, std::size_t first, std::size_t count) const;
  /// begin(shape), then visit(rows) for all rows one after the other, as many at once as a chunk has.
  void read_in_blocks(const std::string& path, const std::function<void(const ArrayShape& shape)>& begin,
                      const std::function<void(const Array& rows)>& visit) const;
  /// All, converted, flat and row-major.
  std::vector<double> read_reals(const std::string& path) const;
  std::vector<std::int64_t> read_integers(const std::string& path) const;

  /// Attributes of the root group.
  double real_attribute(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name) const;
  std::string text_attribute(const std::string& name) const;

 protected:
  enum class Mode { create, change, read };
  explicit Hdf5File(std::string name) : name_(std::move(name)) {}
  ~Hdf5File();
  void open(ByteStore& store, Mode mode);
  void close();

  std::string name_;
  std::size_t size_ = 0;    ///< bytes of a file that is read
  std::int64_t file_ = -1;  ///< HDF5's identifier; -1: none is open
};

/// Writes an HDF5 file. Format of HDF5 1.10, every dataset chunked with a Fletcher-32 checksum.
class Hdf5Writer final : public Hdf5File {
 public:
  /// In memory, for finish().
  explicit Hdf5Writer(std::string name);
  /// Into a store, empty, to which it keeps a reference.
  Hdf5Writer(std::string name, ByteStore& store);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset, float64 or int64, of shape (rows, columns), or (rows) when there is one column.
  /// `path` is absolute, as "/scene/walls"; missing groups are made.
  void write(const std::string& path, const Array& array);
  template <class T>
  void write(const std::string& path, const std::vector<T>& values, std::size_t columns) {
    write(path, {values.size() / columns, columns, !std::is_same_v<T, double>}, values.data());
  }
  /// Makes a dataset whose rows are not there yet.
  void begin_dataset(const std::string& path, const ArrayShape& shape);
  /// Rows of it, from row `first` on.
  void write_rows(const std::string& path, std::size_t first, const Array& rows);
  /// Attributes of the root group; a text that is there is replaced by one of its length.
  void write_attribute(const std::string& name, double value);
  void write_attribute(const std::string& name, std::int64_t value);
  void write_attribute(const std::string& name, std::string_view value);

  /// What is read after this comes from the store, as somebody else would find it there. Not where the store
  /// has an error: then nothing is open any more.
  void open_again();
  /// Nothing may be written afterwards. Whoever gave the store asks it for its error.
  void close();
  /// Closes the file and returns its bytes, where no store was given.
  std::string finish();

 private:
  void write(const std::string& path, const ArrayShape& shape, const void* values);
  void close_datasets();
  std::int64_t new_dataset(const std::string& path, const ArrayShape& shape);

  MemoryBytes own_;
  ByteStore& store_;
  std::map<std::string, std::int64_t> open_;  ///< HDF5's identifiers of datasets whose rows are written
};

/// Reads an HDF5 file.
class Hdf5Reader final : public Hdf5File {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);
  /// From the bytes of a file, to which it keeps a reference; `name` stands for it in messages.
  Hdf5Reader(std::string_view bytes, std::string name);
  Hdf5Reader(std::unique_ptr<ByteStore> store, std::string name);

 private:
  std::unique_ptr<ByteStore> store_;
};

/// Version of the HDF5 library in use, as "1.10.8".
std::string hdf5_version();

}  // namespace softgrain
