#include "softgrain/mpm/lumped_contacts.hpp"

#include <algorithm>

namespace softgrain {

LumpedContacts::LumpedContacts(std::span<const OutlineContact> contacts, std::span<const Wall<2>> walls,
                               std::span<Vec<2>> velocity, std::span<const double> inverse_mass, double dt)
    : velocity_(velocity) {
  rows_.reserve(contacts.size());
  for (const OutlineContact& c : contacts) {
    Row row;
    row.vertex[0] = c.vertex;
    row.normal = c.normal;
    if (c.wall >= 0) {
      row.offset = {-dot(c.normal, walls[c.wall].velocity),
                    -dot(perpendicular(c.normal), walls[c.wall].velocity)};
    } else {
      const auto weight = c.weights();
      row.count = 5;
      for (std::size_t m = 0; m < 4; ++m) {
        row.vertex[m + 1] = c.master[m];
        row.weight[m + 1] = -weight[m];
      }
    }
    for (int k = 0; k < row.count; ++k) {
      row.answer[k] = row.weight[k] * inverse_mass[row.vertex[k]];
      row.delassus += row.weight[k] * row.answer[k];
    }
    row.offset[0] += c.gap / dt - relative_velocity(row)[0];
    rows_.push_back(row);
  }
}

Vec<2> LumpedContacts::relative_velocity(const Row& row) const {
  Vec<2> u = velocity_[row.vertex[0]];
  for (int k = 1; k < row.count; ++k) u += row.weight[k] * velocity_[row.vertex[k]];
  return {dot(row.normal, u) + row.offset[0], dot(perpendicular(row.normal), u) + row.offset[1]};
}

void LumpedContacts::apply_impulse(const Row& row, const Vec<2>& dp) {
  const Vec<2> P = dp[0] * row.normal + dp[1] * perpendicular(row.normal);
  for (int k = 0; k < row.count; ++k) velocity_[row.vertex[k]] += row.answer[k] * P;
}

Violation LumpedContacts::sweep(std::span<Vec<2>> impulse, std::span<const double> friction,
                                const SolverOptions& options) {
  Violation violation;
  for (int c = 0; c < size(); ++c) {
    const Row& row = rows_[c];
    Vec<2>& p = impulse[c];
    const Vec<2> u = relative_velocity(row);
    if (p[0] == 0 && u[0] >= 0) continue;
    Vec<2> solved{std::max(0.0, p[0] - u[0] / row.delassus), 0};
    if (const double most = friction[c] * solved[0]; most > 0)
      solved[1] = std::clamp(p[1] - u[1] / row.delassus, -most, most);
    const Vec<2> jump = row.delassus * (solved - p);
    violation.add(dot(jump, jump), solved[0] > 0);
    Vec<2> next = p + options.relaxation * (solved - p);
    if (options.relaxation > 1) next = project_on_coulomb_cone(next, friction[c]);
    const Vec<2> dp = next - p;
    p = next;
    apply_impulse(row, dp);
  }
  return violation;
}

}  // namespace softgrain
