#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"
#include "softgrain/contact/contact_system.hpp"
#include "softgrain/core/error.hpp"

namespace softgrain {

/// Above these a problem is refused: assembling costs contacts^2, an entry 16 B.
inline constexpr int most_contacts_assembled = 20000;
inline constexpr std::size_t most_entries_assembled = 40'000'000;

/// Contact after contact, component after component.
template <int Dim>
std::vector<double> flat(std::span<const Vec<Dim>> vectors) {
  std::vector<double> numbers;
  numbers.reserve(Dim * vectors.size());
  for (const Vec<Dim>& v : vectors) numbers.insert(numbers.end(), v.c.begin(), v.c.end());
  return numbers;
}

/// The problem that a system poses which has no impulse yet: q as it shows it, and W column by column from
/// what an impulse at one contact does to all. W has no entry where nothing happens, and is sorted by
/// columns. The system comes back as it was but for round-off. Raises UsageError, naming the size, when the
/// problem is too large.
template <int Dim, ContactSystem<Dim> System>
ContactProblem contact_problem_of(System& system, std::span<const double> friction) {
  const int n = system.size();
  require(n <= most_contacts_assembled, "the problem has {} contacts, too many to assemble W: at most {}", n,
          most_contacts_assembled);
  std::vector<Vec<Dim>> before(n);
  double speed = 0;
  for (int c = 0; c < n; ++c) {
    before[c] = system.relative_velocity(c);
    speed = std::max(speed, norm(before[c]));
  }
  ContactProblem problem{
      .dimension = Dim, .W = {}, .q = flat<Dim>(before), .friction = {friction.begin(), friction.end()}};
  if (speed == 0) speed = 1;
  std::vector<int> moved;
  for (int c = 0; c < n; ++c) {
    const Mat<Dim> W_cc = system.delassus_block(c);
    for (int k = 0; k < Dim; ++k) {
      Vec<Dim> dp;
      dp[k] = speed / W_cc(k, k);  // an answer of the order of the velocities that are there
      system.apply_impulse(c, dp);
      moved.clear();
      for (int b = 0; b < n; ++b) {
        const Vec<Dim> du = system.relative_velocity(b) - before[b];
        if (du == Vec<Dim>{}) continue;
        moved.push_back(b);
        for (int i = 0; i < Dim; ++i)
          if (du[i] != 0) problem.W.push_back({Dim * b + i, Dim * c + k, du[i] / dp[k]});
      }
      system.apply_impulse(c, -dp);
      for (const int b : moved) before[b] = system.relative_velocity(b);
    }
    require(problem.W.size() <= most_entries_assembled,
            "W of {} contacts has more than {} entries, too many to assemble", n, most_entries_assembled);
  }
  return problem;
}

}  // namespace softgrain
