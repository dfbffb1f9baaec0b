# The module softgrain._core is built where Debian's python3-dev and pybind11-dev are.
option(SOFTGRAIN_PYTHON "Build the Python module where python3-dev and pybind11-dev are" ON)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(SOFTGRAIN_PYTHON OFF)  # the interpreter would have to load the sanitizer first
endif()
if(SOFTGRAIN_PYTHON)
  if(SOFTGRAIN_TESTS)
    set(needed REQUIRED)  # a test of the module is never skipped
  endif()
  find_package(Python 3.11 ${needed} COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 ${needed})
  if(NOT pybind11_FOUND OR NOT Python_Development.Module_FOUND)
    message(STATUS "No Python module: python3-dev or pybind11-dev is missing")
    set(SOFTGRAIN_PYTHON OFF)
  endif()
endif()
