#include "softgrain/io/format/hdf5_driver.hpp"

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <functional>
#include <iterator>
#include <new>

namespace softgrain {
namespace {

/// An open file as the library knows it: what it keeps of each, then ours.
struct OpenStore {
  H5FD_t of_library{};
  ByteStore* store = nullptr;
  haddr_t end = 0;  // of what the library has given away
};

/// What the library keeps in a list of properties, and copies.
struct StoreOfFile {
  ByteStore* store = nullptr;
};

OpenStore& opened(H5FD_t* file) { return *reinterpret_cast<OpenStore*>(file); }
const OpenStore& opened(const H5FD_t* file) { return *reinterpret_cast<const OpenStore*>(file); }

H5FD_t* open_store(const char*, unsigned, hid_t access, haddr_t) {
  const auto* given = static_cast<const StoreOfFile*>(H5Pget_driver_info(access));
  auto* file = given == nullptr ? nullptr : new (std::nothrow) OpenStore;
  if (file == nullptr) return nullptr;
  file->store = given->store;
  return &file->of_library;
}

herr_t read_store(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, void* bytes) {
  return opened(file).store->read(begin, {static_cast<char*>(bytes), size}) ? 0 : -1;
}

herr_t write_store(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, const void* bytes) {
  opened(file).store->write(begin, {static_cast<const char*>(bytes), size});
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 13, 0)
  constexpr int ours = 300;  // from 256 on they are anybody's
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(ours);
#endif
  driver.name = "softgrain";
  driver.maxaddr = HADDR_MAX / 2;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(StoreOfFile);
  driver.open = open_store;
  driver.close = [](H5FD_t* file) -> herr_t {
    delete &opened(file);
    return 0;
  };
  driver.cmp = [](const H5FD_t* a, const H5FD_t* b) {
    const std::less<const ByteStore*> before;
    return static_cast<int>(before(opened(b).store, opened(a).store)) -
           static_cast<int>(before(opened(a).store, opened(b).store));
  };
  driver.query = [](const H5FD_t*, unsigned long* can) -> herr_t {
    *can = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
  };
  driver.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return opened(file).end; };
  driver.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) -> herr_t {
    opened(file).end = end;
    return 0;
  };
  driver.get_eof = [](const H5FD_t* file, H5FD_mem_t) -> haddr_t { return opened(file).store->size(); };
  driver.read = read_store;
  driver.write = write_store;
  driver.truncate = [](H5FD_t* file, hid_t, hbool_t) -> herr_t {
    opened(file).store->resize(opened(file).end);
    return 0;
  };
  const H5FD_mem_t same_for_all[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(same_for_all), std::end(same_for_all), std::begin(driver.fl_map));
  return driver;
}

}  // namespace

int use_store(std::int64_t access, ByteStore& store) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t number = H5FDregister(&driver);
  const StoreOfFile given{&store};
  return number < 0 ? -1 : H5Pset_driver(access, number, &given);
}

}  // namespace softgrain
