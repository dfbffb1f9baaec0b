# softgrain_join(TARGET LINES SOURCE... [-- SOURCE...]): the sources are compiled in joints of at most LINES lines
# (tools/joint_sources.py), those before -- never with those behind it. Halves the time of a build from nothing. Without
# Python each is compiled by itself.
function(softgrain_join target lines)
  if(NOT EXISTS "${Python_EXECUTABLE}")
    return()
  endif()
  execute_process(COMMAND "${Python_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/tools/joint_sources.py" ${lines} ${ARGN}
    OUTPUT_VARIABLE joints OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" joints "${joints}")
  foreach(line IN LISTS joints)
    string(REGEX MATCH "^([0-9]+) (.*)$" line "${line}")
    set_source_files_properties("${CMAKE_MATCH_2}" PROPERTIES UNITY_GROUP "joint_${CMAKE_MATCH_1}")
  endforeach()
  set(pragmas "#pragma GCC diagnostic ignored \"-Wshadow\"")  # of a hidden name of another source
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # for it every source of a joint is a header, whose types nobody should hide
    string(APPEND pragmas "\n#pragma GCC diagnostic ignored \"-Wsubobject-linkage\"")
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP UNITY_BUILD_CODE_BEFORE_INCLUDE "${pragmas}")
endfunction()
