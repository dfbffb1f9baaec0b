# Siconos' solvers alone (Debian: libsiconos-numerics-dev): target Siconos::numerics. Its own configuration asks for
# all of Siconos.
find_path(SiconosNumerics_INCLUDE_DIR fc2d_Solvers.h PATH_SUFFIXES siconos/numerics)
find_library(SiconosNumerics_LIBRARY siconos_numerics)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SiconosNumerics
  REQUIRED_VARS SiconosNumerics_LIBRARY SiconosNumerics_INCLUDE_DIR)
if(SiconosNumerics_FOUND AND NOT TARGET Siconos::numerics)
  add_library(Siconos::numerics UNKNOWN IMPORTED)
  set_target_properties(Siconos::numerics PROPERTIES IMPORTED_LOCATION "${SiconosNumerics_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SiconosNumerics_INCLUDE_DIR};${SiconosNumerics_INCLUDE_DIR}/..")
endif()
