# The module softgrain._core is built where Debian's python3-dev and pybind11-dev are. The interpreter is the system's, which has
# NumPy; another one by -DPython_EXECUTABLE at the first configure.
option(SOFTGRAIN_PYTHON "Build the Python module where python3-dev and pybind11-dev are" ON)
set(Python_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "Interpreter of the module and of the tests")
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
