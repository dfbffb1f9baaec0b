#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "softgrain/core/parallel.hpp"
#include "softgrain/soft/implicit_step.hpp"

namespace softgrain {
namespace {

/// The secant may take a grain at most this many corrections further, and back no further than it came.
constexpr double furthest = 4;

/// So far a grain moves in an iteration of a quasi-static step, at most, over the mean radius.
constexpr double largest_move = 0.1;

/// Of a quasi-static step: its largest correction, and the unbalanced force of a grain over its contact
/// force, in tolerances (docs/decisions/0023).
constexpr double quasi_static_correction = 8, quasi_static_force = 10;
/// The force where A has the inertia of a longer step, as hardly any force holds the grains: what is left of
/// it works along their long ways (docs/decisions/0031). Most of these steps reach the early bound at once.
constexpr double floppy_force = 4, early_floppy_force = 0.3;
constexpr int early_iterations = 40;

/// Of a line search: corrections that count, in tolerances, and how often a move is halved.
constexpr double searched_from = 10, most_halvings = 4;

/// |f|^2 of the node that moves most, lane by lane.
Wide squared_length(const WideVectors& f) {
  Wide most = 0.0;
  for (const Vec<2, Wide>& of_node : f) {
    const Wide square = dot(of_node, of_node);
    most = select(square <= most, most, square);  // NaN in one node is NaN in all
  }
  return most;
}

/// df . df and df . f of each lane, df = f - f_before.
std::array<Wide, 2> change_of(const WideVectors& f, const WideVectors& f_before) {
  Wide squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const Vec<2, Wide> df = f[i] - f_before[i];
    squares += dot(df, df);
    products += dot(df, f[i]);
  }
  return {squares, products};
}

/// The gamma for which |f - gamma df| is least, lane by lane.
Wide secant(const WideVectors& f, const WideVectors& f_before) {
  const auto [squares, products] = change_of(f, f_before);
  Wide gamma = 0.0;
  for (int lane = 0; lane < Wide::size; ++lane)
    if (squares[lane] > 0) gamma.set(lane, std::clamp(products[lane] / squares[lane], -furthest, 1.0));
  return gamma;
}

}  // namespace

/// Solves A f = r + H p/dt and moves x by f and what the iterations before add to it.
ImplicitDynamics::Imbalance ImplicitDynamics::correct(int iteration, bool same_matrix) {
  const std::vector<Vec<2>> force = contact_forces(grains, contacts, felt(), outline_.dt);
  own_for(grains.shares, batches(), [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    WideVectors& f = force_[b];
    f.assign(f.size(), {});
    grains.scatter_outline(force, batch, f);
    if (batch.topology->rigid()) return correct_rigid(b);
    kept_[b].assign(f.begin() + batch.topology->grid.outline_begin, f.end());
    matrix_[b].finish_solve(numbers(half_solved_[b]), numbers(kept_[b]), numbers(f));
    hold_correction(b);
  });
  const double correction = std::max(largest_correction_of_grains(), press_moved_) / mean_radius_;
  if (!quasi_static(outline_.dt)) {
    if (grains.has_history())
      follow_search(iteration == 1);
    else
      follow_secant(same_matrix && correction >= options.tolerance);
    return {.correction = correction, .residual = correction};
  }
  const bool floppy = inertia_of_ > options.inertia_of_at_most;
  const double largest_force = !floppy                         ? quasi_static_force
                               : iteration <= early_iterations ? early_floppy_force
                                                               : floppy_force;
  const double residual =
      std::max(correction / quasi_static_correction, unbalanced_force(force) / largest_force);
  follow_momentum(iteration == 1, residual >= options.tolerance);
  return {.correction = correction, .residual = residual};
}

/// Largest |f| of a node [m]; remembers its grain.
double ImplicitDynamics::largest_correction_of_grains() {
  std::vector<std::pair<double, int>> largest(batches());  // |f|^2 and the grain where it is
  const auto look = [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    const Wide most = squared_length(force_[b]);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      if (!(most[lane] <= largest[b].first)) largest[b] = {most[lane], batch.grain[lane]};
  };
  share(look, [&](int b, Message& message) { message(largest[b]); });
  double most = 0;
  for (const auto& [square, grain] : largest)
    if (!(square <= most)) most = square, failed_grain_ = grain;
  return std::sqrt(most);
}

/// What A has more than the tangent, (M (1/t^2 - 1/dt^2) + c p/l) f, summed over a grain: the force that is
/// not balanced yet, in units of the mean contact force of a grain or of the least that counts, whichever is
/// more. The largest of all grains.
double ImplicitDynamics::unbalanced_force(std::span<const Vec<2>> contact_force) {
  const double t = step_of_matrix(outline_.dt), dt = outline_.dt;
  const Wide rate = 1 / (t * t) - 1 / (dt * dt);
  std::vector<double> largest(batches());
  const auto look = [&](int b) {
    const GrainBatch& batch = grains.batches[b];
    WideVectors extra(force_[b].size());
    grains.scatter_outline(proximal_, batch, extra);
    Vec<2, Wide> sum{};
    for (int i = 0; i < batch.topology->grid.nodes(); ++i)
      sum += (rate * grains.node_mass(batch, i) + extra[i][0]) * force_[b][i];
    const Wide square = dot(sum, sum);
    for (int lane = 0; lane < Wide::size && batch.grain[lane] >= 0; ++lane)
      if (!(square[lane] <= largest[b])) largest[b] = square[lane];
  };
  share(look, [&](int b, Message& message) { message(largest[b]); });
  double scale = 0;
  for (const Vec<2>& f : contact_force) scale += norm(f) / grains.size();
  return std::sqrt(*std::max_element(largest.begin(), largest.end())) / std::max(scale, least_contact_force_);
}

