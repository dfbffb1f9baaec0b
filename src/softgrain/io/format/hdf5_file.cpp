#include "softgrain/io/format/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/file.hpp"

// The visitor of H5O_info_t, which has another version since HDF5 1.12.
#if !H5_VERSION_GE(1, 12, 0)
#define H5Ovisit3 H5Ovisit2
#endif

namespace softgrain {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

namespace {

/// Owns one HDF5 identifier.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close_id)(hid_t)) : id_(id), close_(close_id) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }
  operator hid_t() const { return id_; }  // NOLINT: as the library takes it
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Raises IoError when the library reports a failure: `status` < 0.
template <class Status>
Status checked(Status status, const std::string& file, std::string_view what) {
  if (status < 0) throw IoError(fmt::format("{}: {}", file, what));
  return status;
}

/// The library takes two open files in memory for the same when their names are equal.
std::string unique_name(const void* owner) { return fmt::format("{}", owner); }

/// The library would print its own stack of errors; we raise one sentence instead.
void silence_library() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

constexpr hsize_t chunk_bytes = 1 << 20;
constexpr std::size_t grown_by = 8 << 20;  // a file in memory, at a time

}  // namespace

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

namespace {

/// Memory of a file in memory, as the library wants it; when the file closes its bytes go to `kept`, a
/// std::unique_ptr. (H5Fget_file_image gives them too, but spoils the superblock's checksum.)
template <class Bytes>
H5FD_file_image_callbacks_t keep_image_at_close(Bytes& kept_bytes) {
  using Operation = H5FD_file_image_op_t;
  H5FD_file_image_callbacks_t callbacks{};
  callbacks.image_malloc = [](std::size_t size, Operation, void*) { return std::malloc(size); };
  callbacks.image_realloc = [](void* at, std::size_t size, Operation, void*) {
    return std::realloc(at, size);
  };
  callbacks.image_memcpy = [](void* to, const void* from, std::size_t size, Operation, void*) {
    return std::memcpy(to, from, size);
  };
  callbacks.image_free = [](void* at, Operation operation, void* user) -> herr_t {
    if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE)
      static_cast<Bytes*>(user)->reset(static_cast<char*>(at));
    else
      std::free(at);
    return 0;
  };
  callbacks.udata_copy = [](void* user) { return user; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.udata = &kept_bytes;
  return callbacks;
}

}  // namespace

Hdf5Writer::Hdf5Writer(std::string name) : name_(std::move(name)) {
  silence_library();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), name_, "HDF5 older than 1.10");
  constexpr auto what = "cannot create an HDF5 file in memory";
  checked(H5Pset_fapl_core(access, grown_by, false), name_, what);
  auto callbacks = keep_image_at_close(image_.bytes_);
  checked(H5Pset_file_image_callbacks(access, &callbacks), name_, what);
  file_ = checked(H5Fcreate(unique_name(this).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), name_, what);
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::write(const std::string& path, const Array& array) {
  const auto what = fmt::format("cannot write dataset '{}'", path);
  const bool real = array.values.index() == 0;
  const void* data = std::visit([](const auto& v) -> const void* { return v.data(); }, array.values);
  const hsize_t count = std::visit([](const auto& v) { return v.size(); }, array.values);
  const hsize_t shape[2] = {count / array.columns, array.columns};
  const int rank = array.columns == 1 ? 1 : 2;
  const Handle space(checked(H5Screate_simple(rank, shape, nullptr), name_, what), H5Sclose);
  const Handle links(checked(H5Pcreate(H5P_LINK_CREATE), name_, what), H5Pclose);
  checked(H5Pset_create_intermediate_group(links, 1), name_, what);
  const Handle creation(checked(H5Pcreate(H5P_DATASET_CREATE), name_, what), H5Pclose);
  if (count > 0) {  // an empty dataset has nothing to check, and chunks must not be empty
    const hsize_t rows = std::clamp<hsize_t>(chunk_bytes / (8 * array.columns), 1, shape[0]);
    const hsize_t chunk[2] = {rows, array.columns};
    checked(H5Pset_chunk(creation, rank, chunk), name_, what);
    checked(H5Pset_fletcher32(creation), name_, what);
  }
  const hid_t on_disk = real ? H5T_IEEE_F64LE : H5T_STD_I64LE;
  const hid_t in_memory = real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
  Handle dataset(
      checked(H5Dcreate2(file_, path.c_str(), on_disk, space, links, creation, H5P_DEFAULT), name_, what),
      H5Dclose);
  checked(H5Dwrite(dataset, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name_, what);
  checked(dataset.close() ? 0 : -1, name_, what);
}

namespace {

void write_root_attribute(hid_t file, const std::string& file_name, const std::string& name, hid_t type,
                          const void* value) {
  const auto what = fmt::format("cannot write attribute '{}'", name);
  const Handle space(checked(H5Screate(H5S_SCALAR), file_name, what), H5Sclose);
  Handle attribute(
      checked(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), file_name, what),
      H5Aclose);
  checked(H5Awrite(attribute, type, value), file_name, what);
  checked(attribute.close() ? 0 : -1, file_name, what);
}

}  // namespace

