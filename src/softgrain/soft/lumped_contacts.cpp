#include "softgrain/soft/lumped_contacts.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "softgrain/contact/law.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/parallel.hpp"

namespace softgrain {
namespace {

/// A contact is wide open if u_n is so many times the tolerance of sweeps.
constexpr double wide_open = 16;
/// Where it is not known what sweeps must reach.
constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

template <int Dim>
inline Vec<Dim> LumpedSystem<Dim>::relative_velocity(const Row& row) const {
  return to_local(row.normal, velocity_of(row)) + row.offset;
}

template <int Dim>
[[gnu::always_inline]] inline void LumpedSystem<Dim>::apply_impulse(const Row& row, const Vec<Dim>& dp) {
  row.push(from_local(row.normal, dp), velocity_.data(), inverse_mass_.data());
}

template <int Dim>
LumpedSystem<Dim>::LumpedSystem(std::span<const ContactOf<Dim>> contacts, const OutlineStateOf<Dim>& outline,
                                std::span<ScatteredVec<Dim>> velocity, std::span<const double> inverse_mass,
                                LumpedBodiesOf<Dim>& bodies, Scratch& scratch, bool shared)
    : contacts_(contacts),
      scratch_(scratch),
      rows_(scratch.rows),
      strips_(scratch.strips),
      velocity_(velocity),
      inverse_mass_(inverse_mass),
      bodies_(bodies),
      of_bodies_(contacts, outline, velocity, inverse_mass, bodies) {
  if (!scratch_.kept) {
    if constexpr (Dim == 2)
      strips_.sort(contacts, outline);
    else
      strips_.sort(contacts);
    rows_.resize(contacts.size());
  }
  if (shared && of_bodies_.contacts().empty()) share_strips(Dim == 2 && outline.cell.repeats[0]);
  make_rows(outline);
}

/// Rows of this rank, where they are not kept, and their offsets.
template <int Dim>
void LumpedSystem<Dim>::make_rows(const OutlineStateOf<Dim>& outline) {
  for_each_own_strip([&](int strip) {
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k) {
      const int contact = strips_.order[k];
      const bool of_body = of_bodies_.has(contact);
      if (!scratch_.kept) {
        if (!of_body) rows_[k] = Row(contacts_[contact], inverse_mass_);
        rows_[k].contact = contact;
      }
      if (!of_body) set_offset(rows_[k], outline);
    }
  });
}

template <int Dim>
inline void LumpedSystem<Dim>::set_offset(Row& row, const OutlineStateOf<Dim>& outline) const {
  if constexpr (Dim == 2) {
    const OutlineContact& contact = contacts_[row.contact];
    if (contact.wall >= 0 || outline.cell.any()) {
      const Vec<2> v =
          contact.wall >= 0 ? outline.walls[contact.wall].velocity : (1 / outline.dt) * contact.image_motion;
      row.offset = -to_local(contact.normal, v);
    }
    row.offset[0] += contact.gap / outline.dt - relative_velocity(row)[0];
  } else {
    // the gap is linear: (g + dt n . (u - u_found))/dt = n . u + n . (x_start - x_faced)/dt
    Vec<3> faced;
    row.offset = {};
    if (row.wall >= 0) {
      const Wall<3>& wall = outline.walls[row.wall];
      faced = wall.point;
      row.offset = -to_local(row.normal, wall.velocity);
    } else if (outline.cell.any()) {
      const SurfaceContact& contact = contacts_[row.contact];
      faced = contact.image;
      row.offset = -to_local(row.normal, (1 / outline.dt) * contact.image_motion);
    }
    row.offset[0] = dot(row.normal, row.velocity(outline.start.data()) - faced) / outline.dt;
  }
}

template <int Dim>
Vec<Dim> LumpedSystem<Dim>::relative_velocity(int contact) const {
  return of_bodies_.has(contact) ? of_bodies_.relative_velocity(contact) : relative_velocity(row(contact));
}

template <int Dim>
void LumpedSystem<Dim>::apply_impulse(int contact, const Vec<Dim>& dp) {
  of_bodies_.has(contact) ? of_bodies_.apply_impulse(contact, dp) : apply_impulse(row(contact), dp);
}

template <int Dim>
void LumpedSystem<Dim>::apply_impulses(std::span<const Vec<Dim>> impulse) {
  for_each_strip([&](int strip) {
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k)
      if (const Vec<Dim>& p = impulse[rows_[k].contact];
          !(p == Vec<Dim>{}) && !of_bodies_.has(rows_[k].contact))
        apply_impulse(rows_[k], p);
  });
  for (const int c : of_bodies_.contacts())
    if (!(impulse[c] == Vec<Dim>{})) of_bodies_.apply_impulse(c, impulse[c]);
}

/// Puts one contact right, and adds the violation that it showed. Returns u_n where it is open, else -1.
template <int Dim>
[[gnu::always_inline]] inline double LumpedSystem<Dim>::solve(const Row& row, Vec<Dim>& p, double friction,
                                                              const SolverOptions& options,
                                                              Violation& violation) {
  const Vec<Dim> v = velocity_of(row);
  const double u_n = dot(row.normal, v) + row.offset[0];
  if (p[0] == 0 && u_n >= 0) return u_n;
  const double gain = row.inverse_delassus;
  if (Dim == 3 && friction == 0 && p[1] == 0 && p[Dim - 1] == 0) {
    const double jump = normal_impulse(p[0], u_n, gain) - p[0];
    violation.add(Vec<1>{row.delassus() * jump}, p[0] + jump);
    const double next = normal_impulse(p[0], u_n, options.relaxation * gain);
    row.push((next - p[0]) * row.normal, velocity_.data(), inverse_mass_.data());
    p[0] = next;
    return -1;
  }
  const Vec<Dim> u = friction > 0 ? to_local(row.normal, v) + row.offset : Vec<Dim>{u_n};
  const Vec<Dim> solved = solve_uncoupled(p, u, gain, gain, friction);
  violation.add(row.delassus() * (solved - p), solved[0]);
  const Vec<Dim> next = relaxed_impulse(p, solved, friction, options.relaxation);
  const Vec<Dim> dp = next - p;
  p = next;
  apply_impulse(row, dp);
  return -1;
}