std::vector<double> ImplicitDynamics::friction_of_contacts() const {
  return friction_by_kind().of<2>(grains, contacts, contacts_start_, impulse_start_);
}

double ImplicitDynamics::mean_contact_force(double dt) const {
  double sum = 0;
  for (const Vec<2>& p : impulse) sum += norm(p);
  return sum / (dt * grains.size());
}

/// For each grain by itself and dx its last move:
///   x += f - gamma (dx + df),
/// Anderson's method with one step back: A is stiffer than the tangent by the proximal term, so that f alone
/// goes the same share of the way in every iteration. The last iteration goes by f, as does the first one of
/// a matrix.
void ImplicitDynamics::follow_secant(bool accelerated) {
  const auto follow = [&](int b) {
    const WideVectors& f = force_[b];
    correction_[b].resize(f.size());
    moved_[b].resize(f.size());
    const Wide gamma = accelerated ? secant(f, correction_[b]) : 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      moved_[b][i] = accelerated ? f[i] - gamma * (moved_[b][i] + f[i] - correction_[b][i]) : f[i];
      grains.batches[b].position[i] += moved_[b][i];
    }
    correction_[b] = f;
    keep_rigid(b);
  };
  share(follow, [&](int b, Message& message) { pass_known(b, grains.batches[b].position, message); });
}

/// Newton's method with a line search, for each grain by itself: x += f; but where f has grown since the
/// iteration before, that one went too far, and half of its move is taken back. Points that flow have a
/// tangent that holds near by: without it iterations run away (docs/decisions/0081).
void ImplicitDynamics::follow_search(bool first) {
  const double counts = searched_from * options.tolerance * mean_radius_;
  const auto follow = [&](int b) {
    const WideVectors& f = force_[b];
    WideVectors& move = moved_[b];
    move.resize(f.size());
    if (first) size_[b] = std::numeric_limits<double>::infinity(), halvings_[b] = 0.0;
    const Wide square = squared_length(f);
    Wide ahead = 1.0, back = 0.0;  // shares of f and of the last move
    for (int lane = 0; lane < Wide::size; ++lane) {
      const double size = std::sqrt(square[lane]);
      if (size > std::max(size_[b][lane], counts) && halvings_[b][lane] < most_halvings) {
        ahead.set(lane, 0), back.set(lane, 0.5);
        halvings_[b].set(lane, halvings_[b][lane] + 1);
      } else {
        size_[b].set(lane, size);
        halvings_[b].set(lane, 0);
      }
    }
    for (std::size_t i = 0; i < f.size(); ++i) {
      grains.batches[b].position[i] += ahead * f[i] - back * move[i];
      move[i] = ahead * f[i] + back * move[i];
    }
    keep_rigid(b);
  };
  share(follow, [&](int b, Message& message) { pass_known(b, grains.batches[b].position, message); });
}

/// Nesterov's momentum, for each grain by itself, and from anew where it points against f (not where A is
/// new: motions of many grains, slower than any tangent, take longer than a matrix is kept):
///   y_k+1 = x_k+1 + (t_k - 1)/t_k+1 (x_k+1 - x_k),  x_k+1 = y_k + f(y_k),  t_k+1 = (1 + sqrt(1 + 4
///   t_k^2))/2.
/// Unlike a secant it also speeds up modes that grow, in which grains leave an unstable place.
/// No grain moves by more than `largest_move` in an iteration, and the last one goes by f.
void ImplicitDynamics::follow_momentum(bool first, bool accelerated) {
  const auto follow = [&](int b) {
    const WideVectors& f = force_[b];
    WideVectors& ahead = moved_[b];  // y_k - x_k
    if (first) {
      ahead.assign(f.size(), {});
      pace_[b] = 1.0;
    }
    Wide along = 0.0, kept = 0.0, beta = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) along += dot(f[i], ahead[i]);
    for (int lane = 0; lane < Wide::size; ++lane) {
      kept.set(lane, along[lane] < 0 ? 0.0 : 1.0);
      const double t = along[lane] < 0 ? 1.0 : pace_[b][lane];
      pace_[b].set(lane, 0.5 * (1 + std::sqrt(1 + 4 * t * t)));
      beta.set(lane, accelerated ? (t - 1) / pace_[b][lane] : 0.0);
    }
    WideVectors move(f.size());
    for (std::size_t i = 0; i < f.size(); ++i) {
      ahead[i] = beta * (f[i] + kept * ahead[i]);
      move[i] = f[i] + ahead[i];
    }
    const Wide square = squared_length(move);
    Wide shortened = 1.0;
    for (int lane = 0; lane < Wide::size; ++lane)
      if (const double length = std::sqrt(square[lane]) / mean_radius_; length > largest_move)
        shortened.set(lane, largest_move / length);
    for (std::size_t i = 0; i < f.size(); ++i) grains.batches[b].position[i] += shortened * move[i];
    keep_rigid(b);
  };
  share(follow, [&](int b, Message& message) { pass_known(b, grains.batches[b].position, message); });
}

}  // namespace softgrain
