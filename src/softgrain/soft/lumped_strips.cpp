#include <utility>

#include "softgrain/soft/lumped_contacts.hpp"

// Strips of contacts of explicit grains, on threads and on ranks.

namespace softgrain {
namespace {

/// With fewer contacts threads cost more than they bring.
constexpr int least_for_threads = 512;

}  // namespace

/// work(strip) for all even strips, then for all odd ones.
template <int Dim>
void LumpedSystem<Dim>::for_each_strip(const std::function<void(int strip)>& work) {
  if (!row_of_strips_.alone() || size() >= least_for_threads)
    return row_of_strips_.alternate(strips_.count(), work, [&](std::size_t seam, Message& message) {
      message.at(std::span<const int>(at_seam_[seam]), velocity_);
    });
  for (const int first : {0, 1})
    for (int strip = first; strip < strips_.count(); strip += 2) work(strip);
}

/// In any order, for those of this rank.
template <int Dim>
void LumpedSystem<Dim>::for_each_own_strip(const std::function<void(int strip)>& work) const {
  if (!row_of_strips_.alone() || size() >= least_for_threads)
    return own_for(row_of_strips_.shares(), strips_.count(), work);
  for (int strip = 0; strip < strips_.count(); ++strip) work(strip);
}

/// visit(vertex) for all vertices of the contacts of a strip, with repeats.
template <int Dim>
template <class Visit>
void LumpedSystem<Dim>::for_each_vertex(int strip, const Visit& visit) const {
  for (int k = strips_.begin[strip]; k < strips_.begin[strip + 1]; ++k)
    contacts_[strips_.order[k]].for_each_vertex([&](int vertex, double) { visit(vertex); });
}

template <int Dim>
void LumpedSystem<Dim>::share_strips(bool ring) {
  std::vector<double> weight;
  for (int strip = 0; strip < strips_.count(); ++strip)
    weight.push_back(strips_.begin[strip + 1] - strips_.begin[strip]);
  row_of_strips_ = {weight, ring && strips_.count() > 1};
  at_seam_ = row_of_strips_.items_at_seams(
      velocity_.size(), [&](int strip, const auto& visit) { for_each_vertex(strip, visit); });
}

template <int Dim>
void LumpedSystem<Dim>::gather(std::span<Vec<Dim>> impulse) {
  if (row_of_strips_.alone()) return;
  std::vector<int> strip_of(velocity_.size(), -1);  // the last that has listed a vertex
  std::vector<std::vector<int>> vertices(strips_.count());
  for (int strip = 0; strip < strips_.count(); ++strip)
    for_each_vertex(strip, [&](int v) {
      if (std::exchange(strip_of[v], strip) != strip) vertices[strip].push_back(v);
    });
  row_of_strips_.tell(strips_.count(), [&](int strip, Message& message) {
    const int begin = strips_.begin[strip], count = strips_.begin[strip + 1] - begin;
    message.at(std::span<const int>(strips_.order).subspan(begin, count), impulse);
    message.at(std::span<const int>(vertices[strip]), velocity_);
  });
}

template void LumpedSystem<2>::for_each_strip(const std::function<void(int)>&);
template void LumpedSystem<3>::for_each_strip(const std::function<void(int)>&);
template void LumpedSystem<2>::for_each_own_strip(const std::function<void(int)>&) const;
template void LumpedSystem<3>::for_each_own_strip(const std::function<void(int)>&) const;
template void LumpedSystem<2>::share_strips(bool);
template void LumpedSystem<3>::share_strips(bool);
template void LumpedSystem<2>::gather(std::span<Vec<2>>);
template void LumpedSystem<3>::gather(std::span<Vec<3>>);

}  // namespace softgrain
