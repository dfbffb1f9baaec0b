#include "softgrain/geometry/wall_motion.hpp"

#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

/// Of what a step may move: a tenth of the smallest radius. Not true of what is no number.
bool is_small(double motion, double smallest_radius) { return motion <= smallest_radius / 10; }

[[noreturn]] void refuse_motion(double motion, double smallest_radius, std::string_view what,
                                const std::string& number) {
  throw NumericalError(fmt::format(
      "{}{} moves by {:.3g} m in a step, more than a tenth of the smallest radius {:.3g} m; use a "
      "smaller time step or a slower {}",
      what, number, motion, smallest_radius, what));
}

}  // namespace

template <int Dim>
void check_wall_motion(const Box<Dim>& box, double dt, double smallest_radius) {
  const std::vector<Wall<Dim>>& walls = box.walls;
  const Mat<Dim>& rate = box.cell.rate;
  if (const double motion = dt * std::sqrt(contract(rate, rate)); !is_small(motion, smallest_radius))
    refuse_motion(motion, smallest_radius, "cell", "");
  for (std::size_t a = 0; a < walls.size(); ++a) {
    if (const double motion = dt * norm(walls[a].velocity); !is_small(motion, smallest_radius))
      refuse_motion(motion, smallest_radius, "wall", fmt::format(" {}", a));
    for (std::size_t b = 0; b < a; ++b)
      if (dot(walls[a].normal, walls[b].normal) < -0.5 &&
          !(dot(walls[a].point - walls[b].point, walls[b].normal) > 0))
        throw NumericalError(fmt::format(
            "walls {} and {} have met, with grains between them; use a smaller time step or strain", b, a));
  }
}

template <int Dim>
AffineMotion<Dim>::AffineMotion(const Box<Dim>& box) : gradient(box.cell.gradient()) {
  const std::vector<Wall<Dim>>& walls = box.walls;
  constexpr double along = 1 - 1e-9;  // the axis
  for (int d = 0; d < Dim; ++d)
    for (const Wall<Dim>& low : walls)
      for (const Wall<Dim>& high : walls) {
        const double distance = high.point[d] - low.point[d];
        if (low.normal[d] < along || high.normal[d] > -along || !(distance > 0)) continue;
        origin[d] = low.point[d];
        velocity[d] = low.velocity[d];
        rate[d] = (high.velocity[d] - low.velocity[d]) / distance;
      }
}

template void check_wall_motion(const Box<2>&, double, double);
template void check_wall_motion(const Box<3>&, double, double);
template struct AffineMotion<2>;
template struct AffineMotion<3>;

}  // namespace softgrain
