#include "softgrain/io/format/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <new>
#include <utility>

#include "softgrain/io/format/hdf5_driver.hpp"
#include "softgrain/io/format/hdf5_handle.hpp"

// The visitor of H5O_info_t, which has another version since HDF5 1.12.
#if !H5_VERSION_GE(1, 12, 0)
#define H5Ovisit3 H5Ovisit2
#endif

namespace softgrain {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

namespace {

/// The library would print its own stack of errors; we raise one sentence instead.
void silence_library() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

}  // namespace

std::int64_t type_in_memory(bool integers) { return integers ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE; }

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

void Hdf5File::open(ByteStore& store, Mode mode) {
  silence_library();
  const bool create = mode == Mode::create;
  const std::string what = create ? "cannot create an HDF5 file" : "not an HDF5 file, or a damaged one";
  const Handle access(checked(H5Pcreate(H5P_FILE_ACCESS), name_, what), H5Pclose);
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), name_, "HDF5 older than 1.10");
  checked(use_store(access, store), name_, what);
  size_ = store.size();
  file_ = create ? H5Fcreate("store", H5F_ACC_TRUNC, H5P_DEFAULT, access)
                 : H5Fopen("store", mode == Mode::change ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  checked(file_, name_, what);
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::close() { checked(H5Fclose(std::exchange(file_, -1)), name_, "cannot close the HDF5 file"); }

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file)
    : Hdf5Reader(std::make_unique<FileBytes>(file), file.string()) {}

Hdf5Reader::Hdf5Reader(std::string_view bytes, std::string name)
    : Hdf5Reader(std::make_unique<ViewedBytes>(bytes), std::move(name)) {}

Hdf5Reader::Hdf5Reader(std::unique_ptr<ByteStore> store, std::string name)
    : Hdf5File(std::move(name)), store_(std::move(store)) {
  open(*store_, Mode::read);
}

bool Hdf5File::has(const std::string& path) const {
  for (auto end = path.find('/', 1);;
       end = path.find('/', end + 1)) {  // the library asks for each step of the path
    if (H5Lexists(file_, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> Hdf5File::datasets() const {
  std::vector<std::string> paths;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET)
      static_cast<std::vector<std::string>*>(list)->push_back(std::string("/") + name);
    return 0;
  };
  checked(H5Ovisit3(file_, H5_INDEX_NAME, H5_ITER_INC, visit, &paths, H5O_INFO_BASIC), name_,
          "damaged HDF5 file");
  std::sort(paths.begin(), paths.end());
  return paths;
}

namespace {

/// One dataset, opened, and its size.
class Dataset {
 public:
  /// `file_size` [bytes]: no dataset holds more values than a file of this size can.
  Dataset(hid_t file, const std::string& path, const std::string& file_name, std::size_t file_size)
      : name_(file_name),
        what_(fmt::format("dataset '{}' is missing or damaged", path)),
        dataset_(checked(H5Dopen2(file, path.c_str(), H5P_DEFAULT), name_, what_), H5Dclose),
        type_(checked(H5Dget_type(dataset_), name_, what_), H5Tclose) {
    const Handle space(checked(H5Dget_space(dataset_), name_, what_), H5Sclose);
    std::vector<hsize_t> shape(checked(H5Sget_simple_extent_ndims(space), name_, what_));
    checked(H5Sget_simple_extent_dims(space, shape.data(), nullptr), name_, what_);
    if (!shape.empty()) rows_ = shape[0];
    for (std::size_t k = 1; k < shape.size(); ++k) columns_ *= shape[k];
    constexpr std::size_t best_compression = 1100;  // of deflate
    std::size_t count = 0;
    const bool overflow = __builtin_mul_overflow(rows_, columns_, &count);
    checked(overflow || count / best_compression > file_size ? -1 : 0, name_, what_);
  }

  std::size_t columns() const { return columns_; }
  H5T_class_t type_class() const { return H5Tget_class(type_); }

  std::size_t rows() const { return rows_; }
  /// Of a chunk, or all.
  std::size_t rows_at_once() const {
    const Handle creation(checked(H5Dget_create_plist(dataset_), name_, what_), H5Pclose);
    hsize_t chunk[H5S_MAX_RANK] = {};
    const bool chunked =
        H5Pget_layout(creation) == H5D_CHUNKED && H5Pget_chunk(creation, H5S_MAX_RANK, chunk) > 0;
    return chunked ? std::max<std::size_t>(chunk[0], 1) : rows_;
  }

  template <class T>
  std::vector<T> read() const {
    return read_into<T>(H5S_ALL, H5S_ALL, rows_);
  }
  template <class T>
  std::vector<T> read(std::size_t first, std::size_t rows) const {
    const Handle in_file(checked(H5Dget_space(dataset_), name_, what_), H5Sclose);
    std::vector<hsize_t> begin(H5Sget_simple_extent_ndims(in_file)), count(begin.size());
    checked(H5Sget_simple_extent_dims(in_file, count.data(), nullptr), name_, what_);
    if (begin.empty()) return read<T>();
    begin[0] = first, count[0] = rows;
    checked(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr), name_,
            what_);
    const Handle in_memory(
        checked(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), name_, what_),
        H5Sclose);
    return read_into<T>(in_memory, in_file, rows);
  }

 private:
  template <class T>
  std::vector<T> read_into(hid_t in_memory, hid_t in_file, std::size_t rows) const {
    checked(type_class() == H5T_INTEGER || type_class() == H5T_FLOAT ? 0 : -1, name_,
            what_ + " (no numbers)");
    std::vector<T> values(rows * columns_);
    checked(H5Dread(dataset_, type_in_memory(!std::is_same_v<T, double>), in_memory, in_file, H5P_DEFAULT,
                    values.data()),
            name_, what_);
    return values;
  }

  std::string name_, what_;
  Handle dataset_, type_;
  std::size_t rows_ = 1, columns_ = 1;
};

template <class T>
T read_root_attribute(hid_t file, const std::string& file_name, const std::string& name, hid_t type) {
  const auto what = fmt::format("no attribute '{}'", name);
  const Handle attribute(checked(H5Aopen(file, name.c_str(), H5P_DEFAULT), file_name, what), H5Aclose);
  T value{};
  checked(H5Aget_storage_size(attribute) == 8 ? 0 : -1, file_name, what);
  checked(H5Aread(attribute, type, &value), file_name, what);
  return value;
}

}  // namespace

