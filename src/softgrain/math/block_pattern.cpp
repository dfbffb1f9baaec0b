#include <algorithm>
#include <cassert>
#include <set>

#include "softgrain/math/block_cholesky.hpp"

namespace softgrain {
namespace {

/// Minimum degree on the first nodes, then the kept ones; `graph` becomes the pattern of the factor. Returns
/// the nodes in the order of elimination.
std::vector<int> eliminate(std::vector<std::set<int>>& graph, int kept) {
  const int n = static_cast<int>(graph.size());
  std::vector<int> sequence;
  std::vector<char> done(n, 0);
  std::vector<std::set<int>> below(n);
  for (int step = 0; step < n; ++step) {
    int next = n - kept + (step - (n - kept));
    if (step < n - kept) {
      next = -1;
      for (int i = 0; i < n - kept; ++i)
        if (done[i] == 0 && (next < 0 || graph[i].size() < graph[next].size())) next = i;
    }
    for (const int i : graph[next]) {
      graph[i].erase(next);
      for (const int j : graph[next])
        if (i != j) graph[i].insert(j);
    }
    done[next] = 1;
    below[next] = graph[next];
    sequence.push_back(next);
  }
  graph = std::move(below);
  return sequence;
}

}  // namespace

BlockPattern::BlockPattern(int nodes, std::span<const std::array<int, 2>> edges, int kept)
    : kept_(kept), order_(nodes) {
  std::vector<std::set<int>> graph(nodes);
  for (const auto& [i, j] : edges) {
    if (i == j) continue;
    graph[i].insert(j);
    graph[j].insert(i);
  }
  const std::vector<int> sequence = eliminate(graph, kept);
  for (int k = 0; k < nodes; ++k) order_[sequence[k]] = k;
  column_begin_.push_back(0);
  std::vector<std::vector<int>> left(nodes);
  for (int k = 0; k < nodes; ++k) {
    std::vector<int> rows{k};
    for (const int i : graph[sequence[k]]) rows.push_back(order_[i]);
    std::sort(rows.begin() + 1, rows.end());
    for (const int i : rows) {
      if (i != k) left[i].push_back(blocks());
      row_.push_back(i);
      column_of_.push_back(k);
    }
    column_begin_.push_back(blocks());
  }
  left_begin_.push_back(0);
  for (const auto& list : left) {
    left_.insert(left_.end(), list.begin(), list.end());
    left_begin_.push_back(static_cast<int>(left_.size()));
  }
}

int BlockPattern::block(int node_i, int node_j) const {
  const int column = std::min(order_[node_i], order_[node_j]), row = std::max(order_[node_i], order_[node_j]);
  const auto begin = row_.begin() + column_begin_[column], end = row_.begin() + column_begin_[column + 1];
  const auto found = std::lower_bound(begin, end, row);
  assert(found != end && *found == row);
  return static_cast<int>(found - row_.begin());
}

}  // namespace softgrain
