#include <array>

#include "softgrain/soft/elastic_contacts.hpp"

// Groups of contacts of implicit grains on ranks.

namespace softgrain {
namespace {

/// Rows and columns of the vertices in contact, of the compliance of an outline of `nodes`.
void append_condensed(const double* compliance, int nodes, std::span<const int> vertices,
                      std::vector<double>& condensed) {
  for (const int row : vertices)
    for (int i = 0; i < 2; ++i) {
      const double* of_row = compliance + static_cast<std::ptrdiff_t>(2 * row + i) * 2 * nodes;
      for (const int column : vertices)
        condensed.insert(condensed.end(), of_row + 2 * column, of_row + 2 * column + 2);
    }
}

}  // namespace

/// visit(grain) for all grains of the contacts of a group, with repeats.
template <class Visit>
void ElasticContacts::for_each_grain(int group, const Visit& visit) const {
  for (int k = levels_.begin[group]; k < levels_.begin[group + 1]; ++k) {
    const Contact& contact = contact_[levels_.contact[k]];
    visit(contact.slave_grain);
    if (contact.master_grain >= 0) visit(contact.master_grain);
  }
}

/// The work on a contact is about that of the entries of its columns.
void ElasticContacts::share_groups() {
  std::vector<double> weight(levels_.groups());
  for (int group = 0; group < levels_.groups(); ++group)
    for_each_grain(group, [&](int g) { weight[group] += grain_[g].width; });
  row_of_groups_ = {weight, false};
  at_seam_ = row_of_groups_.items_at_seams(
      grain_.size(), [&](int group, const auto& visit) { for_each_grain(group, visit); });
}

/// From the ranks that have the grains to those whose groups they are in, two at most: one message between
/// two ranks.
void ElasticContacts::fetch_compliance(const SoftGrains& grains, ElasticScratch& scratch) {
  const int me = communicator().rank(), ranks = communicator().ranks();
  std::vector<std::array<int, 2>> users(grain_.size(), {-1, -1});
  for (int group = 0; group < levels_.groups(); ++group) {
    const int rank = row_of_groups_.shares().rank_of(group);
    for_each_grain(group, [&](int g) {
      auto& [first, second] = users[g];
      if (first < 0)
        first = rank;
      else if (first != rank)
        second = rank;
    });
  }
  // visit(grain, owner, user) where these are two ranks
  const auto for_each_way = [&](const auto& visit) {
    for (int g = 0; g < grains.size(); ++g) {
      if (grains.topology(g).rigid()) continue;
      const int owner = grains.shares.rank_of(grains.batch_number(g));
      for (const int user : users[g])
        if (user >= 0 && user != owner) visit(grain_[g], owner, user);
    }
  };
  std::vector<std::vector<double>> out(ranks);
  std::vector<std::size_t> size(ranks), next(ranks);
  for_each_way([&](const Condensed& grain, int owner, int user) {
    if (owner == me)
      append_condensed(grain.compliance, grain.nodes,
                       std::span<const int>(vertex_).subspan(grain.first, grain.count), out[user]);
    if (user == me) size[owner] += static_cast<std::size_t>(4) * grain.count * grain.count;
  });
  scratch.compliance.resize(ranks);
  std::vector<Parcel> parcels;
  for (int r = 0; r < ranks; ++r) {
    scratch.compliance[r].resize(size[r]);
    if (!out[r].empty()) parcels.push_back({.rank = r, .out = std::as_bytes(std::span(out[r]))});
    if (size[r] > 0)
      parcels.push_back({.rank = r, .in = std::as_writable_bytes(std::span(scratch.compliance[r]))});
  }
  communicator().swap(parcels);
  for_each_way([&](Condensed& grain, int owner, int user) {
    if (user != me) return;
    grain.compliance = scratch.compliance[owner].data() + next[owner];
    grain.nodes = grain.count;
    grain.whole = false;
    next[owner] += static_cast<std::size_t>(4) * grain.count * grain.count;
  });
}

void ElasticContacts::gather(std::span<Vec<2>> impulse) const {
  row_of_groups_.tell(levels_.groups(), [&](int group, Message& message) {
    const int begin = levels_.begin[group], count = levels_.begin[group + 1] - begin;
    message.at(std::span<const int>(levels_.contact).subspan(begin, count), impulse);
  });
}

}  // namespace softgrain
