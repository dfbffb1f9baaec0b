// CPU time of one exact solution of Signorini's and Coulomb's laws at one contact, against one update of
// plain projected Gauss-Seidel, the cheapest local step there is.
#include <fmt/core.h>

#include <vector>

#include "harness.hpp"
#include "softgrain/contact/signorini_coulomb.hpp"
#include "softgrain/math/random.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int problems = 4096, repeats = 50;

template <int Dim>
struct LocalProblem {
  Mat<Dim> W;
  Vec<Dim> q;
};

/// W = A^T A + 0.1, with entries of A and q in [-1, 1]: open, sticking and sliding contacts in turn.
template <int Dim>
std::vector<LocalProblem<Dim>> random_problems() {
  std::uint64_t drawn = 0;
  const auto draw = [&] { return 2 * random_uniform(1, Dim, drawn++) - 1; };
  std::vector<LocalProblem<Dim>> all(problems);
  for (auto& [W, q] : all) {
    Mat<Dim> A;
    for (double& entry : A.c) entry = draw();
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        W(i, j) = i == j ? 0.1 : 0;
        for (int k = 0; k < Dim; ++k) W(i, j) += A(k, i) * A(k, j);
      }
    for (double& component : q.c) component = draw();
  }
  return all;
}

template <int Dim>
void measure(double mu, Results& results) {
  const auto all = random_problems<Dim>();
  Vec<Dim> sum;  // keeps the compiler from dropping the work
  const auto exact = [&] {
    for (int k = 0; k < repeats; ++k)
      for (const auto& [W, q] : all) sum += solve_signorini_coulomb(W, q, mu);
  };
  const auto projected = [&] {
    for (int k = 0; k < repeats; ++k)
      for (const auto& [W, q] : all) {
        Vec<Dim> p;
        for (int i = 0; i < Dim; ++i) p[i] = -q[i] / W(i, i);
        sum += project_on_coulomb_cone(p, mu);
      }
  };
  const auto seconds = fastest({exact, projected});
  const double solutions = 1.0 * problems * repeats;
  const auto add = [&](const char* what, double time) {
    results.add({.what = fmt::format("{}D, mu {}: {}", Dim, mu, what),
                 .value = 1e9 * time / solutions,
                 .unit = "ns/contact",
                 .ratio = time / seconds[1],
                 .reference = "projected step"});
  };
  add("projected step", seconds[1]);
  add("exact solution", seconds[0]);
  if (sum[0] < 0) fmt::print("impulses pull\n");
}

}  // namespace

int main(int argc, char** argv) {
  Results results("local_solver", argc, argv);
  results.heading(fmt::format("{} random contacts: open, sticking, sliding", problems));
  for (const double mu : {0.0, 0.3, 0.9}) {
    measure<2>(mu, results);
    measure<3>(mu, results);
  }
}
