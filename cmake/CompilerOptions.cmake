# One set of flags for every target, so that results do not depend on which target a file is built into.
# -ffp-contract=off and no -ffast-math: the same bits from every build (docs/decisions/0003-floating-point.md).
# -fno-math-errno: roots of lanes are taken at once, with the same bits; nobody asks errno about one.
add_library(softgrain_options INTERFACE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(SOFTGRAIN_WARNINGS_AS_ERRORS)
  list(APPEND warnings -Werror)
endif()
# Who uses an installed softgrain has warnings of their own, but the same numbers.
target_compile_options(softgrain_options INTERFACE "$<BUILD_INTERFACE:${warnings}>" -ffp-contract=off -fno-math-errno)
if(SOFTGRAIN_ARCH)
  target_compile_options(softgrain_options INTERFACE -march=${SOFTGRAIN_ARCH})
endif()
# g++ 12 turns a b - c, a b + c in turn into one fused instruction (vfmaddsub) whatever -ffp-contract says, in some builds and not
# in others. So it may not have the instruction, but where fused_multiply_add asks for it; with AVX-512 that cannot be said, and
# it may not vectorise by itself (docs/decisions/0032-portability.md).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND SOFTGRAIN_ARCH)
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_FLAGS "-march=${SOFTGRAIN_ARCH}")
  check_cxx_source_compiles("#ifndef __FMA__\n#error\n#endif\nint main() {}" SOFTGRAIN_ARCH_HAS_FMA)
  check_cxx_source_compiles("#ifndef __AVX512F__\n#error\n#endif\nint main() {}" SOFTGRAIN_ARCH_HAS_AVX512)
  unset(CMAKE_REQUIRED_FLAGS)
  if(SOFTGRAIN_ARCH_HAS_FMA)
    target_compile_options(softgrain_options INTERFACE -mno-fma)
  endif()
  if(SOFTGRAIN_ARCH_HAS_AVX512)
    target_compile_options(softgrain_options INTERFACE -fno-tree-vectorize)
  endif()
endif()
# Vectors of 32 bytes as arguments: one set of flags for all, so no other ABI can meet ours.
target_compile_options(softgrain_options INTERFACE -Wno-psabi)
find_package(Threads REQUIRED)
