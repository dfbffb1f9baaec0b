#include "softgrain/io/format/fclib.hpp"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "softgrain/core/error.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/io/format/hdf5_file.hpp"

namespace softgrain {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int largest = std::numeric_limits<int>::max();

/// The datasets of one file, every number checked before it is used.
class Datasets {
 public:
  explicit Datasets(const std::filesystem::path& file) : name_(file.string()), reader_(file) {}

  bool has(const std::string& path) const { return reader_.has(path); }

  /// UsageError "FILE: dataset 'PATH' ..." unless ok.
  template <class... Args>
  void check(bool ok, const std::string& path, fmt::format_string<Args...> text, Args&&... args) const {
    if (ok) return;
    throw UsageError(fmt::format("{}: dataset '{}' {}; write the problem again with FCLIB", name_, path,
                                 fmt::format(text, std::forward<Args>(args)...)));
  }

  std::vector<double> reals(const std::string& path) const {
    const Array array = read(path);
    return std::visit([](const auto& v) { return std::vector<double>(v.begin(), v.end()); }, array.values);
  }
  /// As many finite reals as `size`.
  std::vector<double> vector(const std::string& path, std::size_t size) const {
    auto values = reals(path);
    check(values.size() == size, path, "holds {} numbers, needs {}", values.size(), size);
    check_finite(path, values);
    return values;
  }
  void check_finite(const std::string& path, const std::vector<double>& values) const {
    for (std::size_t k = 0; k < values.size(); ++k)
      check(std::isfinite(values[k]), path, "has {} as its number {}, must be finite", values[k], k);
  }
  std::vector<std::int64_t> integers(const std::string& path) const {
    Array array = read(path);
    auto* values = std::get_if<std::vector<std::int64_t>>(&array.values);
    check(values != nullptr, path, "must hold integers");
    return std::move(*values);
  }
  int integer(const std::string& path, int low, int high) const {
    const auto values = integers(path);
    check(values.size() == 1, path, "holds {} numbers, needs 1", values.size());
    check(low <= values[0] && values[0] <= high, path, "is {}, must be {} to {}", values[0], low, high);
    return static_cast<int>(values[0]);
  }
  std::vector<MatrixEntry> matrix(const std::string& group, std::size_t rows, std::size_t columns) const;

  /// FCLIB keeps such problems in groups named so, with coefficients mu_r.
  void refuse_rolling_friction() const {
    for (const std::string& path : reader_.datasets())
      if (path.find("rolling") != std::string::npos || path.ends_with("/mu_r"))
        throw UsageError(fmt::format(
            "{}: dataset '{}' belongs to a problem with rolling friction, and softgrain solves contacts with "
            "sliding friction only",
            name_, path));
  }

 private:
  Array read(const std::string& path) const {
    check(has(path), path, "is missing");
    return reader_.read(path);
  }
  std::vector<std::int64_t> expand(const std::string& path, std::size_t lines, std::size_t stored) const;