template <int Dim>
struct LumpedSystem<Dim>::Sweep {
  std::span<Vec<Dim>> impulse;
  std::span<const double> friction;
  const SolverOptions& options;
};

template <int Dim>
void LumpedSystem<Dim>::sweep_strip(int strip, const Sweep& sweep, Violation& violation) {
  const auto turn = [&](const Row& row) {
    const int c = row.contact;
    solve(row, sweep.impulse[c], sweep.friction[c], sweep.options, violation);
  };
  if constexpr (Dim == 3) {
    const int end = scratch_.busy_end[strip];
    for (int k = strips_.begin[strip]; k < end; ++k) {
      Row::fetch(rows_[scratch_.turn[std::min(k + Row::turns_ahead, end - 1)]]);
      turn(rows_[scratch_.turn[k]]);
    }
  } else {
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k) {
      const int c = rows_[k].contact;
      if (!(pushed_ && pushed_->has(c)) && !of_bodies_.has(c)) turn(rows_[k]);
    }
  }
}

/// The first sweep over a strip, which finds the rows that are wide open.
template <int Dim>
void LumpedSystem<Dim>::sort_by_need(int strip, const Sweep& sweep, Violation& violation) {
  const double scale = sweep.options.velocity_scale;
  const double wide = scale > 0 ? wide_open * sweep.options.tolerance * scale : never;
  int busy = strips_.begin[strip], open = strips_.begin[strip + 1];
  for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k) {
    const int c = rows_[k].contact;
    if ((pushed_ && pushed_->has(c)) || of_bodies_.has(c)) continue;
    const double u_n = solve(rows_[k], sweep.impulse[c], sweep.friction[c], sweep.options, violation);
    (u_n > wide ? scratch_.turn[--open] : scratch_.turn[busy++]) = k;
  }
  scratch_.busy_end[strip] = busy, scratch_.open_begin[strip] = open;
}

/// Those of a strip that have had no turn since the first sweep.
template <int Dim>
void LumpedSystem<Dim>::look_at_open(int strip, const Sweep& sweep, Violation& violation) {
  int &busy = scratch_.busy_end[strip], &open = scratch_.open_begin[strip];
  for (int k = open; k < strips_.begin[strip + 1]; ++k) {
    const int at = scratch_.turn[k], c = rows_[at].contact;
    if (solve(rows_[at], sweep.impulse[c], sweep.friction[c], sweep.options, violation) >= 0) continue;
    std::swap(scratch_.turn[k], scratch_.turn[open++]);
    scratch_.turn[busy++] = at;
  }
}

/// The violation that work(strip, violation) adds up for all strips.
template <int Dim>
Violation LumpedSystem<Dim>::sweep_strips(const std::function<void(int strip, Violation& violation)>& work) {
  std::vector<Violation> of_strip(strips_.count());
  for_each_strip([&](int strip) {
    Violation sum;
    work(strip, sum);
    of_strip[strip] = sum;
  });
  row_of_strips_.tell(strips_.count(), [&](int strip, Message& message) { message(of_strip[strip]); });
  Violation violation;
  for (const Violation& of_one : of_strip) violation += of_one;
  return violation;
}

template <int Dim>
Violation LumpedSystem<Dim>::sweep(std::span<Vec<Dim>> impulse, std::span<const double> friction,
                                   const SolverOptions& options) {
  const Sweep sweep{impulse, friction, options};
  const bool first = Dim == 3 && !std::exchange(sorted_by_need_, true);
  if (first) {
    scratch_.turn.resize(rows_.size());
    scratch_.busy_end.resize(strips_.count()), scratch_.open_begin.resize(strips_.count());
  }
  Violation violation = sweep_strips([&](int strip, Violation& sum) {
    first ? sort_by_need(strip, sweep, sum) : sweep_strip(strip, sweep, sum);
  });
  for (const int c : of_bodies_.contacts())
    if (!(pushed_ && pushed_->has(c)))
      nlgs_update<Dim>(*this, c, impulse[c], friction[c], options.relaxation, violation);
  if (pushed_) pushed_->template sweep<Dim>(*this, impulse, friction, options.relaxation, violation);
  if (Dim == 3 && !first && report_of(violation, 1, options.velocity_scale, options).converged)
    violation += sweep_strips([&](int strip, Violation& sum) { look_at_open(strip, sweep, sum); });
  return violation;
}

template <int Dim>
void LumpedSystem<Dim>::extrapolate(double b) {
  auto& velocity = scratch_.velocity_before;
  auto& body = scratch_.body_before;
  velocity.resize(velocity_.size());
  parallel_ranges(static_cast<int>(velocity.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) softgrain::extrapolate(velocity_[v], velocity[v], b);
  });
  body.resize(bodies_.body.size());
  for (std::size_t k = 0; k < body.size(); ++k) {
    softgrain::extrapolate(bodies_.body[k].velocity, body[k].velocity, b);
    softgrain::extrapolate(bodies_.body[k].spin, body[k].spin, b);
  }
  if (pushed_) pushed_->extrapolate(b);
}

template class LumpedSystem<2>;
template class LumpedSystem<3>;

}  // namespace softgrain
