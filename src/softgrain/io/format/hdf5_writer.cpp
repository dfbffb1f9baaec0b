#include <hdf5.h>

#include <algorithm>
#include <new>
#include <utility>

#include "softgrain/io/format/hdf5_file.hpp"
#include "softgrain/io/format/hdf5_handle.hpp"

namespace softgrain {
namespace {

constexpr hsize_t chunk_bytes = 1 << 20;

}  // namespace

Hdf5Writer::Hdf5Writer(std::string name) : Hdf5File(std::move(name)), store_(own_) {
  open(store_, Mode::create);
}

Hdf5Writer::Hdf5Writer(std::string name, ByteStore& store) : Hdf5File(std::move(name)), store_(store) {
  open(store_, Mode::create);
}

Hdf5Writer::~Hdf5Writer() {
  for (const auto& [path, dataset] : open_) H5Dclose(dataset);
}

namespace {

const void* data_of(const Array& array) {
  return std::visit([](const auto& v) -> const void* { return v.data(); }, array.values);
}

}  // namespace

std::int64_t Hdf5Writer::new_dataset(const std::string& path, const ArrayShape& array) {
  const auto what = fmt::format("cannot write dataset '{}'", path);
  const hsize_t shape[2] = {array.rows, array.columns};
  const int rank = array.columns == 1 ? 1 : 2;
  const Handle space(checked(H5Screate_simple(rank, shape, nullptr), name_, what), H5Sclose);
  const Handle links(checked(H5Pcreate(H5P_LINK_CREATE), name_, what), H5Pclose);
  checked(H5Pset_create_intermediate_group(links, 1), name_, what);
  const Handle creation(checked(H5Pcreate(H5P_DATASET_CREATE), name_, what), H5Pclose);
  if (array.rows > 0) {  // an empty dataset has nothing to check, and chunks must not be empty
    const hsize_t rows = std::clamp<hsize_t>(chunk_bytes / (8 * array.columns), 1, shape[0]);
    const hsize_t chunk[2] = {rows, array.columns};
    checked(H5Pset_chunk(creation, rank, chunk), name_, what);
    checked(H5Pset_fletcher32(creation), name_, what);
  }
  const hid_t on_disk = array.integers ? H5T_STD_I64LE : H5T_IEEE_F64LE;
  return checked(H5Dcreate2(file_, path.c_str(), on_disk, space, links, creation, H5P_DEFAULT), name_, what);
}

void Hdf5Writer::write(const std::string& path, const ArrayShape& shape, const void* values) {
  const auto what = fmt::format("cannot write dataset '{}'", path);
  Handle dataset(new_dataset(path, shape), H5Dclose);
  checked(H5Dwrite(dataset, type_in_memory(shape.integers), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name_,
          what);
  checked(dataset.close() ? 0 : -1, name_, what);
}

void Hdf5Writer::write(const std::string& path, const Array& array) {
  write(path, shape_of(array), data_of(array));
}

void Hdf5Writer::begin_dataset(const std::string& path, const ArrayShape& shape) {
  open_[path] = new_dataset(path, shape);
}

void Hdf5Writer::write_rows(const std::string& path, std::size_t first, const Array& rows) {
  const auto what = fmt::format("cannot write dataset '{}'", path);
  const ArrayShape shape = shape_of(rows);
  if (shape.rows == 0) return;
  const int rank = shape.columns == 1 ? 1 : 2;
  const hsize_t begin[2] = {first, 0}, count[2] = {shape.rows, shape.columns};
  const Handle in_file(checked(H5Dget_space(open_.at(path)), name_, what), H5Sclose),
      in_memory(checked(H5Screate_simple(rank, count, nullptr), name_, what), H5Sclose);
  checked(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin, nullptr, count, nullptr), name_, what);
  checked(H5Dwrite(open_.at(path), type_in_memory(shape.integers), in_memory, in_file, H5P_DEFAULT,
                   data_of(rows)),
          name_, what);
}

namespace {

void write_root_attribute(hid_t file, const std::string& file_name, const std::string& name, hid_t type,
                          const void* value) {
  const auto what = fmt::format("cannot write attribute '{}'", name);
  const Handle space(checked(H5Screate(H5S_SCALAR), file_name, what), H5Sclose);
  Handle attribute(checked(H5Aexists(file, name.c_str()) > 0
                               ? H5Aopen(file, name.c_str(), H5P_DEFAULT)
                               : H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                           file_name, what),
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

void Hdf5Writer::close_datasets() {
  for (const auto& [path, dataset] : std::exchange(open_, {}))
    checked(H5Dclose(dataset), name_, fmt::format("cannot write dataset '{}'", path));
}

void Hdf5Writer::close() {
  close_datasets();
  Hdf5File::close();
}

void Hdf5Writer::open_again() {
  close();
  if (store_.error() == 0) open(store_, Mode::change);
}

std::string Hdf5Writer::finish() {
  close();
  if (own_.error() != 0) throw std::bad_alloc();
  return std::move(own_.bytes());
}

}  // namespace softgrain
