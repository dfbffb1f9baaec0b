#include "softgrain/core/shared_row.hpp"

namespace softgrain {

SharedRow::SharedRow(std::span<const double> weight, bool ring) : shares_(weight) {
  if (alone()) return;
  const int groups = static_cast<int>(weight.size());
  for (int left = ring ? -1 : 0; left + 1 < groups; ++left) {
    const int before = left < 0 ? groups - 1 : left, after = left + 1;
    if (mine(before) != mine(after))
      seams_.push_back({before, after, shares_.rank_of(mine(before) ? after : before)});
  }
  memory_.resize(seams_.size());
}

void SharedRow::tell(int groups, const std::function<void(int group, Message& message)>& result) const {
  if (!alone())
    shared_for(
        shares_, groups, [](int) {}, result);
}

/// After the groups whose number is odd, or even, as that of `worked`.
void SharedRow::swap(int worked, const Shared& shared) {
  const auto sends = [&](const Seam& seam) { return mine(seam.left % 2 == worked ? seam.left : seam.right); };
  std::vector<Parcel> parcels;
  for (std::size_t s = 0; s < seams_.size(); ++s) {
    Message count;
    shared(s, count);
    std::vector<std::byte>& memory = memory_[s];
    memory.resize(count.bytes());
    Parcel& parcel = parcels.emplace_back(Parcel{.rank = seams_[s].rank, .label = seams_[s].left});
    if (sends(seams_[s])) {
      Message message(memory.data(), true);
      shared(s, message);
      parcel.out = memory;
    } else {
      parcel.in = memory;
    }
  }
  communicator().swap(parcels);
  for (std::size_t s = 0; s < seams_.size(); ++s)
    if (!sends(seams_[s])) {
      Message message(memory_[s].data(), false);
      shared(s, message);
    }
}

}  // namespace softgrain
