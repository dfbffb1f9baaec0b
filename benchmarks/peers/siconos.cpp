// Siconos' nonlinear Gauss-Seidel for friction (fc2d_nsgs) and softgrain's on the same contact problem: the
// same W, q and mu, p = 0 at the start, the same residual. CPU time of one contact in one sweep.
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>
#include <fc2d_Solvers.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "harness.hpp"
#include "packing.hpp"
#include "softgrain/contact/nlgs.hpp"
#include "softgrain/contact/residual.hpp"
#include "softgrain/rigid/rigid_contact_system.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

constexpr double mu = 0.5;
constexpr int sweeps_from_zero = 300, sweeps_timed = 20;

/// W in Siconos' storage: 2 x 2 blocks, column by column, in rows.
class SiconosProblem {
 public:
  SiconosProblem(const FullProblem& full, double friction)
      : contacts_(static_cast<int>(full.q.size())), q_(2 * full.q.size()), mu_(full.q.size(), friction) {
    for (std::size_t c = 0; c < full.q.size(); ++c) q_[2 * c] = full.q[c][0], q_[2 * c + 1] = full.q[c][1];
    store_blocks(full.W);
    matrix_.nbblocks = static_cast<unsigned>(pointer_.size());
    matrix_.block = pointer_.data();
    matrix_.blocknumber0 = matrix_.blocknumber1 = static_cast<unsigned>(contacts_);
    matrix_.blocksize0 = matrix_.blocksize1 = last_row_.data();
    matrix_.filled1 = row_start_.size();
    matrix_.filled2 = pointer_.size();
    matrix_.index1_data = row_start_.data();
    matrix_.index2_data = column_.data();
    problem_ = {.dimension = 2,
                .numberOfContacts = contacts_,
                .M = NM_new_SBM(2 * contacts_, 2 * contacts_, &matrix_),
                .q = q_.data(),
                .mu = mu_.data()};
  }
  SiconosProblem(const SiconosProblem&) = delete;
  SiconosProblem& operator=(const SiconosProblem&) = delete;
  ~SiconosProblem() { std::free(problem_.M); }

  /// `sweeps` passes from the impulse given; no test of convergence that a pass could do without.
  void sweep(std::vector<Vec<2>>& impulse, int sweeps) {
    auto* options = solver_options_create(SICONOS_FRICTION_2D_NSGS);
    options->iparam[SICONOS_IPARAM_MAX_ITER] = sweeps;
    options->iparam[SICONOS_IPARAM_ERROR_EVALUATION] = SICONOS_ERROR_LIGHT_EVALUATION_NO_UPDATE;
    options->dparam[SICONOS_DPARAM_TOL] = 1e-30;
    velocity_.resize(q_.size());
    int info = 0;
    fc2d_nsgs_sbm(&problem_, impulse[0].c.data(), velocity_.data(), &info, options);
    solver_options_delete(options);
  }

 private:
  void store_blocks(std::vector<MatrixEntry> entries) {
    std::ranges::stable_sort(entries, {},
                             [](const MatrixEntry& e) { return std::pair(e.row / 2, e.column / 2); });
    row_start_.assign(contacts_ + 1, 0);
    int last_row = -1;
    for (const MatrixEntry& e : entries) {
      const int row = e.row / 2;
      const auto column = static_cast<std::size_t>(e.column / 2);
      if (row != last_row || column != column_.back()) {
        column_.push_back(column);
        values_.push_back({});
      }
      last_row = row;
      values_.back()[2 * (e.column % 2) + e.row % 2] += e.value;
      row_start_[row + 1] = column_.size();
    }
    for (auto& block : values_) pointer_.push_back(block.data());
    for (int c = 0; c < contacts_; ++c) last_row_.push_back(2 * (c + 1));
  }

  int contacts_;
  std::vector<double> q_, mu_, velocity_;
  std::vector<std::array<double, 4>> values_;
  std::vector<double*> pointer_;
  std::vector<std::size_t> row_start_, column_;
  std::vector<unsigned> last_row_;
  SparseBlockStructuredMatrix matrix_{};
  FrictionContactProblem problem_{};
};

