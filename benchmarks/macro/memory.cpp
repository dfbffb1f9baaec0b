// Memory of a bonded-particle packing: what stays allocated per primary and per contact, and the peak.
#include <fmt/core.h>
#include <malloc.h>
#include <sys/resource.h>

#include "harness.hpp"
#include "packing.hpp"
#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/rigid/step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

template <class T>
double bytes_of(const std::vector<T>& array) {
  return static_cast<double>(array.capacity() * sizeof(T));
}

/// The arrays of the contacts: every candidate has a place in each.
double bytes_of(const RigidContacts<2>& c) {
  return bytes_of(c.body_a) + bytes_of(c.body_b) + bytes_of(c.inverse_mass_a) + bytes_of(c.inverse_mass_b) +
         bytes_of(c.inverse_delassus) + bytes_of(c.friction) + bytes_of(c.normal) + bytes_of(c.gap) +
         bytes_of(c.impulse);
}

double allocated_bytes() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd);
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

struct Memory {
  double primaries, candidates, allocated, contact_arrays, peak;
};

/// After some steps of a packing whose disks attract one another, all of one grain.
Memory memory_of(const PackingSize& size) {
  const double before = allocated_bytes();
  AttractionForces attraction({.F0 = 1, .gamma = 7});
  RigidDynamics<2> dynamics(
      dense_packing(size), [](int, int) { return 0.0; }, {.solver = {.max_sweeps = 20}, .law = {}}, 0.15);
  const ForceField<2> field = [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
    attraction.update(particles, dynamics.reference);
    attraction.add_forces(particles, force);
  };
  for (int k = 0; k < 3; ++k) dynamics.step(field, 0.02);
  return {.primaries = 1.0 * dynamics.particles.size(),
          .candidates = 1.0 * dynamics.contacts.size(),
          .allocated = allocated_bytes() - before,
          .contact_arrays = bytes_of(dynamics.contacts),
          .peak = peak_bytes()};
}

}  // namespace

int main(int argc, char** argv) {
  Results results("memory", argc, argv);
  const Memory small = memory_of(middle_packing), large = memory_of(large_packing);
  results.heading(fmt::format("differences between {} and {} primaries", small.primaries, large.primaries));
  const double primaries = large.primaries - small.primaries;
  results.add({.what = "allocated, per primary",
               .value = (large.allocated - small.allocated) / primaries,
               .unit = "B"});
  results.add({.what = "of that its contacts, per primary",
               .value = (large.contact_arrays - small.contact_arrays) / primaries,
               .unit = "B"});
  results.add({.what = "contact arrays, per candidate contact",
               .value = (large.contact_arrays - small.contact_arrays) / (large.candidates - small.candidates),
               .unit = "B"});
  results.add({.what = "peak of the process, per primary",
               .value = (large.peak - small.peak) / primaries,
               .unit = "B"});
}
