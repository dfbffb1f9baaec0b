#include "softgrain/mixed/mixed_grains.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <span>

#include "softgrain/contact/joined_system.hpp"

namespace softgrain {
namespace {

/// Contacts of primaries, whose sweeps move the presses that others push, too.
struct PressedPrimaries {
  RigidContactSystem<2>& system;
  PushedBodies& own;  ///< that the system sweeps
  PushedBodies& all;  ///< of which all have the bodies

  int size() const { return system.size(); }
  Mat<2> delassus_block(int contact) const { return system.delassus_block(contact); }
  Vec<2> relative_velocity(int contact) const { return system.relative_velocity(contact); }
  void apply_impulse(int contact, const Vec<2>& dp) { system.apply_impulse(contact, dp); }
  void extrapolate(double b) { system.extrapolate(b); }
  Violation sweep(std::span<Vec<2>> impulse, std::span<const double> friction, const SolverOptions& options) {
    own.bodies = all.bodies;
    const Violation violation = system.sweep(impulse, friction, options);
    all.bodies = own.bodies;
    return violation;
  }
};

}  // namespace

MixedGrains::MixedGrains(MixedGrainsSetup setup)
    : elastic_(std::move(setup.elastic)),
      bonded_(std::move(setup.bonded)),
      elastic_number_(std::move(setup.elastic_number)),
      bonded_number_(std::move(setup.bonded_number)),
      kind_(std::move(setup.kind)),
      kinds_(setup.kinds),
      pair_friction_(std::move(setup.pair_friction)) {
  const std::vector<double>& radius = bonded_.dynamics().particles.radius;
  mean_primary_ = std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(radius.size());
}

StepReport MixedGrains::step(Box<2>& box, double dt) {
  bonded_.take_walls(box);
  StepReport report =
      elastic_.joint_step(box, dt, [&](const ContactsOfStep<2>& contacts) { return solve(contacts); });
  const int of_outlines = report.contacts, touching = of_outlines + bonded_report_.contacts;
  if (touching > 0)
    report.overlap_mean =
        (of_outlines * report.overlap_mean + bonded_report_.contacts * bonded_report_.overlap_mean) /
        touching;
  report.overlap_max = std::max(report.overlap_max, bonded_report_.overlap_max);
  report.contacts = touching + pushing();
  const SolverOptions solver = bonded_.solver_options();
  report.residual_limit = solver.worst_factor * solver.tolerance;
  return report;
}

/// A sub-step of the primaries, with all contacts as one system: of outlines, of primaries, of both.
SolverReport MixedGrains::solve(const ContactsOfStep<2>& step) {
  ExplicitDynamics& elastic = elastic_.dynamics();
  RigidDynamics<2>& bonded = bonded_.dynamics();
  const double dt = step.outline.dt;
  std::vector<PrimaryContact> found = neighbours_.detect(elastic.grains, step.outline, bonded.particles);
  impulse_ = carried_impulses(contacts_, impulse_, found);
  contacts_ = std::move(found);
  tell_who_is_met();
  if (elastic.impulse_time > 0 && elastic.impulse_time != dt)  // the same force
    for (Vec<2>& p : impulse_) p *= dt / elastic.impulse_time;

  PrimaryContactSystem between(contacts_, step.outline, step.velocity, step.inverse_mass, bonded.particles,
                               bonded.options.law.push_out);
  bonded.particles.presses = elastic.box.presses;
  RigidContactSystem<2> primaries = bonded_.begin_joint_step(dt);
  PushedBodies pressed = bonded.pressed_walls(dt);
  for (std::size_t k = 0; k < pressed.bodies.size(); ++k)
    step.pressed.bodies[k].push += pressed.bodies[k].push;
  primaries.push(pressed);
  primaries.apply_impulses(bonded.contacts.impulse);
  between.apply_impulses(impulse_);

  std::vector<Vec<2>> impulse(step.impulse.begin(), step.impulse.end());
  std::vector<double> mu(step.friction.begin(), step.friction.end());
  const auto append = [&](const std::vector<Vec<2>>& p, const std::vector<double>& friction) {
    impulse.insert(impulse.end(), p.begin(), p.end());
    mu.insert(mu.end(), friction.begin(), friction.end());
  };
  append(bonded.contacts.impulse, bonded.contacts.friction);
  append(impulse_, friction());
  PressedPrimaries pressed_primaries{primaries, pressed, step.pressed};
  JoinedSystem<2, PressedPrimaries, PrimaryContactSystem> of_primaries(pressed_primaries, between);
  JoinedSystem<2, LumpedSystem<2>, decltype(of_primaries)> all(step.system, of_primaries);
  SolverOptions options = bonded_.solver_options();  // the tighter of both tolerances
  options.velocity_scale = std::min(2 * mean_primary_ / dt,
                                    step.options.tolerance / options.tolerance * step.options.velocity_scale);
  const SolverReport report = solve_nlgs<2>(all, std::span(impulse), mu, options);
  auto solved = impulse.begin();
  for (const std::span<Vec<2>> part :
       {step.impulse, std::span(bonded.contacts.impulse), std::span(impulse_)}) {
    std::copy_n(solved, part.size(), part.begin());
    solved += static_cast<std::ptrdiff_t>(part.size());
  }

  elastic.other_push.clear();
  const PushedBodies by_primaries = bonded.pressed_walls(dt);
  for (std::size_t k = 0; k < step.pressed.bodies.size(); ++k) {
    elastic.other_push.push_back(by_primaries.bodies[k].push);
    set_press_speed(bonded.particles, elastic.box.presses[k], step.pressed.bodies[k].velocity());
  }

  const PrimaryWork work = between.work(impulse_);
  elastic.work.contacts += work.by_cell - work.on_outlines;
  elastic.work.walls += work.by_cell;
  bonded_report_ =
      bonded_.end_joint_step(report, dt, {.contact = -work.on_primaries, .friction = work.friction});
  for (std::size_t w = 0; w < elastic.box.walls.size(); ++w)
    elastic.box.impulse[w] += bonded.wall_impulse(static_cast<int>(w));
  return report;
}

/// mu of each contact of primaries and outlines.
std::vector<double> MixedGrains::friction() const {
  const Settings now = elastic_.settings();
  const ByKinds<double> of_kinds =
      friction_by_kinds(kinds_, now.friction.value_or(0), now.wall_friction.value_or(0), pair_friction_);
  const std::vector<int>& grain = bonded_.dynamics().particles.grain;
  std::vector<double> mu;
  for (const PrimaryContact& contact : contacts_)
    mu.push_back(
        of_kinds.of(kind_[elastic_number_[contact.grain]], kind_[bonded_number_[grain[contact.primary]]]));
  return mu;
}

int MixedGrains::pushing() const {
  return static_cast<int>(
      std::count_if(impulse_.begin(), impulse_.end(), [](const Vec<2>& p) { return p[0] > 0; }));
}

void MixedGrains::tell_who_is_met() {
  std::vector<char>& met = elastic_.dynamics().met;
  met.assign(elastic_number_.size(), 0);
  for (const PrimaryContact& contact : contacts_) met[contact.grain] = 1;
}

bool MixedGrains::is_exhausted(const StepReport&, const Box<2>& box) const {
  return bonded_.is_exhausted(bonded_report_, box);
}

void MixedGrains::follow(const Mat<2>& L) {
  elastic_.follow(L);
  bonded_.follow(L);
}

void MixedGrains::set(const Settings& settings) {
  elastic_.set(settings);
  bonded_.set(settings);
}

double MixedGrains::density() const {
  double area = 0;
  for (const double R : bonded_.radii()) area += std::numbers::pi * R * R;
  const double of_elastic = elastic_.dynamics().grains.undeformed_area();
  const std::vector<double>& mass = bonded_.dynamics().particles.mass;
  return (elastic_.density() * of_elastic + std::accumulate(mass.begin(), mass.end(), 0.0)) /
         (of_elastic + area);
}

Energies MixedGrains::energies() const {
  const Energies a = elastic_.energies(), b = bonded_.energies();
  return {.kinetic = a.kinetic + b.kinetic,
          .stored = a.stored + b.stored,
          .wall_work = a.wall_work + b.wall_work,
          .dissipation = a.dissipation + b.dissipation,
          .contact = a.contact + b.contact,
          .friction = a.friction + b.friction,
          .error = a.error + b.error};
}

/// Those of both engines; their sum where they have the same name.
Numbers MixedGrains::numbers(const Box<2>& box, const Energies&) const {
  Numbers all = elastic_.numbers(box, elastic_.energies());
  for (const auto& [name, value] : bonded_.numbers(box, bonded_.energies())) {
    const auto same =
        std::find_if(all.begin(), all.end(), [&name = name](const auto& of) { return of.first == name; });
    if (same == all.end())
      all.emplace_back(name, value);
    else
      same->second += value;
  }
  for (auto& [name, value] : all)
    if (name == "contacts") value += pushing();
  return all;
}

std::pair<double, double> MixedGrains::extent(int axis) const {
  const auto a = elastic_.extent(axis), b = bonded_.extent(axis);
  return {std::min(a.first, b.first), std::max(a.second, b.second)};
}

/// That which damps more: of the stiffer grains.
PressBody MixedGrains::press_body(const Box<2>& box, int axis, double dt) const {
  const PressBody a = elastic_.press_body(box, axis, dt), b = bonded_.press_body(box, axis, dt);
  return a.damper > b.damper ? a : b;
}

std::pair<double, double> MixedGrains::reach() const {
  const auto a = elastic_.reach(), b = bonded_.reach();
  return {std::min(a.first, b.first), std::max(a.second, b.second)};
}

}  // namespace softgrain
