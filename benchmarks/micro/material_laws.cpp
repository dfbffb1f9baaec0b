// CPU time of stress and tangent of one material point, law by law: one point after the other, and eight at
// once.
#include <fmt/core.h>

#include <cmath>
#include <variant>
#include <vector>

#include "harness.hpp"
#include "softgrain/material/any_law.hpp"
#include "softgrain/material/elastic_law.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr int points = 256, repeats = 200;  // all stays in the second-level cache

/// Deformations of about 10 %; lane by lane the same ones when T is Wide.
template <int Dim, class T>
std::vector<Mat<Dim, T>> deformations() {
  constexpr int lanes = sizeof(T) / sizeof(double);
  std::vector<Mat<Dim, T>> all(points / lanes, identity<Dim, T>());
  for (int point = 0; point < points; ++point)
    for (std::size_t k = 0; k < all[0].c.size(); ++k) {
      T& entry = all[static_cast<std::size_t>(point / lanes)].c[k];
      const double change = 0.1 * std::sin(7.0 * point + static_cast<double>(k));
      if constexpr (lanes == 1)
        entry += change;
      else
        entry.set(point % lanes, entry[point % lanes] + change);
    }
  return all;
}

/// A law with history, asked about points that have none yet: they flow.
template <class Law>
struct Undeformed {
  Law law;

  template <int Dim, class T>
  Mat<Dim, T> stress(const Mat<Dim, T>& F) const {
    return law.stress(F, Law::template undeformed<Dim, T>(), 0);
  }
  template <int Dim, class T>
  Mat<Dim * Dim, T> tangent(const Mat<Dim, T>& F) const {
    return law.tangent(F, Law::template undeformed<Dim, T>(), 0);
  }
};

template <int Dim, class T, class Law>
struct Pieces {
  Law law;
  std::vector<Mat<Dim, T>> F = deformations<Dim, T>(), P = F;
  std::vector<Mat<Dim * Dim, T>> A = std::vector<Mat<Dim * Dim, T>>(F.size());

  void stresses() {
    for (int again = 0; again < repeats; ++again)
      for (std::size_t k = 0; k < F.size(); ++k) P[k] = law.stress(F[k]);
  }
  void tangents() {
    for (int again = 0; again < repeats; ++again)
      for (std::size_t k = 0; k < F.size(); ++k) A[k] = law.tangent(F[k]);
  }
};

template <int Dim, class Law>
void measure(std::string_view name, const Law& law, Results& results) {
  Pieces<Dim, double, Law> one{law};
  Pieces<Dim, Wide, Law> eight{law};
  const auto seconds = fastest({[&] { one.stresses(); }, [&] { eight.stresses(); }, [&] { one.tangents(); },
                                [&] { eight.tangents(); }});
  const auto add = [&](const char* what, double scalar, double wide) {
    const double ns = 1e9 / (1.0 * points * repeats);
    results.add({fmt::format("{} {}D {}", name, Dim, what), ns * scalar, "ns/point", 0, ""});
    results.add(
        {fmt::format("{} {}D {} wide", name, Dim, what), ns * wide, "ns/point", wide / scalar, "one by one"});
  };
  add("stress", seconds[0], seconds[1]);
  add("tangent", seconds[2], seconds[3]);
}

}  // namespace

int main(int argc, char** argv) {
  Results results("material_laws", argc, argv);
  const MaterialParameters rubber_or_metal{.young_modulus = 10e6,
                                           .poisson_ratio = 0.45,
                                           .c20 = -1e5,
                                           .c30 = 1e5,
                                           .yield_stress = 1e5,
                                           .c01 = 1e5,
                                           .ogden_share_2 = 0.1,
                                           .ogden_share_3 = 0.1,
                                           .creep_rate = 1,
                                           .creep_stress = 1e5,
                                           .creep_exponent = 4,
                                           .relaxation_share_1 = 0.4,
                                           .relaxation_time_1 = 1};
  for (const LawChoice& choice : law_choices())
    std::visit(
        [&]<class Law>(const Law& law) {
          if constexpr (HistoryLaw<Law, 2>) {
            measure<2>(choice.name, Undeformed<Law>{law}, results);
            if constexpr (HistoryLaw<Law, 3>) measure<3>(choice.name, Undeformed<Law>{law}, results);
          } else {
            measure<2>(choice.name, law, results);
            measure<3>(choice.name, law, results);
          }
        },
        choice.make(rubber_or_metal));
}
