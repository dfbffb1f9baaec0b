#pragma once
#include <cstdint>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// What a run will take, before it runs; a guide, good to a factor of about two.
struct Estimate {
  double particles = 0;  ///< bpm: primary particles; else points_of_grain of all
  double contacts = 0;   ///< bpm: 2.2 per primary, 4.2 in space, a dense packing has about 2 and 3; mpm: half
                         ///< of the outlines' vertices
  double steps = 0;      ///< of the loading path; preparing the sample comes on top
  double memory = 0;     ///< [bytes] as measured (docs/scaling.md)
  double shared_memory = 0;  ///< [bytes] of it, that which the ranks of softgrain-mpi divide among them
  double disk = 0;           ///< [bytes] snapshots and ParaView's files
  double hours = 0;          ///< [h] on one thread; bpm: with 17 sweeps a step, as usual
};

/// Material points of a grain that is not bonded; of a rigid one the vertices of its outline.
int points_of_grain(const Case& the_case);

/// The time step with which a run of the case begins [s], and the height of its box [m], both for grains of
/// mean size.
double first_time_step(const Case& the_case);
/// Of implicit steps, and of rigid grains alone [s], smallest_radius [m]: walls go 0.01 of it, and where some
/// keep a stress p while others move, grains have the time that they take to rearrange, R sqrt(rho/p).
double implicit_time_step(const Case& the_case, double smallest_radius);
double box_height(const Case& the_case);

/// Phi_0 at the start. sample.packing_fraction is that of the circles of the grains' diameters, of which an
/// ellipse or a polygon fills a part.
double first_packing_fraction(const Case& the_case);

/// Energy below which a run's balance is not judged [J/m]: that of all grains at the speed of the walls, or,
/// where an implicit step leaves forces as small as its tolerance, strained by 0.1 %.
double least_energy(const Case& the_case);

/// Estimates a valid case.
Estimate estimate(const Case& the_case);

}  // namespace softgrain
