#include "softgrain/soft/elastic_contacts.hpp"

#include <algorithm>

#include "softgrain/contact/nlgs.hpp"
#include "softgrain/core/parallel.hpp"

namespace softgrain {
namespace {

/// Contacts that are worth a thread's while: some microseconds of a sweep.
constexpr int least_group = 256;

/// Numbers of a column that are worked on at once.
constexpr int lanes = lane_count;

}  // namespace

ElasticContacts::ElasticContacts(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                 std::span<const OutlineCompliance> compliance,
                                 std::span<const Vec<2>> increment, double dt, ElasticScratch& scratch,
                                 bool shared)
    : dt_(dt), grain_(grains.size()), contact_(contacts.size()) {
  for (std::size_t b = 0; b < grains.batches.size(); ++b) {
    const GrainBatch& batch = grains.batches[b];
    const int nodes = batch.topology->grid.outline_nodes();
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane) {
      grain_[batch.grain[lane]].nodes = nodes;
      if (!compliance[b].empty())
        grain_[batch.grain[lane]].compliance =
            compliance[b].data() + lane * static_cast<std::size_t>(4) * nodes * nodes;
    }
  }
  number_vertices(grains, contacts, increment);
  std::vector<int> slave(contacts.size()), master(contacts.size());
  std::size_t entries = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    slave[c] = contact_[c].slave_grain = grains.grain_of_vertex(contacts[c].vertex);
    master[c] = contact_[c].master_grain =
        contacts[c].wall >= 0 ? -1 : grains.grain_of_vertex(contacts[c].master[0]);
    contact_[c].column = entries;
    entries += grain_[slave[c]].width + (master[c] < 0 ? 0 : grain_[master[c]].width);
  }
  if (scratch.columns.size() < 2 * entries) scratch.columns.resize(2 * entries);
  columns_ = scratch.columns.data();
  tangential_ = entries;
  levels_ = contact_levels(slave, master, grains.size(), least_group);
  violation_.resize(levels_.groups());
  if (shared) share_groups();
  if (!row_of_groups_.alone()) fetch_compliance(grains, scratch);
  own_for(row_of_groups_.shares(), levels_.groups(), [&](int group) {
    for (int k = levels_.begin[group]; k < levels_.begin[group + 1]; ++k)
      set(contact_[levels_.contact[k]], contacts[levels_.contact[k]], grains);
  });
}

void ElasticContacts::number_vertices(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                      std::span<const Vec<2>> increment) {
  local_.assign(grains.outline_size(), -1);
  for (const OutlineContact& contact : contacts) {
    contact.for_each_vertex([&](int vertex, double) { local_[vertex] = 0; });
  }
  for (int g = 0; g < grains.size(); ++g) {
    Condensed& grain = grain_[g];
    grain.first = static_cast<int>(vertex_.size());
    grain.velocity = static_cast<int>(velocity_.size());
    for (int v = grains.outline_begin(g); v < grains.outline_end(g); ++v) {
      if (local_[v] < 0) continue;
      local_[v] = grain.count++;
      vertex_.push_back(v - grains.outline_begin(g));
      for (int d = 0; d < 2; ++d) velocity_.push_back(increment[v][d] / dt_);
    }
    grain.width = (2 * grain.count + lanes - 1) / lanes * lanes;
    velocity_.resize(grain.velocity + grain.width);
  }
}

void ElasticContacts::set(Contact& contact, const OutlineContact& found, const SoftGrains& grains) const {
  const auto set_vertex = [&](std::size_t k, int grain, int vertex, double weight) {
    contact.vertex[k] = number_of(grain_[grain], local_[vertex]);
    contact.velocity[k] = grain_[grain].velocity + 2 * local_[vertex];
    contact.weight[k] = weight;
  };
  contact.vertices = 0;
  found.for_each_vertex([&](int vertex, double weight) {
    set_vertex(static_cast<std::size_t>(contact.vertices++), grains.grain_of_vertex(vertex), vertex, weight);
  });
  contact.normal = found.normal;
  contact.start = {found.gap / dt_, found.slip / dt_};
  contact.delassus = delassus_of(contact);
}

/// W_cc = H_c^T A^-1 H_c / dt^2 in local axes.
Mat<2> ElasticContacts::delassus_of(const Contact& contact) const {
  Mat<2> C;
  const auto add = [&](int grain, int first, int last) {
    const double* compliance = grain_[grain].compliance;
    const std::ptrdiff_t width = 2 * grain_[grain].nodes;
    for (int a = first; a < last; ++a)
      for (int b = first; b < last; ++b) {
        const double* block = compliance + 2 * (contact.vertex[a] * width + contact.vertex[b]);
        const double weight = contact.weight[a] * contact.weight[b];
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) C(i, j) += weight * block[width * i + j];
      }
  };
  add(contact.slave_grain, 0, contact.of_slave());
  if (contact.master_grain >= 0) add(contact.master_grain, contact.of_slave(), contact.vertices);
  const std::array<Vec<2>, 2> axis{contact.normal, perpendicular(contact.normal)};
  Mat<2> W;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) W(i, j) = dot(axis[i], C * axis[j]) / (dt_ * dt_);
  return W;
}

