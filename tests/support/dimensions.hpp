#pragma once

namespace softgrain::test {

/// The dimensions of a TEST_CASE_TEMPLATE; their names become part of the test's.
struct Plane {
  static constexpr int value = 2;
};
struct Space {
  static constexpr int value = 3;
};

}  // namespace softgrain::test
