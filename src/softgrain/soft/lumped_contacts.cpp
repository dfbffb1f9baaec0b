#include "softgrain/soft/lumped_contacts.hpp"

#include "softgrain/contact/law.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/parallel.hpp"

namespace softgrain {
namespace {

/// With fewer contacts threads cost more than they bring.
constexpr int least_for_threads = 512;

}  // namespace

/// sum weight v
inline Vec<2> LumpedContacts::velocity_of(const Row& row) const {
  const Vec<2>* v = velocity_.data();
  Vec<2> u = row.weight[0] * v[row.vertex[0]];
  if (row.vertices == 1) return u;
  Vec<2> others = row.weight[1] * v[row.vertex[1]] + row.weight[2] * v[row.vertex[2]];
  if (row.vertices == 5) others += row.weight[3] * v[row.vertex[3]] + row.weight[4] * v[row.vertex[4]];
  return u += others;
}

inline Vec<2> LumpedContacts::relative_velocity(const Row& row) const {
  const Vec<2> u = velocity_of(row);
  return {dot(row.normal, u) + row.offset[0], dot(perpendicular(row.normal), u) + row.offset[1]};
}

inline void LumpedContacts::apply_impulse(const Row& row, const Vec<2>& dp) {
  const Vec<2> P = dp[0] * row.normal + dp[1] * perpendicular(row.normal);
  Vec<2>* v = velocity_.data();
  v[row.vertex[0]] += row.mobility[0] * P;
  if (row.vertices == 1) return;
  for (std::size_t k = 1; k < 3; ++k) v[row.vertex[k]] += row.mobility[k] * P;
  if (row.vertices == 3) return;
  for (std::size_t k = 3; k < 5; ++k) v[row.vertex[k]] += row.mobility[k] * P;
}

LumpedContacts::LumpedContacts(std::span<const OutlineContact> contacts, const OutlineState& outline,
                               std::span<Vec<2>> velocity, std::span<const double> inverse_mass,
                               LumpedBodies& bodies, Scratch& scratch)
    : rows_(scratch.rows),
      strips_(scratch.strips),
      velocity_(velocity),
      of_bodies_(contacts, outline, velocity, inverse_mass, bodies) {
  strips_.sort(contacts, outline);
  rows_.resize(contacts.size());
  for_each_strip([&](int strip) {
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k) {
      if (!of_bodies_.has(strips_.order[k]))
        rows_[k] = row_of(contacts[strips_.order[k]], outline, inverse_mass);
      rows_[k].contact = strips_.order[k];
    }
  });
}

/// work(strip) for all even strips, then for all odd ones.
template <class Work>
void LumpedContacts::for_each_strip(const Work& work) const {
  if (size() >= least_for_threads) return parallel_alternate(strips_.count(), work);
  for (const int first : {0, 1})
    for (int strip = first; strip < strips_.count(); strip += 2) work(strip);
}

LumpedContacts::Row LumpedContacts::row_of(const OutlineContact& contact, const OutlineState& outline,
                                           std::span<const double> inverse_mass) const {
  Row row;
  std::size_t count = 0;
  contact.for_each_vertex([&](int vertex, double weight) {
    row.vertex[count] = vertex;
    row.weight[count] = weight;
    row.mobility[count] = weight * inverse_mass[vertex];
    row.delassus += weight * row.mobility[count++];
  });
  row.vertices = static_cast<int>(count);
  row.normal = contact.normal;
  if (contact.wall >= 0 || outline.cell.any()) {
    const Vec<2> v =
        contact.wall >= 0 ? outline.walls[contact.wall].velocity : (1 / outline.dt) * contact.image_motion;
    row.offset = {-dot(contact.normal, v), -dot(perpendicular(contact.normal), v)};
  }
  row.inverse_delassus = 1 / row.delassus;
  row.offset[0] += contact.gap / outline.dt - relative_velocity(row)[0];
  return row;
}

Vec<2> LumpedContacts::relative_velocity(int contact) const {
  return of_bodies_.has(contact) ? of_bodies_.relative_velocity(contact) : relative_velocity(row(contact));
}

void LumpedContacts::apply_impulse(int contact, const Vec<2>& dp) {
  of_bodies_.has(contact) ? of_bodies_.apply_impulse(contact, dp) : apply_impulse(row(contact), dp);
}

void LumpedContacts::apply_impulses(std::span<const Vec<2>> impulse) {
  for_each_strip([&](int strip) {
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k)
      if (const Vec<2>& p = impulse[rows_[k].contact]; p[0] > 0 && !of_bodies_.has(rows_[k].contact))
        apply_impulse(rows_[k], p);
  });
  for (const int c : of_bodies_.contacts())
    if (impulse[c][0] > 0) of_bodies_.apply_impulse(c, impulse[c]);
}

/// Puts one contact right, and adds the violation that it showed.
inline void LumpedContacts::solve(const Row& row, Vec<2>& p, double friction, const SolverOptions& options,
                                  Violation& violation) {
  const Vec<2> v = velocity_of(row);
  const double u_n = dot(row.normal, v) + row.offset[0];
  if (p[0] == 0 && u_n >= 0) return;
  const double u_t = friction > 0 ? dot(perpendicular(row.normal), v) + row.offset[1] : 0;
  const double gain = row.inverse_delassus;
  const Vec<2> solved = solve_uncoupled(p, Vec<2>{u_n, u_t}, gain, gain, friction);
  violation.add(row.delassus * (solved - p), solved[0]);
  const Vec<2> next = relaxed_impulse(p, solved, friction, options.relaxation);
  const Vec<2> dp = next - p;
  p = next;
  apply_impulse(row, dp);
}

Violation LumpedContacts::sweep(std::span<Vec<2>> impulse, std::span<const double> friction,
                                const SolverOptions& options) {
  std::vector<Violation> of_strip(strips_.count());
  for_each_strip([&](int strip) {
    Violation sum;
    for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k) {
      const int c = rows_[k].contact;
      if ((pushed_ && pushed_->has(c)) || of_bodies_.has(c)) continue;
      solve(rows_[k], impulse[c], friction[c], options, sum);
    }
    of_strip[strip] = sum;
  });
  Violation violation;
  for (const Violation& of_one : of_strip) violation += of_one;
  for (const int c : of_bodies_.contacts())
    if (!(pushed_ && pushed_->has(c)))
      nlgs_update<2>(*this, c, impulse[c], friction[c], options.relaxation, violation);
  if (pushed_) pushed_->sweep<2>(*this, impulse, friction, options.relaxation, violation);
  return violation;
}

}  // namespace softgrain
