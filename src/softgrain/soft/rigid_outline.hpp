#pragma once
#include "softgrain/soft/topology.hpp"

namespace softgrain {

/// A rigid disk of unit radius, its outline through so many vertices. Raises UsageError for fewer than 8.
Topology rigid_disk(int vertices);

}  // namespace softgrain