/// sum_k w_k (A^-1)_k . direction / dt^2 over the vertices of one grain.
template <int Vertices>
void ElasticContacts::fill(const Contact& contact, int first, int grain, const Vec<2>& direction,
                           float* column) const {
  const Condensed& g = grain_[grain];
  const std::ptrdiff_t nodes_width = 2 * g.nodes;
  std::array<const double*, 2 * Vertices> row;
  std::array<double, 2 * Vertices> factor;
  for (int k = 0; k < 2 * Vertices; ++k) {
    const int vertex = first + k / 2;
    row[k] = g.compliance + (2 * contact.vertex[vertex] + k % 2) * nodes_width;
    factor[k] = contact.weight[vertex] * direction[k % 2] / (dt_ * dt_);
  }
  for (int i = 0; i < g.count; ++i) {
    const int at = 2 * number_of(g, i);
    double x = 0, y = 0;
    for (int k = 0; k < 2 * Vertices; ++k) {
      x += factor[k] * row[k][at];
      y += factor[k] * row[k][at + 1];
    }
    column[2 * i] = static_cast<float>(x);
    column[2 * i + 1] = static_cast<float>(y);
  }
  std::fill(column + 2 * g.count, column + g.width, 0.0F);
}

/// Made when first asked for: most contacts never carry an impulse, or none along the tangent.
const float* ElasticContacts::column(Contact& contact, int axis) {
  float* column = columns_ + (axis == 0 ? 0 : tangential_) + contact.column;
  if (contact.made[axis]) return column;
  contact.made[axis] = true;
  const Vec<2> direction = axis == 0 ? contact.normal : perpendicular(contact.normal);
  if (contact.of_slave() == 1)
    fill<1>(contact, 0, contact.slave_grain, direction, column);
  else
    fill<3>(contact, 0, contact.slave_grain, direction, column);
  if (contact.master_grain >= 0)
    fill<4>(contact, contact.of_slave(), contact.master_grain, direction,
            column + grain_[contact.slave_grain].width);
  return column;
}

void ElasticContacts::apply_impulse(int contact, const Vec<2>& dp) {
  Contact& c = contact_[contact];
  for (int axis = 0; axis < 2; ++axis) {
    if (dp[axis] == 0) continue;
    const double force = dp[axis];
    const float* A_inverse_H = column(c, axis);
    for (const int grain : {c.slave_grain, c.master_grain}) {
      if (grain < 0) continue;
      double* v = &velocity_[grain_[grain].velocity];
      const int width = grain_[grain].width;
      for (int i = 0; i < width; i += lanes)
        for (int k = i; k < i + lanes; ++k) v[k] += force * A_inverse_H[k];
      A_inverse_H += width;
    }
  }
}

/// Every second group on all threads, then the others.
template <class Work>
void ElasticContacts::for_each_in_order(const Work& work) {
  row_of_groups_.alternate(
      levels_.groups(),
      [&](int group) {
        for (int c = levels_.begin[group]; c < levels_.begin[group + 1]; ++c) work(levels_.contact[c], group);
      },
      [&](std::size_t seam, Message& message) {
        for (const int g : at_seam_[seam])
          message(std::span(velocity_).subspan(grain_[g].velocity, grain_[g].width));
      });
}

void ElasticContacts::apply_impulses(std::span<const Vec<2>> impulse) {
  for_each_in_order([&](int c, int) {
    if (!(impulse[c] == Vec<2>{})) apply_impulse(c, impulse[c]);
  });
}

Violation ElasticContacts::sweep(std::span<Vec<2>> impulse, std::span<const double> friction,
                                 const SolverOptions& options) {
  violation_.assign(violation_.size(), {});
  for_each_in_order([&](int c, int group) {
    if (pushed_ && pushed_->has(c)) return;
    nlgs_update<2>(*this, c, impulse[c], friction[c], options.relaxation, violation_[group]);
  });
  row_of_groups_.tell(levels_.groups(), [&](int group, Message& message) { message(violation_[group]); });
  Violation sum;
  for (const Violation& of_group : violation_) sum += of_group;
  if (pushed_) pushed_->sweep<2>(*this, impulse, friction, options.relaxation, sum);
  return sum;
}

void ElasticContacts::extrapolate(double b) {
  before_.resize(velocity_.size());
  for (std::size_t i = 0; i < velocity_.size(); ++i) softgrain::extrapolate(velocity_[i], before_[i], b);
  if (pushed_) pushed_->extrapolate(b);
}

std::vector<Vec<2>> contact_forces(const SoftGrains& grains, std::span<const OutlineContact> contacts,
                                   std::span<const Vec<2>> impulse, double dt) {
  std::vector<Vec<2>> force(grains.outline_size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec<2> f = (1 / dt) * impulse_vector(contacts[c], impulse[c]);
    contacts[c].for_each_vertex([&](int vertex, double weight) { force[vertex] += weight * f; });
  }
  return force;
}

}  // namespace softgrain
