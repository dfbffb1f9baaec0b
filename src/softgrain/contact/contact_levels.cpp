#include "softgrain/contact/contact_levels.hpp"

#include <algorithm>
#include <cstddef>

namespace softgrain {
namespace {

/// The bodies that each body is in contact with, one list after the other; repeats are allowed.
struct Neighbours {
  std::vector<int> begin, body;

  Neighbours(std::span<const int> body_a, std::span<const int> body_b, int bodies) : begin(bodies + 1) {
    const auto for_each_pair = [&](auto&& visit) {
      for (std::size_t c = 0; c < body_a.size(); ++c) {
        const bool repeated = c > 0 && body_a[c] == body_a[c - 1] && body_b[c] == body_b[c - 1];
        if (body_b[c] >= 0 && !repeated) visit(body_a[c], body_b[c]);
      }
    };
    for_each_pair([&](int a, int b) { ++begin[a], ++begin[b]; });
    for (int i = 0, sum = 0; i <= bodies; ++i) begin[i] = sum += begin[i];  // ends, which become begins
    body.resize(begin[bodies]);
    for_each_pair([&](int a, int b) { body[--begin[a]] = b, body[--begin[b]] = a; });
  }
};

/// Breadth first; bodies that are in contact with none of these before start on the level after them.
std::vector<int> levels_of(const Neighbours& neighbours, int bodies) {
  std::vector<int> level(bodies, -1), queue;
  queue.reserve(bodies);
  for (int first = 0; first < bodies; ++first) {
    if (level[first] >= 0) continue;
    level[first] = queue.empty() ? 0 : level[queue.back()] + 1;
    std::size_t next = queue.size();
    for (queue.push_back(first); next < queue.size(); ++next) {
      const int i = queue[next];
      for (int k = neighbours.begin[i]; k < neighbours.begin[i + 1]; ++k) {
        const int j = neighbours.body[k];
        if (level[j] >= 0) continue;
        level[j] = level[i] + 1;
        queue.push_back(j);
      }
    }
  }
  return level;
}

}  // namespace

ContactLevels contact_levels(std::span<const int> body_a, std::span<const int> body_b, int bodies,
                             int least) {
  const std::vector<int> level = levels_of(Neighbours(body_a, body_b, bodies), bodies);
  const auto level_of = [&](std::size_t c) {
    return body_b[c] < 0 ? level[body_a[c]] : std::min(level[body_a[c]], level[body_b[c]]);
  };
  std::vector<int> group(bodies + 1);  // contacts of each level, then the group that the level belongs to
  for (std::size_t c = 0; c < body_a.size(); ++c) ++group[level_of(c)];
  ContactLevels levels;
  levels.begin.push_back(0);
  int contacts = 0;
  for (int& of_level : group) {
    const int here = of_level;
    of_level = levels.groups();
    contacts += here;
    if (contacts - levels.begin.back() >= least) levels.begin.push_back(contacts);
  }
  if (contacts > levels.begin.back()) levels.begin.push_back(contacts);
  levels.contact.resize(body_a.size());
  std::vector<int> place(levels.begin.begin(), levels.begin.end() - 1);
  for (std::size_t c = 0; c < body_a.size(); ++c)
    levels.contact[place[group[level_of(c)]]++] = static_cast<int>(c);
  return levels;
}

}  // namespace softgrain