ArrayShape Hdf5File::shape(const std::string& path) const {
  const Dataset dataset(file_, path, name_, size_);
  return {dataset.rows(), dataset.columns(), dataset.type_class() == H5T_INTEGER};
}

Array Hdf5File::read(const std::string& path) const {
  const Dataset dataset(file_, path, name_, size_);
  if (dataset.type_class() == H5T_INTEGER) return {dataset.columns(), dataset.read<std::int64_t>()};
  return {dataset.columns(), dataset.read<double>()};
}

Array Hdf5File::read_rows(const std::string& path, std::size_t first, std::size_t count) const {
  const Dataset dataset(file_, path, name_, size_);
  if (dataset.type_class() == H5T_INTEGER)
    return {dataset.columns(), dataset.read<std::int64_t>(first, count)};
  return {dataset.columns(), dataset.read<double>(first, count)};
}

void Hdf5File::read_in_blocks(const std::string& path,
                              const std::function<void(const ArrayShape& shape)>& begin,
                              const std::function<void(const Array& rows)>& visit) const {
  const Dataset dataset(file_, path, name_, size_);
  begin({dataset.rows(), dataset.columns(), dataset.type_class() == H5T_INTEGER});
  const std::size_t most = dataset.rows_at_once();
  for (std::size_t first = 0; first < dataset.rows(); first += most) {
    const std::size_t rows = std::min(most, dataset.rows() - first);
    if (dataset.type_class() == H5T_INTEGER)
      visit({dataset.columns(), dataset.read<std::int64_t>(first, rows)});
    else
      visit({dataset.columns(), dataset.read<double>(first, rows)});
  }
}

std::vector<double> Hdf5File::read_reals(const std::string& path) const {
  return Dataset(file_, path, name_, size_).read<double>();
}

std::vector<std::int64_t> Hdf5File::read_integers(const std::string& path) const {
  return Dataset(file_, path, name_, size_).read<std::int64_t>();
}

double Hdf5File::real_attribute(const std::string& name) const {
  return read_root_attribute<double>(file_, name_, name, H5T_NATIVE_DOUBLE);
}

std::int64_t Hdf5File::integer_attribute(const std::string& name) const {
  return read_root_attribute<std::int64_t>(file_, name_, name, H5T_NATIVE_INT64);
}

std::string Hdf5File::text_attribute(const std::string& name) const {
  const auto what = fmt::format("no text attribute '{}'", name);
  const Handle attribute(checked(H5Aopen(file_, name.c_str(), H5P_DEFAULT), name_, what), H5Aclose);
  const Handle type(checked(H5Aget_type(attribute), name_, what), H5Tclose);
  const bool fixed_text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  const std::size_t size = H5Tget_size(type);
  if (!fixed_text || size > size_) throw IoError(fmt::format("{}: {}", name_, what));
  std::string text(size, '\0');
  checked(H5Aread(attribute, type, text.data()), name_, what);
  return text.substr(0, text.find('\0'));
}

}  // namespace softgrain
