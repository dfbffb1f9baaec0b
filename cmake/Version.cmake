# Version and commit, written at configure time into a header that only core/version.cpp includes.
execute_process(COMMAND git -C "${PROJECT_SOURCE_DIR}" describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE SOFTGRAIN_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT SOFTGRAIN_COMMIT)
  set(SOFTGRAIN_COMMIT "unknown")
endif()
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
if(SOFTGRAIN_ARCH)
  set(march " -march=${SOFTGRAIN_ARCH}")
endif()
set(SOFTGRAIN_BUILD_FLAGS "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}${march} -ffp-contract=off -fno-math-errno")
string(STRIP "${SOFTGRAIN_BUILD_FLAGS}" SOFTGRAIN_BUILD_FLAGS)
set(SOFTGRAIN_PYTHON_DIR "lib/python3/dist-packages" CACHE STRING "Where the Python package is installed, below the prefix")
configure_file("${PROJECT_SOURCE_DIR}/cmake/version_config.hpp.in" "${PROJECT_BINARY_DIR}/generated/version_config.hpp" @ONLY)
