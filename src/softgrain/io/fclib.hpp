#pragma once
#include <filesystem>
#include <vector>

#include "softgrain/contact/delassus_system.hpp"

namespace softgrain {

/// A frictional contact problem u = W p + q of an FCLIB file, in the file's own units (as a rule SI). Local
/// vectors are (normal, tangent) in 2D, (normal, tangent, tangent) in 3D, contact after contact.
struct FclibProblem {
  int dimension = 2;               ///< 2 or 3
  std::vector<MatrixEntry> W;      ///< Delassus matrix, dimension x contacts rows and columns
  std::vector<double> q;           ///< free velocity, length dimension x contacts
  std::vector<double> friction;    ///< mu >= 0 of each contact
  std::vector<double> solution_p;  ///< the impulse stored as solution/r, or empty
  std::vector<double> solution_u;  ///< the velocity stored as solution/u, or empty

  int contacts() const { return static_cast<int>(friction.size()); }
};

/// Reads a problem of FCLIB's HDF5 format (Acary et al., "FCLIB: a collection of discrete 3D frictional
/// contact problems", 2014). A local problem (group fclib_local) is taken as it is; a global one
/// (fclib_global), M v = H r + f and u = H^T v + w, becomes local by W = H^T M^-1 H and q = H^T M^-1 f + w.
/// Raises UsageError, naming file, dataset and remedy, for whatever is not such a file: other formats,
/// missing or mismatched data, NaN, indices outside the matrix, mu < 0, spacedim other than 2 or 3, equality
/// constraints, singular M.
FclibProblem read_fclib(const std::filesystem::path& file);

}  // namespace softgrain
