#include "softgrain/mpm/elastic_contacts.hpp"

namespace softgrain {

ElasticContacts::ElasticContacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                 std::span<const OutlineCompliance> compliance,
                                 std::span<const Vec<2>> increment, double dt, ElasticScratch& scratch)
    : grains_(grains),
      contacts_(contacts),
      dt_(dt),
      compliance_(scratch.compliance),
      columns_(scratch.columns) {
  columns_.clear();
  number_vertices();
  copy_compliance(compliance);
  for (int v = 0; v < grains.outline_size(); ++v) {
    if (local_[v] < 0) continue;
    const std::size_t first = condensed_[grains.grain_of_vertex(v)].first + 2 * local_[v];
    increment_[first] = increment[v][0];
    increment_[first + 1] = increment[v][1];
  }
  places_.reserve(contacts.size());
  for (const OutlineContact& contact : contacts) places_.push_back(place_of(contact));
  delassus_.reserve(contacts.size());
  for (int c = 0; c < size(); ++c) delassus_.push_back(delassus_of(c));
}

void ElasticContacts::number_vertices() {
  local_.assign(grains_.outline_size(), -1);
  for (const OutlineContact& contact : contacts_) {
    local_[contact.vertex] = 0;
    if (contact.wall >= 0) continue;
    for (const int m : contact.master) local_[m] = 0;
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

ElasticContacts::Place ElasticContacts::place_of(const OutlineContact& contact) const {
  Place place;
  const auto set = [&](std::size_t k, int vertex, double weight) {
    place.at[k] = condensed_[grains_.grain_of_vertex(vertex)].first + 2 * local_[vertex];
    place.weight[k] = weight;
  };
  place.slave_grain = grains_.grain_of_vertex(contact.vertex);
  set(0, contact.vertex, 1);
  if (contact.wall >= 0) return place;
  place.count = 5;
  place.master_grain = grains_.grain_of_vertex(contact.master[0]);
  const auto weight = contact.weights();
  for (std::size_t m = 0; m < 4; ++m) set(m + 1, contact.master[m], -weight[m]);
  return place;
}

Vec<2> ElasticContacts::relative_velocity(int contact) const {
  const OutlineContact& c = contacts_[contact];
  const Place& place = places_[contact];
  Vec<2> apart;
  for (int k = 0; k < place.count; ++k) {
    const double* du = &increment_[place.at[k]];
    apart += place.weight[k] * Vec<2>{du[0], du[1]};
  }
  return {(c.gap + dot(c.normal, apart)) / dt_, (c.slip + dot(perpendicular(c.normal), apart)) / dt_};
}

/// A^-1 H_c on the two grains of a contact, for a unit force along an axis; made when first asked for.
const double* ElasticContacts::column(int contact, int axis) {
  Place& place = places_[contact];
  if (place.column[axis] >= 0) return &columns_[place.column[axis]];
  place.column[axis] = static_cast<std::ptrdiff_t>(columns_.size());
  const Vec<2>& n = contacts_[contact].normal;
  const Vec<2> direction = axis == 0 ? n : perpendicular(n);
  const auto append = [&](int grain, int first, int last) {
    const Condensed& g = condensed_[grain];
    const std::size_t width = 2 * g.count, begin = columns_.size();
    columns_.resize(begin + width);
    for (int k = first; k < last; ++k) {
      const double *x = &compliance_[g.matrix + (place.at[k] - g.first) * width], *y = x + width;
      const double a = place.weight[k] * direction[0], b = place.weight[k] * direction[1];
      for (std::size_t i = 0; i < width; ++i) columns_[begin + i] += a * x[i] + b * y[i];
    }
  };
  append(place.slave_grain, 0, 1);
  if (place.master_grain >= 0) append(place.master_grain, 1, 5);
  return &columns_[place.column[axis]];
}

void ElasticContacts::apply_impulse(int contact, const Vec<2>& dp) {
  const Place& place = places_[contact];
  for (int axis = 0; axis < 2; ++axis) {
    if (dp[axis] == 0) continue;
    const double force = dp[axis] / dt_;
    const double* A_inverse_H = column(contact, axis);
    for (const int grain : {place.slave_grain, place.master_grain}) {
      if (grain < 0) continue;
      const Condensed& g = condensed_[grain];
      double* du = &increment_[g.first];
      for (int k = 0; k < 2 * g.count; ++k) du[k] += force * A_inverse_H[k];
      A_inverse_H += 2 * g.count;
    }
  }
}

/// W_cc = H_c^T A^-1 H_c / dt^2 in local axes.
Mat<2> ElasticContacts::delassus_of(int contact) const {
  const Place& place = places_[contact];
  Mat<2> C;
  const auto add = [&](int grain, int first, int last) {
    const Condensed& g = condensed_[grain];
    for (int a = first; a < last; ++a)
      for (int b = first; b < last; ++b) {
        const double* block =
            &compliance_[g.matrix + (place.at[a] - g.first) * 2 * g.count + place.at[b] - g.first];
        const double weight = place.weight[a] * place.weight[b];
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) C(i, j) += weight * block[2 * g.count * i + j];
      }
  };
  add(place.slave_grain, 0, 1);
  if (place.master_grain >= 0) add(place.master_grain, 1, 5);
  const Vec<2>& n = contacts_[contact].normal;
  const std::array<Vec<2>, 2> axis{n, perpendicular(n)};
  Mat<2> W;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) W(i, j) = dot(axis[i], C * axis[j]) / (dt_ * dt_);
  return W;
}

std::vector<Vec<2>> contact_forces(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                   std::span<const Vec<2>> impulse, double dt) {
  std::vector<Vec<2>> force(grains.outline_size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec<2> f = (1 / dt) * impulse_vector(contacts[c], impulse[c]);
    force[contacts[c].vertex] += f;
    if (contacts[c].wall >= 0) continue;
    const auto weight = contacts[c].weights();
    for (std::size_t m = 0; m < 4; ++m) force[contacts[c].master[m]] -= weight[m] * f;
  }
  return force;
}

}  // namespace softgrain
