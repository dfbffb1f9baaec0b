# One set of flags for every target, so that results do not depend on which target a file is built into.
# -ffp-contract=off and no -ffast-math: the same bits from every build (docs/decisions/0003-floating-point.md).
add_library(softgrain_options INTERFACE)
target_compile_options(softgrain_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -ffp-contract=off -march=${SOFTGRAIN_ARCH})
if(SOFTGRAIN_WARNINGS_AS_ERRORS)
  target_compile_options(softgrain_options INTERFACE -Werror)
endif()
find_package(OpenMP REQUIRED COMPONENTS CXX)
