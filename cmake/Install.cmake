# cmake --install BUILD [--prefix P]: program, library with headers and find_package(softgrain), Python package, manual page and
# completions. The page of `softgrain report` is part of the program.
include(CMakePackageConfigHelpers)
set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/softgrain")

set_target_properties(softgrain_options PROPERTIES EXPORT_NAME options)
install(TARGETS softgrain_app)
if(SOFTGRAIN_MPI)
  install(TARGETS softgrain_mpi_app)
endif()
install(TARGETS softgrain softgrain_options EXPORT softgrain_targets)
install(DIRECTORY src/softgrain DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" FILES_MATCHING PATTERN "*.hpp")
install(EXPORT softgrain_targets NAMESPACE softgrain:: FILE softgrain-targets.cmake DESTINATION "${config_dir}")
configure_package_config_file(cmake/softgrain-config.cmake.in softgrain-config.cmake INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file(softgrain-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/softgrain-config.cmake" "${PROJECT_BINARY_DIR}/softgrain-config-version.cmake"
  DESTINATION "${config_dir}")

install(DIRECTORY python/softgrain DESTINATION "${SOFTGRAIN_PYTHON_DIR}" FILES_MATCHING
  PATTERN "*.py" PATTERN "*.pyi" PATTERN options.json PATTERN py.typed PATTERN __pycache__ EXCLUDE)
if(SOFTGRAIN_PYTHON)
  install(TARGETS softgrain_python DESTINATION "${SOFTGRAIN_PYTHON_DIR}/softgrain")
endif()

# What the program says of itself.
set(said "${PROJECT_BINARY_DIR}/said")
file(MAKE_DIRECTORY "${said}")
add_custom_command(OUTPUT "${said}/softgrain.1.gz" "${said}/softgrain" "${said}/_softgrain" "${said}/softgrain.fish"
  DEPENDS softgrain_app "${PROJECT_SOURCE_DIR}/tools/man_page"
  COMMAND "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/tools/man_page" $<TARGET_FILE:softgrain_app> > softgrain.1
  COMMAND gzip -9nf softgrain.1
  COMMAND softgrain_app completion bash > softgrain
  COMMAND softgrain_app completion zsh > _softgrain
  COMMAND softgrain_app completion fish > softgrain.fish
  WORKING_DIRECTORY "${said}" VERBATIM)
add_custom_target(softgrain_said ALL DEPENDS "${said}/softgrain.1.gz")
install(FILES "${said}/softgrain.1.gz" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
install(FILES "${said}/softgrain" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${said}/_softgrain" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")
install(FILES "${said}/softgrain.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright)

# cpack -G DEB in the build folder: one package with all of it. What the libraries need is found by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the softgrain developers")
set(CPACK_PACKAGE_DESCRIPTION "${PROJECT_DESCRIPTION}.\nThe program, its library, and the Python package that reads and runs simulations.")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3 (>= 3.11), python3-numpy, python3-h5py, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-scipy, ffmpeg, g++, cmake, libfmt-dev, libhdf5-dev, libdeflate-dev")
include(CPack)
