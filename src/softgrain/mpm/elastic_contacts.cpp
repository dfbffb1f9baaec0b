#include "softgrain/mpm/elastic_contacts.hpp"

namespace softgrain {

ElasticContacts::ElasticContacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                 std::span<const OutlineCompliance> compliance,
                                 std::span<const Vec<2>> increment, double dt)
    : grains_(grains), contacts_(contacts), dt_(dt) {
  number_vertices();
  copy_compliance(compliance);
  for (int v = 0; v < grains.outline_size(); ++v) {
    if (local_[v] < 0) continue;
    const std::size_t first = condensed_[grains.grain_of_vertex(v)].first + 2 * local_[v];
    increment_[first] = increment[v][0];
    increment_[first + 1] = increment[v][1];
  }
  delassus_.reserve(contacts.size());
  for (const OutlineContact& contact : contacts) delassus_.push_back(delassus_of(contact));
}

void ElasticContacts::number_vertices() {
  local_.assign(grains_.outline_size(), -1);
  for (const OutlineContact& contact : contacts_) {
    local_[contact.vertex] = 0;
    if (contact.wall < 0) local_[contact.master[0]] = local_[contact.master[1]] = 0;
  }
  condensed_.resize(grains_.size());
  std::size_t vertices = 0, entries = 0;
  for (int g = 0; g < grains_.size(); ++g) {
    Condensed& grain = condensed_[g];
    for (int v = grains_.outline_begin(g); v < grains_.outline_end(g); ++v)
      if (local_[v] == 0) local_[v] = grain.count++;
    grain.first = 2 * vertices;
    grain.matrix = entries;
    vertices += grain.count;
    entries += static_cast<std::size_t>(4) * grain.count * grain.count;
  }
  increment_.resize(2 * vertices);
  compliance_.resize(entries);
}

/// The rows and columns of the vertices in contact, out of the lanes.
void ElasticContacts::copy_compliance(std::span<const OutlineCompliance> compliance) {
  std::vector<int> dofs;
  for (std::size_t b = 0; b < grains_.batches.size(); ++b) {
    const GrainBatch& batch = grains_.batches[b];
    const std::size_t width = 2 * batch.topology->grid.outline_nodes();
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
      const int grain = batch.grain[lane], begin = grains_.outline_begin(grain);
      dofs.clear();
      for (int v = begin; v < grains_.outline_end(grain); ++v)
        if (local_[v] >= 0) dofs.insert(dofs.end(), {2 * (v - begin), 2 * (v - begin) + 1});
      double* to =
          compliance_.data() + condensed_[grain].matrix;  // one past the end where nothing is in contact
      for (const int i : dofs)
        for (const int j : dofs) *to++ = compliance[b][i * width + j][lane];
    }
  }
}

Vec<2> ElasticContacts::increment_of(int vertex) const {
  const double* du = &increment_[condensed_[grains_.grain_of_vertex(vertex)].first + 2 * local_[vertex]];
  return {du[0], du[1]};
}

/// du += A^-1 e_vertex force, on the grain's vertices in contact.
void ElasticContacts::add_force(int vertex, const Vec<2>& force) {
  const Condensed& grain = condensed_[grains_.grain_of_vertex(vertex)];
  const double *x = row(grain, vertex, 0), *y = row(grain, vertex, 1);
  double* du = &increment_[grain.first];
  for (int k = 0; k < 2 * grain.count; ++k) du[k] += x[k] * force[0] + y[k] * force[1];
}

Vec<2> ElasticContacts::relative_velocity(int contact) const {
  const OutlineContact& c = contacts_[contact];
  Vec<2> apart = increment_of(c.vertex);
  if (c.wall < 0) {
    const auto weight = c.weights();
    for (int m = 0; m < 2; ++m) apart -= weight[m] * increment_of(c.master[m]);
  }
  return {(c.gap + dot(c.normal, apart)) / dt_, (c.slip + dot(perpendicular(c.normal), apart)) / dt_};
}

void ElasticContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const OutlineContact& c = contacts_[contact];
  const Vec<2> force = (1 / dt_) * (dp[0] * c.normal + dp[1] * perpendicular(c.normal));
  add_force(c.vertex, force);
  if (c.wall >= 0) return;
  const auto weight = c.weights();
  for (int m = 0; m < 2; ++m) add_force(c.master[m], -weight[m] * force);
}

Mat<2> ElasticContacts::compliance_between(int vertex_a, int vertex_b) const {
  const Condensed& grain = condensed_[grains_.grain_of_vertex(vertex_a)];
  Mat<2> C;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) C(i, j) = row(grain, vertex_a, i)[2 * local_[vertex_b] + j];
  return C;
}

/// W_cc = H_c^T A^-1 H_c / dt^2 in local axes.
Mat<2> ElasticContacts::delassus_of(const OutlineContact& contact) const {
  Mat<2> C = compliance_between(contact.vertex, contact.vertex);
  if (contact.wall < 0) {
    const auto weight = contact.weights();
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const Mat<2> master = compliance_between(contact.master[a], contact.master[b]);
        for (std::size_t k = 0; k < 4; ++k) C.c[k] += weight[a] * weight[b] * master.c[k];
      }
  }
  const std::array<Vec<2>, 2> axis{contact.normal, perpendicular(contact.normal)};
  Mat<2> W;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) W(i, j) = dot(axis[i], C * axis[j]) / (dt_ * dt_);
  return W;
}

std::vector<Vec<2>> contact_forces(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                   std::span<const Vec<2>> impulse, double dt) {
  std::vector<Vec<2>> force(grains.outline_size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec<2>& n = contacts[c].normal;
    const Vec<2> f = (1 / dt) * (impulse[c][0] * n + impulse[c][1] * perpendicular(n));
    force[contacts[c].vertex] += f;
    if (contacts[c].wall >= 0) continue;
    const auto weight = contacts[c].weights();
    for (int m = 0; m < 2; ++m) force[contacts[c].master[m]] -= weight[m] * f;
  }
  return force;
}

}  // namespace softgrain
