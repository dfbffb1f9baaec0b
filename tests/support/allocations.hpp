#pragma once
#include <cstddef>

namespace softgrain::test {

/// How often operator new was called since the program began (counted by tests/unit/contact/allocations.cpp).
std::size_t allocations();

}  // namespace softgrain::test
