#include "softgrain/bpm/bonded_grains.hpp"

#include <algorithm>
#include <cmath>

#include "softgrain/core/error.hpp"
#include "softgrain/geometry/ball.hpp"
#include "softgrain/geometry/support.hpp"
#include "softgrain/observe/clusters.hpp"
#include "softgrain/rigid/step_problem.hpp"

namespace softgrain {
namespace {

/// Two primaries of a grain hold together while their gap is below this share of a0 (F > 0.7 F0 for gamma =
/// 7).
constexpr double link_gap = 0.05;

/// Beyond this overlap over the mean radius, in the mean or of one contact, primaries have no solution.
constexpr double largest_mean_overlap = 0.05, largest_overlap = 0.5;

/// Beyond this mean overlap of the contacts, over the mean radius, primaries that fill at least this share of
/// the box are at their random close packing: the overlap is ten times smaller before, and grows tenfold with
/// each per cent of strain.
constexpr double close_packing_overlap = 5e-4;
template <int Dim>
constexpr double close_packing_fraction = Dim == 2 ? 0.82 : 0.55;
/// No random packing is as dense, overlaps included.
template <int Dim>
constexpr double fullest_fraction = Dim == 2 ? 0.95 : 0.78;

void refuse_overlaps(const StepReport& report) {
  if (report.overlap_mean <= largest_mean_overlap && report.overlap_max <= largest_overlap) return;
  throw NumericalError(fmt::format(
      "primaries overlap by {:.2g} of their radius in the mean, the deepest by {:.2g}, so the contact "
      "problem has no solution; use a smaller time.step or more solver.max_sweeps, or stop at a smaller "
      "loading.max_strain",
      report.overlap_mean, report.overlap_max));
}

}  // namespace

FrictionRule FrictionOfPrimaries::rule(const std::vector<int>& grain_of,
                                       const std::vector<int>& kind_of_grain) const {
  const auto kinds = static_cast<int>(inside.size());
  std::vector<int> kind;  // of each primary
  for (const int g : grain_of) kind.push_back(kind_of_grain[g]);
  return [mu = friction_by_kinds(kinds, between, wall, named), inside_of = inside, grain_of,
          kind = std::move(kind)](int a, int b) {
    if (b >= static_cast<int>(grain_of.size())) return mu.of(kind[a], PairFriction::wall);
    return grain_of[a] == grain_of[b] ? inside_of[kind[a]] : mu.of(kind[a], kind[b]);
  };
}

template <int Dim>
BondedGrainsOf<Dim>::BondedGrainsOf(BondedGrainsSetupOf<Dim> setup)
    : grain_radius_(std::move(setup.grain_radius)),
      kind_(std::move(setup.kind)),
      density_(setup.density),
      sigma_I_(setup.sigma_I),
      gravity_(setup.gravity),
      friction_(setup.friction),
      attraction_(std::move(setup.laws)),
      adhesion_(kind_, kinds(), setup.adhesion),
      dynamics_(std::move(setup.particles), {}, setup.options, setup.skin),
      most_sweeps_(setup.options.solver.max_sweeps) {
  dynamics_.set_friction(friction_.rule(dynamics_.particles.grain, kind_));
  dynamics_.share_grains();
  dynamics_.reference.reach = adhesion_.range();
  set_reference(dynamics_.reference, dynamics_.particles);
  dynamics_.rebuild_contacts();
  list_attraction();
  work_.height_start = energy_of_height();
  work_.energy_start = energy_of_attraction() + work_.height_start;
}

template <int Dim>
int BondedGrainsOf<Dim>::kinds() const {
  return static_cast<int>(friction_.inside.size());
}

template <int Dim>
bool BondedGrainsOf<Dim>::is_exhausted(const StepReport& report, const Box<Dim>& box) const {
  refuse_overlaps(report);
  if (!box.closed() || report.overlap_mean <= close_packing_overlap) return false;
  const double fraction = solid_fraction(box);
  if (fraction > fullest_fraction<Dim>)
    throw NumericalError(
        fmt::format("primaries fill {:.3f} of the box, more than fits: they have passed through each other "
                    "or the walls; use a smaller time.step or more solver.max_sweeps",
                    fraction));
  return fraction > close_packing_fraction<Dim>;
}

template <int Dim>
std::string BondedGrainsOf<Dim>::exhaustion(const Box<Dim>& box) const {
  return fmt::format(
      "the rigid primaries fill {:.3f} of the box, their random close packing, and overlap by more than {} "
      "of "
      "their radius in the mean: no smaller box holds them",
      solid_fraction(box), close_packing_overlap);
}

template <int Dim>
double BondedGrainsOf<Dim>::solid_fraction(const Box<Dim>& box) const {
  double filled = 0;
  for (const double r : dynamics_.particles.radius) filled += times_power<Dim>(1, r);
  return unit_ball<Dim> * filled / box.volume();
}

template <int Dim>
std::pair<double, double> BondedGrainsOf<Dim>::extent(int axis) const {
  const auto& p = dynamics_.particles;
  Vec<Dim> along;
  along[axis] = 1;
  return {-support<Dim>(p.position, p.radius, Vec<Dim>{} - along), support<Dim>(p.position, p.radius, along)};
}

template <int Dim>
std::pair<double, double> BondedGrainsOf<Dim>::reach() const {
  const auto [low, high] = extent(0);
  const double reach = 1.1 * grain_radius_.front() + (high - low) / 2;
  return {-reach, reach};
}

template <int Dim>
Energies BondedGrainsOf<Dim>::energies() const {
  const double kinetic = kinetic_energy(dynamics_.particles);  // at rest before the first step
  const double attraction = energy_of_attraction();
  return {.kinetic = kinetic,
          .stored = attraction,
          .wall_work = work_.walls,
          .dissipation = work_.dissipation,
          .contact = work_.between,
          .friction = work_.friction,
          .error = work_.walls - kinetic - (attraction + energy_of_height() - work_.energy_start) -
                   work_.dissipation};
}

template <int Dim>
double BondedGrainsOf<Dim>::energy_of_attraction() const {
  const double inside = attraction_.energy(dynamics_.particles);
  return adhesion_.any() ? inside + adhesion_.energy(dynamics_.particles, dynamics_.contacts) : inside;
}

template <int Dim>
double BondedGrainsOf<Dim>::energy_of_height() const {
  double energy = 0;
  for (int i = 0; i < dynamics_.particles.size(); ++i)
    energy -= dynamics_.particles.mass[i] * dot(gravity_, dynamics_.particles.position[i]);
  return energy;
}

template <int Dim>
int BondedGrainsOf<Dim>::clusters() const {
  const auto& p = dynamics_.particles;
  std::vector<std::pair<int, int>> links;
  attraction_.for_each_pair([&](int i, int j) {
    const double a0 = p.radius[i] + p.radius[j];
    if (norm(p.position[j] - p.position[i]) < (1 + link_gap) * a0) links.emplace_back(i, j);
  });
  return count_clusters(p.size(), links);
}

template <int Dim>
Numbers BondedGrainsOf<Dim>::numbers(const Box<Dim>& box, const Energies&) const {
  const auto& particles = dynamics_.particles;
  int contacts = 0, inner = 0;
  for (int c = 0; c < dynamics_.contacts.size(); ++c) {
    if (!(dynamics_.contacts.impulse[c][0] > 0)) continue;
    ++contacts;
    inner += dynamics_.contacts.body_b[c] < particles.size() ? 1 : 0;
  }
  Numbers numbers{{"contacts", contacts},
                  {"sigma_I", sigma_I_},
                  {"z_primaries", 2.0 * inner / particles.size()},
                  {"clusters", clusters()},
                  {"attraction_energy", attraction_.energy(particles)},
                  {"dissipation_rearrangement", work_.dissipation - work_.between}};
  if (adhesion_.any()) {
    numbers.emplace_back("adhesion_energy", adhesion_.energy(particles, dynamics_.contacts));
    numbers.emplace_back("attraction_ratio", attraction_ratio());
  }
  if (box.closed()) numbers.emplace_back("solid_fraction", solid_fraction(box));
  if (!(gravity_ == Vec<Dim>{}))
    numbers.emplace_back("gravity_work", work_.height_start - energy_of_height());
  return numbers;
}

/// Of the contacts between grains and with walls.
template <int Dim>
double BondedGrainsOf<Dim>::attraction_ratio() const {
  double pulls = 0, pushes = 0;
  for (int c = dynamics_.contacts.blocks.back().begin(); c < dynamics_.contacts.size(); ++c) {
    pulls += impulse_time_ * adhesion_.force(dynamics_.particles, dynamics_.contacts, c);
    pushes += dynamics_.contacts.impulse[c][0];
  }
  return pushes > 0 ? pulls / pushes : 0;
}

template <int Dim>
BodiesOf<Dim> BondedGrainsOf<Dim>::bodies() const {
  const auto& p = dynamics_.particles;
  return {p.mass, {p.velocity.begin(), p.velocity.begin() + p.size()}, p.grain};
}

template <int Dim>
std::vector<Vec<Dim>> BondedGrainsOf<Dim>::centres() const {
  const auto& particles = dynamics_.particles;
  std::vector<Vec<Dim>> centre(grain_radius_.size());
  std::vector<double> mass(grain_radius_.size(), 0);
  for (int i = 0; i < particles.size(); ++i) {
    centre[particles.grain[i]] += particles.mass[i] * particles.position[i];
    mass[particles.grain[i]] += particles.mass[i];
  }
  for (std::size_t g = 0; g < centre.size(); ++g) centre[g] *= 1 / mass[g];
  return centre;
}

/// Grains as stiff as their bonds, ten times sigma_I.
template <int Dim>
PressBody BondedGrainsOf<Dim>::press_body(const Box<Dim>& box, int axis, double dt) const {
  return critically_damped(density_, std::sqrt(10 * sigma_I_ / density_), box.length(axis), dt);
}

template <int Dim>
void BondedGrainsOf<Dim>::catch_problem() {
  keeps_problem_ = true;
}

template <int Dim>
SolvedContactProblem BondedGrainsOf<Dim>::caught_problem(double dt) {
  keeps_problem_ = false;
  return problem_of_step(dynamics_, std::move(velocity_start_), dt);
}

template class BondedGrainsOf<2>;
template class BondedGrainsOf<3>;

}  // namespace softgrain
