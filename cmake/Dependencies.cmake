# Each dependency is explained in docs/decisions/0002-dependencies.md and installed by tools/install_dependencies.sh.
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(ZLIB REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
