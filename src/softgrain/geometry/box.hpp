#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "softgrain/geometry/press.hpp"
#include "softgrain/geometry/wall.hpp"
#include "softgrain/math/vec.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// Walls of a box in the order of every list of them: pair p faces along axis Dim - 1 - p.
enum BoxWall : int { bottom_wall, top_wall, left_wall, right_wall };

/// What bounds the grains: pairs of walls that face each other, or directions in which all repeats itself. It
/// alone owns the walls, and what each felt.
template <int Dim>
struct Box {
  std::vector<Wall<Dim>> walls;      ///< bottom, top, then left, right, ... of the axes that have walls
  std::vector<Vec<Dim>> impulse;     ///< (walls) of the grains on each in the last step [N s/m in 2D]
  std::array<double, Dim> period{};  ///< [m] along each axis, 0: not periodic
  std::vector<Press> presses;        ///< that move some of the walls; no wall belongs to two

  Box() = default;
  Box(std::initializer_list<Wall<Dim>> all) : Box(std::vector<Wall<Dim>>(all)) {}
  Box(std::vector<Wall<Dim>> all) : walls(std::move(all)), impulse(walls.size()) {}

  /// True if walls face each other along the axis.
  bool bounded(int axis) const { return walls.size() >= 2 * static_cast<std::size_t>(Dim - axis); }
  /// True if every axis has walls or a period.
  bool closed() const {
    for (int axis = 0; axis < Dim; ++axis)
      if (!bounded(axis) && period[static_cast<std::size_t>(axis)] == 0) return false;
    return true;
  }
  const Wall<Dim>& low(int axis) const { return walls[2 * static_cast<std::size_t>(Dim - 1 - axis)]; }
  const Wall<Dim>& high(int axis) const { return walls[2 * static_cast<std::size_t>(Dim - 1 - axis) + 1]; }

  /// Distance of the walls along an axis, or the period [m].
  double length(int axis) const {
    if (!bounded(axis)) return period[static_cast<std::size_t>(axis)];
    return high(axis).point[axis] - low(axis).point[axis];
  }
  double height() const { return length(Dim - 1); }
  double width() const { return length(0); }
  /// Area [m^2] in 2D, volume [m^3] in 3D.
  double volume() const {
    double product = 1;
    for (int axis = 0; axis < Dim; ++axis) product *= length(axis);
    return product;
  }
  /// L_kk = (v_high - v_low)/length [1/s], negative in compression.
  double strain_rate(int axis) const {
    return (high(axis).velocity[axis] - low(axis).velocity[axis]) / length(axis);
  }

  /// b - a, along each periodic axis to the nearest image of b [m].
  Vec<Dim> difference(const Vec<Dim>& a, const Vec<Dim>& b) const {
    Vec<Dim> d = b - a;
    for (int axis = 0; axis < Dim; ++axis)
      if (const double L = period[static_cast<std::size_t>(axis)]; L > 0)
        d[axis] -= L * std::round(d[axis] / L);
    return d;
  }

  /// The speed of a press by the velocities of its walls [m/s].
  double speed_of(const Press& press) const {
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (press.share[w] != 0) return dot(walls[w].velocity, walls[w].normal) / press.share[w];
    return 0;
  }
  /// Gives the walls of a press the velocities that belong to its speed v [m/s].
  void set_speed(const Press& press, double v) {
    for (std::size_t w = 0; w < walls.size(); ++w)
      if (press.share[w] != 0) walls[w].velocity = (press.share[w] * v) * walls[w].normal;
  }

  /// What presses a wall outwards in the last step [N s/m in 2D].
  double outward_impulse(std::size_t wall) const { return -dot(impulse[wall], walls[wall].normal); }

  void visit(StateVisitor& visit) {
    std::vector<Vec<Dim>> point;
    for (const Wall<Dim>& wall : walls) point.push_back(wall.point);
    visit({"wall_point", "m", Owner::wall, Role::state, "point on each wall: bottom, top, left, right"},
          point);
    for (std::size_t w = 0; w < walls.size(); ++w) walls[w].point = point[w];
  }
};

}  // namespace softgrain
