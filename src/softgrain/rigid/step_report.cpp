#include <algorithm>

#include "softgrain/math/lanes.hpp"
#include "softgrain/rigid/step.hpp"

namespace softgrain {

/// Four contacts at once, without branches.
template <int Dim>
Overlaps RigidDynamics<Dim>::overlaps_of(const ContactBlock& block) const {
  const Vec<Dim>* p = contacts.impulse.data();
  const double* gap = contacts.gap.data();
  const auto overlap = [&](int c) { return p[c][0] > 0 ? std::max(0.0, -gap[c]) : 0; };
  Lanes carrying = splat(0), sum = splat(0), deepest = splat(0);
  int c = block.begin();
  for (; c + lane_count <= block.end(); c += lane_count) {
    const auto carries = Lanes{p[c][0], p[c + 1][0], p[c + 2][0], p[c + 3][0]} > 0;
    const Lanes depth = carries ? max(-load_lanes(gap + c), splat(0)) : splat(0);
    carrying += carries ? splat(1) : splat(0);
    sum += depth;
    deepest = max(deepest, depth);
  }
  Overlaps overlaps{static_cast<int>(horizontal_sum(carrying)), horizontal_sum(sum), horizontal_max(deepest)};
  for (; c < block.end(); ++c) overlaps += {p[c][0] > 0 ? 1 : 0, overlap(c), overlap(c)};
  return overlaps;
}

template <int Dim>
StepReport RigidDynamics<Dim>::report(const SolverReport& solver) const {
  StepReport report{.sweeps = solver.sweeps,
                    .residual_mean = solver.residual_mean,
                    .residual_max = solver.residual_max,
                    .converged = solver.converged};
  Overlaps overlaps;
  for (const Overlaps& of_block : overlaps_) overlaps += of_block;
  report.contacts = overlaps.contacts;
  if (report.contacts > 0) report.overlap_mean = overlaps.sum / (report.contacts * mean_radius_);
  report.overlap_max = overlaps.deepest / mean_radius_;
  return report;
}

template Overlaps RigidDynamics<2>::overlaps_of(const ContactBlock&) const;
template Overlaps RigidDynamics<3>::overlaps_of(const ContactBlock&) const;
template StepReport RigidDynamics<2>::report(const SolverReport&) const;
template StepReport RigidDynamics<3>::report(const SolverReport&) const;

}  // namespace softgrain
