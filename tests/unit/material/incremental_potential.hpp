#pragma once
#include <doctest/doctest.h>

#include "samples.hpp"

namespace softgrain::test {

/// Stress and tangent of a step of dt from a state to F are derivatives of the law's incremental potential.
template <class Law, class State>
void check_incremental_potential(const Law& law, const State& state, const Mat<2>& F, double dt) {
  const Mat<4> A = law.tangent(F, state, dt);
  CHECK(difference(law.stress(F, state, dt),
                   gradient([&](const Mat<2>& G) { return law.energy(G, state, dt); }, F)) < 1e-9);
  CHECK(difference(A, gradient_of_stress([&](const Mat<2>& G) { return law.stress(G, state, dt); }, F)) <
        1e-8);
  CHECK(difference(A, transpose(A)) < 1e-13 * largest_entry(A));
}

}  // namespace softgrain::test
