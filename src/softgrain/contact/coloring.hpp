#pragma once
#include <span>
#include <vector>

namespace softgrain {

/// Colours contacts so that no two of one colour touch the same particle: greedy, first free colour, in the
/// order given. Contacts of one colour may then be solved in any order, or at once, with the same bits.
///
/// body_a, body_b: (contacts); bodies >= particles are walls, whose velocity no impulse changes, and are
/// shared freely. The first contact of a particle gets the lowest colours: sizes fall, about 8-10 colours for
/// disks.
std::vector<int> color_contacts(std::span<const int> body_a, std::span<const int> body_b, int particles);

}  // namespace softgrain