  std::string name_;
  Hdf5Reader reader_;
};

/// The line (row or column) of every entry, from the start pointers of compressed storage.
std::vector<std::int64_t> Datasets::expand(const std::string& path, std::size_t lines,
                                           std::size_t stored) const {
  const auto start = integers(path);
  check(start.size() == lines + 1, path, "holds {} pointers, needs {}", start.size(), lines + 1);
  check(start.front() == 0, path, "starts with {}, must start with 0", start.front());
  check(std::ranges::is_sorted(start), path, "has pointers that decrease");
  check(static_cast<std::size_t>(start.back()) <= stored, path, "counts {} entries, but {} are stored",
        start.back(), stored);
  std::vector<std::int64_t> line;
  for (std::size_t k = 0; k < lines; ++k)
    line.insert(line.end(), start[k + 1] - start[k], static_cast<std::int64_t>(k));
  return line;
}

/// A sparse matrix as CSparse stores it: nz >= 0 counts triplets (i = rows, p = columns); -1 means compressed
/// columns, -2 compressed rows (p = start pointers, i = the other index).
std::vector<MatrixEntry> Datasets::matrix(const std::string& group, std::size_t rows,
                                          std::size_t columns) const {
  const int m = integer(group + "/m", 0, largest), n = integer(group + "/n", 0, largest);
  check(static_cast<std::size_t>(m) == rows, group + "/m", "is {}, but the vectors need {} rows", m, rows);
  check(static_cast<std::size_t>(n) == columns, group + "/n", "is {}, but the vectors need {} columns", n,
        columns);
  const int nz = integer(group + "/nz", -2, largest);
  auto value = reals(group + "/x");
  const auto i = integers(group + "/i");
  const std::size_t stored = std::min(i.size(), value.size());
  const auto p = nz >= 0 ? integers(group + "/p") : expand(group + "/p", nz == -1 ? columns : rows, stored);
  const std::size_t entries = nz >= 0 ? static_cast<std::size_t>(nz) : p.size();
  check(entries <= std::min(stored, p.size()), group + "/nz", "is {}, but {} entries are stored", nz,
        std::min(stored, p.size()));
  value.resize(entries);
  check_finite(group + "/x", value);

  std::vector<MatrixEntry> matrix;
  for (std::size_t k = 0; k < entries; ++k) {
    const auto [row, column] = nz == -2 ? std::pair(p[k], i[k]) : std::pair(i[k], p[k]);
    check(0 <= row && row < m && 0 <= column && column < n, group,
          "has entry {} at ({}, {}), outside {} x {}", k, row, column, m, n);
    matrix.push_back({static_cast<int>(row), static_cast<int>(column), value[k]});
  }
  return matrix;
}

Sparse sparse(const std::vector<MatrixEntry>& entries, std::size_t rows, std::size_t columns) {
  std::vector<Eigen::Triplet<double>> triplets;
  for (const MatrixEntry& e : entries) triplets.emplace_back(e.row, e.column, e.value);
  Sparse matrix(static_cast<int>(rows), static_cast<int>(columns));
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

/// M v = H p + f, u = H^T v + w becomes u = W p + q with W = H^T M^-1 H, q = H^T M^-1 f + w.
void read_global(const Datasets& file, ContactProblem& problem) {
  const std::size_t size = problem.friction.size() * problem.dimension;
  const auto w = file.vector("/fclib_global/vectors/w", size);
  const auto f_values = file.reals("/fclib_global/vectors/f");
  file.check_finite("/fclib_global/vectors/f", f_values);
  const std::size_t unknowns = f_values.size();
  const Sparse M = sparse(file.matrix("/fclib_global/M", unknowns, unknowns), unknowns, unknowns);
  const Sparse H = sparse(file.matrix("/fclib_global/H", unknowns, size), unknowns, size);
  const Eigen::Map<const Eigen::VectorXd> f(f_values.data(), static_cast<Eigen::Index>(unknowns));

  Eigen::SparseLU<Sparse> M_factors;
  M_factors.compute(M);
  file.check(M_factors.info() == Eigen::Success, "/fclib_global/M", "is singular");
  const Sparse M_inverse_H = M_factors.solve(H);
  const Sparse W = H.transpose() * M_inverse_H;
  const Eigen::VectorXd q = H.transpose() * M_factors.solve(f);
  file.check(q.allFinite() && Eigen::Map<const Eigen::VectorXd>(W.valuePtr(), W.nonZeros()).allFinite(),
             "/fclib_global/M", "is singular to working precision");

  problem.q = w;
  for (std::size_t k = 0; k < size; ++k) problem.q[k] += q[static_cast<Eigen::Index>(k)];
  for (int column = 0; column < W.outerSize(); ++column)
    for (Sparse::InnerIterator entry(W, column); entry; ++entry)
      problem.W.push_back({static_cast<int>(entry.row()), column, entry.value()});
}

void refuse_equality_constraints(const Datasets& file, const std::string& group) {
  for (const char* name : {"/V", "/R", "/G", "/vectors/s", "/vectors/b"})
    file.check(!file.has(group + name), group + name,
               "belongs to equality constraints, and softgrain solves contacts only: eliminate them");
}

FclibFile read_problem(const Datasets& file) {
  const bool local = file.has("/fclib_local");
  const std::string group = local ? "/fclib_local" : "/fclib_global";
  file.refuse_rolling_friction();
  file.check(local || file.has(group), "/fclib_local", "is missing, and '/fclib_global' too");
  refuse_equality_constraints(file, group);

  FclibFile result;
  ContactProblem& problem = result.problem;
  problem.dimension = file.integer(group + "/spacedim", 2, 3);
  problem.friction = file.reals(group + "/vectors/mu");
  file.check_finite(group + "/vectors/mu", problem.friction);
  for (const double mu : problem.friction)
    file.check(mu >= 0, group + "/vectors/mu", "holds {}, must be >= 0", mu);
  const std::size_t size = problem.friction.size() * problem.dimension;
  file.check(size <= largest, group + "/vectors/mu", "has more contacts than can be counted");
  if (local) {
    problem.q = file.vector("/fclib_local/vectors/q", size);
    problem.W = file.matrix("/fclib_local/W", size, size);
  } else {
    read_global(file, problem);
  }
  if (file.has("/solution/r")) result.stored_impulse = file.vector("/solution/r", size);
  if (file.has("/solution/u")) result.stored_velocity = file.vector("/solution/u", size);
  return result;
}

}  // namespace

FclibFile read_fclib(const std::filesystem::path& file) {
  require(std::filesystem::is_regular_file(file), "{}: no such file", file.string());
  try {
    return read_problem(Datasets(file));
  } catch (const IoError& error) {  // not HDF5, cut short, damaged: the user's file, not our disk
    throw UsageError(
        fmt::format("{}; softgrain reads contact problems in FCLIB's HDF5 format", error.what()));
  }
}

void write_fclib(const std::filesystem::path& file, const SolvedContactProblem& solved) {
  const ContactProblem& problem = solved.problem;
  const auto size = static_cast<std::int64_t>(problem.q.size());
  std::vector<MatrixEntry> W = problem.W;
  std::ranges::stable_sort(W, {}, [](const MatrixEntry& e) { return std::pair(e.column, e.row); });
  std::vector<std::int64_t> start(problem.q.size() + 1), row;
  std::vector<double> value;
  for (const MatrixEntry& entry : W) {
    ++start[static_cast<std::size_t>(entry.column) + 1];
    row.push_back(entry.row);
    value.push_back(entry.value);
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];

  Hdf5Writer writer(file.string());
  const auto put_integer = [&](const std::string& path, std::int64_t number) {
    writer.write(path, {.columns = 1, .values = std::vector<std::int64_t>{number}});
  };
  put_integer("/fclib_local/spacedim", problem.dimension);
  put_integer("/fclib_local/W/m", size);
  put_integer("/fclib_local/W/n", size);
  put_integer("/fclib_local/W/nz", -1);  // compressed columns
  put_integer("/fclib_local/W/nzmax", static_cast<std::int64_t>(value.size()));
  writer.write("/fclib_local/W/p", {.columns = 1, .values = std::move(start)});
  writer.write("/fclib_local/W/i", {.columns = 1, .values = std::move(row)});
  writer.write("/fclib_local/W/x", {.columns = 1, .values = std::move(value)});
  writer.write("/fclib_local/vectors/mu", {.columns = 1, .values = problem.friction});
  writer.write("/fclib_local/vectors/q", {.columns = 1, .values = problem.q});
  writer.write("/solution/r", {.columns = 1, .values = solved.impulse});
  writer.write("/solution/u", {.columns = 1, .values = assess_impulses(solved, 0).velocity});
  write_file(file, writer.finish());
}

}  // namespace softgrain