/// |p - P(p - u)| / |q| with u = W p + q: one measure for all.
double residual(const FullProblem& full, const DelassusSystem<2>& empty, std::span<const Vec<2>> impulse) {
  DelassusSystem<2> system = empty;
  std::vector<Vec<2>> velocity;
  double q_squared = 0;
  for (int c = 0; c < system.size(); ++c) system.apply_impulse(c, impulse[c]);
  for (int c = 0; c < system.size(); ++c) {
    velocity.push_back(system.relative_velocity(c));
    q_squared += dot(full.q[c], full.q[c]);
  }
  const std::vector<double> friction(impulse.size(), mu);
  return natural_map_residual<2>(impulse, velocity, friction) / std::sqrt(q_squared);
}

/// One of the codes: it takes an impulse some sweeps further.
struct Solver {
  const char* name;
  std::function<void(std::vector<Vec<2>>&, int sweeps)> sweep;
};

void compare(const PackingSize& size, Results& results) {
  ContactProblem problem = collapse_problem(size, mu);
  const FullProblem full = full_problem(problem);
  const DelassusSystem<2> empty(full.W, full.q);
  const std::vector<Vec<2>> zero(full.q.size());
  SiconosProblem theirs(full, mu);
  DelassusSystem<2> stored = empty;
  RigidContactSystem<2> system(problem.particles, problem.contacts, problem.offset);
  const std::vector<double>& friction = problem.contacts.friction;

  const std::vector<Solver> solvers{
      {"Siconos fc2d_nsgs", [&](std::vector<Vec<2>>& p, int sweeps) { theirs.sweep(p, sweeps); }},
      {"softgrain, W in full",
       [&](std::vector<Vec<2>>& p, int sweeps) {
         for (int k = 0; k < sweeps; ++k) nlgs_sweep<2>(stored, p, friction, 1.0);
       }},
      {"softgrain, four-lane sweep",
       [&](std::vector<Vec<2>>& p, int sweeps) {
         for (int k = 0; k < sweeps; ++k) system.sweep(p, friction, {});
       }},
  };

  results.heading(fmt::format("{} disks, mu = {}, {} contacts, {} blocks of W", size.disks(), mu,
                              full.q.size(), full.W.size() / 4));
  std::vector<std::vector<Vec<2>>> p;
  for (const Solver& solver : solvers) {
    p.push_back(zero);
    solver.sweep(p.back(), sweeps_from_zero);
    results.add({.what = fmt::format("{} disks: residual after {} sweeps, {}", size.disks(), sweeps_from_zero,
                                     solver.name),
                 .value = residual(full, empty, p.back()),
                 .unit = "",
                 .ratio = residual(full, empty, p.back()) / residual(full, empty, p.front()),
                 .reference = "Siconos"});
  }
  const auto seconds = fastest(
      {[&] { solvers[0].sweep(p[0], sweeps_timed); }, [&] { solvers[0].sweep(p[0], 2 * sweeps_timed); },
       [&] { solvers[1].sweep(p[1], sweeps_timed); }, [&] { solvers[1].sweep(p[1], 2 * sweeps_timed); },
       [&] { solvers[2].sweep(p[2], sweeps_timed); }, [&] { solvers[2].sweep(p[2], 2 * sweeps_timed); }});
  for (int k = 0; k < 3; ++k) {
    const double extra = seconds[2 * k + 1] - seconds[2 * k];
    results.add({.what = fmt::format("{} disks: one contact in one sweep, {}", size.disks(), solvers[k].name),
                 .value = 1e9 * extra / (1.0 * sweeps_timed * problem.contacts.size()),
                 .unit = "ns",
                 .ratio = extra / (seconds[1] - seconds[0]),
                 .reference = "Siconos"});
  }
}

}  // namespace

int main(int argc, char** argv) {
  Results results("siconos", argc, argv);
  compare(small_packing, results);
  compare(middle_packing, results);
}