void Hdf5Writer::write_attribute(const std::string& name, double value) {
  write_root_attribute(file_, name_, name, H5T_IEEE_F64LE, &value);
}

void Hdf5Writer::write_attribute(const std::string& name, std::int64_t value) {
  write_root_attribute(file_, name_, name, H5T_STD_I64LE, &value);
}

void Hdf5Writer::write_attribute(const std::string& name, std::string_view value) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type, value.size() + 1), name_, "no text type");
  checked(H5Tset_cset(type, H5T_CSET_UTF8), name_, "no text type");
  write_root_attribute(file_, name_, name, type, std::string(value).c_str());
}

FileImage Hdf5Writer::finish() {
  constexpr auto what = "cannot finish the HDF5 file";
  checked(H5Fflush(file_, H5F_SCOPE_GLOBAL), name_, what);
  const auto size = checked(H5Fget_file_image(file_, nullptr, 0), name_, what);  // asks for the size only
  image_.size_ = static_cast<std::size_t>(size);
  checked(H5Fclose(std::exchange(file_, -1)), name_, what);
  return std::move(image_);
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : name_(file.string()) { open(read_file(file)); }

Hdf5Reader::Hdf5Reader(std::string_view bytes, std::string name) : name_(std::move(name)) { open(bytes); }

Hdf5Reader::~Hdf5Reader() { H5Fclose(file_); }

void Hdf5Reader::open(std::string_view bytes) {
  silence_library();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_fapl_core(access, grown_by, false), name_, "no memory for an HDF5 file");
  std::string image(bytes);  // the library copies it once more, but takes no pointer to const
  checked(H5Pset_file_image(access, image.data(), image.size()), name_, "not an HDF5 file");
  size_ = bytes.size();
  file_ = checked(H5Fopen(unique_name(this).c_str(), H5F_ACC_RDONLY, access), name_,
                  "not an HDF5 file, or a damaged one");
}

bool Hdf5Reader::has(const std::string& path) const {
  for (auto end = path.find('/', 1);;
       end = path.find('/', end + 1)) {  // the library asks for each step of the path
    if (H5Lexists(file_, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> Hdf5Reader::datasets() const {
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

  template <class T>
  std::vector<T> read() const {
    checked(type_class() == H5T_INTEGER || type_class() == H5T_FLOAT ? 0 : -1, name_,
            what_ + " (no numbers)");
    const hid_t in_memory = std::is_same_v<T, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
    std::vector<T> values(rows_ * columns_);
    checked(H5Dread(dataset_, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name_, what_);
    return values;
  }

 private:
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

Array Hdf5Reader::read(const std::string& path) const {
  const Dataset dataset(file_, path, name_, size_);
  if (dataset.type_class() == H5T_INTEGER) return {dataset.columns(), dataset.read<std::int64_t>()};
  return {dataset.columns(), dataset.read<double>()};
}

std::vector<double> Hdf5Reader::read_reals(const std::string& path) const {
  return Dataset(file_, path, name_, size_).read<double>();
}

std::vector<std::int64_t> Hdf5Reader::read_integers(const std::string& path) const {
  return Dataset(file_, path, name_, size_).read<std::int64_t>();
}

double Hdf5Reader::real_attribute(const std::string& name) const {
  return read_root_attribute<double>(file_, name_, name, H5T_NATIVE_DOUBLE);
}

std::int64_t Hdf5Reader::integer_attribute(const std::string& name) const {
  return read_root_attribute<std::int64_t>(file_, name_, name, H5T_NATIVE_INT64);
}

std::string Hdf5Reader::text_attribute(const std::string& name) const {
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
