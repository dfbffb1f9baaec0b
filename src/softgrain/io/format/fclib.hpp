#pragma once
#include <filesystem>
#include <vector>

#include "softgrain/contact/contact_problem.hpp"

namespace softgrain {

struct FclibFile {
  ContactProblem problem;
  std::vector<double> stored_velocity;  ///< u of the file's own solution (solution/u), or empty
  std::vector<double> stored_impulse;   ///< r of the same (solution/r), or empty; many files hold zeros
};

/// Reads a problem of FCLIB's HDF5 format (Acary et al., "FCLIB: a collection of discrete 3D frictional
/// contact problems", 2014). A local problem (group fclib_local) is taken as it is; a global one
/// (fclib_global), M v = H r + f and u = H^T v + w, becomes local by W = H^T M^-1 H and q = H^T M^-1 f + w.
/// Raises UsageError, naming file, dataset and remedy, for whatever is not such a file: other formats,
/// missing or mismatched data, NaN, indices outside the matrix, mu < 0, spacedim other than 2 or 3, equality
/// constraints, rolling friction, singular M.
FclibFile read_fclib(const std::filesystem::path& file);

/// Writes a local problem, W by compressed columns, with its solution (u and r). Raises IoError.
void write_fclib(const std::filesystem::path& file, const SolvedContactProblem& solved);

}  // namespace softgrain
