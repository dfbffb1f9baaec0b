#include <algorithm>

#include "softgrain/contact/adhesive_contacts.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/contact_work.hpp"
#include "softgrain/soft/explicit_step.hpp"
#include "softgrain/soft/pressed_walls.hpp"
#include "softgrain/soft/wall_couple.hpp"

// What an explicit step does with contacts.

namespace softgrain {
namespace {

/// Contacts are looked for up to this gap at the end of the free flight, in units of a segment of the
/// outline: the impulses of a stable step move a vertex by a few hundredths of it.
constexpr double contact_margin = 0.1;

/// Contacts that a thread takes at once.
constexpr int contacts_at_once = 256;

/// In space contacts keep their places for so many sub-steps, in which vertices come together by less than
/// the margin.
constexpr int sub_steps_per_search = 8;

}  // namespace

/// Where x + dt v will be.
template <int Dim>
void ExplicitStep<Dim>::find_contacts(double dt) {
  fly_outline(dt);
  box.advance(dt);
  outline_.walls = box.walls;
  outline_.cell = box.cell;
  outline_.dt = dt;
  if (impulse_time > 0 && impulse_time != dt) {  // the same force
    for (Vec<Dim>& p : impulse) p *= dt / impulse_time;
    for (double& a : attraction) a *= dt / impulse_time;
  }
  if constexpr (Dim == 3) {
    if (stable.until_search > 0) {
      --stable.until_search;
      if (box.cell.any())
        parallel_ranges(static_cast<int>(contacts.size()), [&](int begin, int end) {
          for (int c = begin; c < end; ++c) update_image(contacts[c], outline_);
        });
      return;
    }
    // rigid grains alone take long steps
    stable.until_search = grains.fastest_wave() > 0 ? sub_steps_per_search - 1 : 0;
  }
  std::vector<ContactOf<Dim>> found = neighbours_.detect(grains, outline_, contact_margin);
  impulse = carried_impulses(grains, contacts, impulse, found);
  if constexpr (Dim == 2)
    if (adheres()) attraction = carried_attraction(grains, contacts, attraction, found);
  contacts = std::move(found);
  forget_rows();
}

/// v_free, then v+.
template <int Dim>
SolverReport ExplicitStep<Dim>::kick_and_solve(double dt, const JointSolve<Dim>& joint) {
  const bool shared = box.presses.empty() && !adheres();  // their contacts take turns alone
  LumpedSystem<Dim> system(contacts, outline_, outline_velocity_, inverse_mass_, bodies_, lumped_scratch_,
                           shared);
  AdhesiveContacts adhesive;
  if constexpr (Dim == 2) {
    adhesive = adhesion_.contacts(grains, contacts, outline_, false, attraction);
    if (impulse_time <= 0) adhesion_energy = energy_at_start(adhesive);
  }
  lumped_scratch_.kept = Dim == 3;
  PushedBodies pressed = pressed_walls(box, contacts, felt(), dt);
  system.push(pressed);
  kick(dt);
  const std::vector<double>& friction = friction_of_contacts();
  system.apply_impulses(felt());
  SolverOptions solver = options.solver;
  solver.velocity_scale = mean_radius_ / dt;
  const SolverReport solved =
      joint ? joint({outline_, outline_velocity_, inverse_mass_, system, pressed, impulse, friction, solver})
            : solve_adhesive<Dim>(system, adhesive, pressed, std::span(impulse), friction, solver);
  system.gather(impulse);
  impulse_time = dt;
  move_presses(box, pressed, dt);
  return solved;
}

/// Of grains that frictionless walls alone touch: what they gave in the step before.
template <int Dim>
void ExplicitStep<Dim>::take_back_spin() {
  if constexpr (Dim == 2) {
    const std::vector<Wide> alone = grains_on_smooth_walls_alone(grains, contacts, friction_by_kind(), met);
    if (std::none_of(alone.begin(), alone.end(), [](const Wide& of_batch) { return any(of_batch > 0.0); }))
      return;
    grains.know_all();  // it looks at whole grains
    grains.gather_outline(outline_.start);
    work.contacts -= turn_back(grains, alone, contacts, felt(), outline_.start);
  }
}

/// Of the contacts that carry impulse, over the smallest radius.
template <int Dim>
void ExplicitStep<Dim>::add_overlaps(SoftStepReport& report) const {
  const int count = static_cast<int>(contacts.size());
  struct Depths {
    double deepest = 0, sum = 0;
    int carrying = 0;
  };
  std::vector<Depths> depths((count + contacts_at_once - 1) / contacts_at_once);
  parallel_for(static_cast<int>(depths.size()), [&](int k) {
    for (int c = k * contacts_at_once; c < std::min(count, (k + 1) * contacts_at_once); ++c) {
      if (impulse[c][0] == 0) continue;
      const double depth = std::max(0.0, -gap_now(contacts[c], outline_));
      depths[k].deepest = std::max(depths[k].deepest, depth);
      depths[k].sum += depth;
      ++depths[k].carrying;
    }
  });
  Depths all;
  for (const Depths& part : depths) {
    all.deepest = std::max(all.deepest, part.deepest);
    all.sum += part.sum;
    all.carrying += part.carrying;
  }
  report.overlap_max = std::max(report.overlap_max, all.deepest / smallest_radius_);
  report.overlap_mean = all.carrying > 0 ? all.sum / all.carrying / smallest_radius_ : 0;
}

template <int Dim>
void ExplicitStep<Dim>::add_contact_work(double dt) {
  for (std::size_t v = 0; v < outline_velocity_.size(); ++v)  // moved by (v+ + v)/2 dt
    outline_.position[v] = outline_.start[v] + dt / 2 * (outline_velocity_[v] + outline_velocity_start_[v]);
  for (const Press& press : box.presses)
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      if (press.share[w] != 0)
        outline_.walls[w].velocity =
            0.5 * (box.walls[w].velocity + (press.share[w] * press.speed) * box.walls[w].normal);
  softgrain::add_contact_work<Dim>(contacts, felt(), outline_, work, box.impulse);
  outline_.walls = box.walls;
  end_step_of_presses(box, contacts, felt(), dt, other_push);
}

/// mu of each, which stay while the contacts and the law do, unless corners limit them.
template <int Dim>
const std::vector<double>& ExplicitStep<Dim>::friction_of_contacts() {
  const FrictionByKind law = friction_by_kind();
  if (law.follows_impulses() || friction_.size() != contacts.size() || !(law == friction_law_)) {
    friction_ = law.template of<Dim>(grains, contacts, contacts, impulse);
    friction_law_ = law;
  }
  return friction_;
}

/// (p_n - a, p_t) of the contacts [N s/m in the plane]; until it is called again.
template <int Dim>
const std::vector<Vec<Dim>>& ExplicitStep<Dim>::felt() {
  if constexpr (Dim == 2)
    if (!attraction.empty()) return felt_ = felt_impulses(impulse, attraction);
  return impulse;
}

/// What the energy of adhesion grew by, with the outlines at the end of the step.
template <int Dim>
void ExplicitStep<Dim>::add_adhesion() {
  if constexpr (Dim == 2) {
    if (!adheres()) return;
    const double now = adhesion_.energy(
        grains, contacts, [&](const OutlineContact& contact) { return gap_now(contact, outline_); });
    work.adhesion += now - adhesion_energy;
    adhesion_energy = now;
  }
}

template class ExplicitStep<2>;
template class ExplicitStep<3>;

}  // namespace softgrain
