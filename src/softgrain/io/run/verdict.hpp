#pragma once
#include <string>
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/experiment/run.hpp"

namespace softgrain {

/// The exit code of a run that came to its end, but is not to be trusted or did not complete its path.
constexpr int exit_doubtful = 5;

/// Beyond these a run is not to be trusted: docs/reliability.md says why.
struct VerdictLimits {
  double least_converged = 0.5;     ///< share of the steps
  double largest_overlap = 0.05;    ///< worst overlap over the radius
  double largest_residual = 0.05;   ///< worst residual, when it is above its own limit [-]
  double largest_imbalance = 0.02;  ///< of energy, over the largest energy
};

/// What the numbers of a run say, in words: the same on the terminal, in run.json, info, page and Python.
struct Verdict {
  /// "converged 99.8 % of 30 012 steps, worst residual 3e-05 (limit 2e-04), worst overlap 2e-05 of a radius,
  /// energy balanced to 6e-06"; then "; DO NOT TRUST IT: ..." with all doubts, and "; NOT REACHED: ...".
  /// 100 % only when every step converged; only what was measured.
  std::string words;
  /// Each number beyond its limit, with the limit: "only 12.0 % of the steps converged (least 50 %)"; and why
  /// the path was not completed.
  std::vector<std::string> doubts;
};

/// The one place that judges.
Verdict verdict_of(const RunReport& report, const LoadingOutcome& path = {},
                   const VerdictLimits& limits = {});

/// What may mend the numbers beyond their limits: keys of the case, and what they are now. Steps that do not
/// converge and a residual have one remedy.
std::vector<std::string> remedies_of(const RunReport& report, const Case& c,
                                     const VerdictLimits& limits = {});

}  // namespace softgrain
