# One set of flags for every target, so that results do not depend on which target a file is built into.
# -ffp-contract=off and no -ffast-math: the same bits from every build (docs/decisions/0003-floating-point.md).
add_library(softgrain_options INTERFACE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(SOFTGRAIN_WARNINGS_AS_ERRORS)
  list(APPEND warnings -Werror)
endif()
# Who uses an installed softgrain has warnings of their own, but the same numbers.
target_compile_options(softgrain_options INTERFACE "$<BUILD_INTERFACE:${warnings}>" -ffp-contract=off)
if(SOFTGRAIN_ARCH)
  target_compile_options(softgrain_options INTERFACE -march=${SOFTGRAIN_ARCH})
endif()
# Vectors of 32 bytes as arguments: one set of flags for all, so no other ABI can meet ours.
target_compile_options(softgrain_options INTERFACE -Wno-psabi)
find_package(Threads REQUIRED)
