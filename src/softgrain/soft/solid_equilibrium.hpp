#pragma once
#include "softgrain/soft/history.hpp"
#include "softgrain/soft/soft_grains.hpp"

namespace softgrain {

using SolidGrains = GrainsOf<3>;
using SolidBatch = BatchOf<3>;

/// Raises UsageError for a material that grains in space cannot have: one that is not objective, and a law
/// that is written for the plane alone.
void require_solid(const GrainMaterial& material);

/// Internal force of the eight grains of a batch, f_i = sum_p V_p P_p dN_i/dX [N], at their positions, with
/// U' at each point or at the mean J of its cell, as the material says. Overwrites `force` (nodes). Returns
/// the lanes in which some point has det F <= 0: bit l; their force is void. A law with history answers from
/// it as it is, before anything flows.
unsigned internal_force(const SolidGrains& grains, const SolidBatch& batch, WidePlaces<3>& force);

/// The same, and the history of the points goes on over a step of dt [s] that ends there; `flow` is what that
/// took. Where a point is inverted the history is void too.
unsigned internal_force_and_history(const SolidGrains& grains, SolidBatch& batch, WidePlaces<3>& force,
                                    double dt, FlowOfStep& flow);

/// Elastic energy [J] of each grain of the batch; of a law with history what is stored now.
Wide elastic_energy(const SolidGrains& grains, const SolidBatch& batch);

/// Smallest J = det F of the points of each grain.
Wide least_J(const SolidBatch& batch);

/// The longest stable step [s] of explicit steps from where the grains are now, deformed as they are, with
/// damping over a share beta of the step:
///   dt_c = 2/(omega sqrt(1 + 2 beta)).
/// omega^2 is the largest eigenvalue of M^-1 K, by Lanczos' method from the force at places nearby, with what
/// it may still lack added; infinite where all are rigid. Single cells, as in the plane, would give less than
/// half of that step.
double longest_stable_step(const SolidGrains& grains, double damping_share);

/// A quick step [s]: `safety` times the smallest distance of two nodes of a cell over the wave speed.
double stable_time_step(const SolidGrains& grains, double safety);

}  // namespace softgrain
