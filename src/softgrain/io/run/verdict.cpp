#include "softgrain/io/run/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgrain/experiment/kinds.hpp"
#include "softgrain/io/run/progress.hpp"

namespace softgrain {
namespace {

/// 99.9 for all but one of 30 012.
double percent_converged(const RunReport& report) {
  const double share = static_cast<double>(report.steps_converged) / static_cast<double>(report.steps);
  return std::floor(1000 * share) / 10;
}

/// "6e-06", "no number".
std::string short_number(double number) {
  return std::isnan(number) ? "no number" : fmt::format("{:.0e}", number);
}

std::string two_digits(double number) {
  return std::isnan(number) ? "no number" : fmt::format("{:.2g}", number);
}

std::string facts(const RunReport& report) {
  std::string text =
      fmt::format("converged {:.1f} % of {} steps", percent_converged(report), grouped(report.steps));
  if (report.residual_limit > 0)
    text += fmt::format(", worst residual {} (limit {})", short_number(report.residual_max),
                        short_number(report.residual_limit));
  text += fmt::format(", worst overlap {} of a radius", short_number(report.overlap_max));
  if (report.energy.scale > 0) text += ", energy balanced to " + short_number(report.energy.imbalance());
  return text;
}

// Each comparison is false for NaN, which is a doubt.
std::vector<std::string> doubts_of(const RunReport& report, const VerdictLimits& limits) {
  std::vector<std::string> doubts;
  const double converged = percent_converged(report), least = 100 * limits.least_converged;
  if (!(converged >= least))
    doubts.push_back(fmt::format("only {:.1f} % of the steps converged (least {:g} %)", converged, least));
  if (!(report.overlap_max <= limits.largest_overlap))
    doubts.push_back(fmt::format("an overlap of {} of a radius (largest {:g})",
                                 two_digits(report.overlap_max), limits.largest_overlap));
  const double residual = std::max(report.residual_limit, limits.largest_residual);
  if (!(report.residual_max <= residual) && report.residual_limit > 0)
    doubts.push_back(
        fmt::format("a residual of {} (largest {:g})", two_digits(report.residual_max), residual));
  if (!(report.energy.imbalance() <= limits.largest_imbalance))
    doubts.push_back(fmt::format("energy out of balance by {} of its largest (largest {:g})",
                                 two_digits(report.energy.imbalance()), limits.largest_imbalance));
  return doubts;
}

/// A run whose steps solve their equations by Newton's method.
bool is_newton(const Case& c) { return is_elastic(c) && c.mpm.integrator == Integrator::backward_euler; }

}  // namespace

Verdict verdict_of(const RunReport& report, const LoadingOutcome& path, const VerdictLimits& limits) {
  Verdict verdict;
  if (report.steps > 0) {
    verdict.words = facts(report);
    verdict.doubts = doubts_of(report, limits);
  } else {
    verdict.words = "no step was made";
  }
  if (!verdict.doubts.empty())
    verdict.words += fmt::format("; DO NOT TRUST IT: {}", fmt::join(verdict.doubts, ", "));
  if (!path.shortfall.empty()) verdict.words += "; NOT REACHED: " + path.shortfall;
  if (!path.completed) verdict.doubts.push_back("not reached: " + path.shortfall);
  return verdict;
}

std::vector<std::string> remedies_of(const RunReport& report, const Case& c, const VerdictLimits& limits) {
  const std::string smaller_step = "a smaller time.step";
  const double residual = std::max(report.residual_limit, limits.largest_residual);
  const bool solved = percent_converged(report) >= 100 * limits.least_converged &&
                      (report.residual_limit <= 0 || report.residual_max <= residual);
  std::vector<std::string> remedies;
  if (!solved)
    remedies.push_back(
        "steps that do not converge: " +
        (has_bonded(c) ? fmt::format("a larger solver.max_sweeps ({} now) or ", c.solver.max_sweeps) : "") +
        smaller_step);
  if (!(report.overlap_max <= limits.largest_overlap))
    remedies.push_back("overlaps: slower walls or " + smaller_step);
  if (!(report.energy.imbalance() <= limits.largest_imbalance))
    remedies.push_back("energy: " + (is_newton(c)
                                         ? fmt::format("a smaller mpm.tolerance ({:g} now)", c.mpm.tolerance)
                                         : smaller_step));
  return remedies;
}

}  // namespace softgrain
