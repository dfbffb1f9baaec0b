#pragma once
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "softgrain/geometry/periodic_cell.hpp"
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
  std::vector<Wall<Dim>> walls;   ///< bottom, top, then left, right, ... of the axes that have walls
  std::vector<Vec<Dim>> impulse;  ///< (walls) of the grains on each in the last step [N s/m in 2D]
  std::vector<Press> presses;     ///< that move some of the walls; no wall belongs to two
  PeriodicCell<Dim> cell;         ///< along the axes without walls
  double shear = 0;               ///< gamma, the integral of L_xy dt
  bool open_top = false;          ///< the top wall is open until a stage moves it
  /// sum_c P_c (x) l_c of the last step [N s m in 2D]: P of grain a on grain b, l the way from the centre of
  /// a to that of b, or to a wall; of a cell that repeats
  Mat<Dim> moment{};

  Box() = default;
  Box(std::initializer_list<Wall<Dim>> all) : Box(std::vector<Wall<Dim>>(all)) {}
  Box(std::vector<Wall<Dim>> all) : walls(std::move(all)), impulse(walls.size()) {}

  /// True if walls face each other along the axis.
  bool bounded(int axis) const { return walls.size() >= 2 * static_cast<std::size_t>(Dim - axis); }
  bool repeats(int axis) const { return cell.repeats[static_cast<std::size_t>(axis)]; }
  /// True if every axis has walls or repeats.
  bool closed() const {
    for (int axis = 0; axis < Dim; ++axis)
      if (!bounded(axis) && !repeats(axis)) return false;
    return true;
  }
  /// Faces of the box in the order of BoxWall: walls, or ends of the cell.
  std::size_t faces() const { return closed() ? 2 * Dim : walls.size(); }
  const Wall<Dim>& low(int axis) const { return walls[2 * static_cast<std::size_t>(Dim - 1 - axis)]; }
  const Wall<Dim>& high(int axis) const { return walls[2 * static_cast<std::size_t>(Dim - 1 - axis) + 1]; }

  /// Distance of the walls along an axis, or of the ends of the cell [m].
  double length(int axis) const {
    if (!bounded(axis)) return repeats(axis) ? cell.edges(axis, axis) : 0;
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
  /// What the pair of faces along an axis presses on: the product of the other lengths [m], [m^2] in 3D.
  double face(int axis) const {
    double product = 1;
    for (int other = 0; other < Dim; ++other)
      if (other != axis) product *= length(other);
    return product;
  }
  /// L_kk = (v_high - v_low)/length [1/s], negative in compression.
  double strain_rate(int axis) const {
    if (!bounded(axis)) return cell.gradient()(axis, axis);
    return (high(axis).velocity[axis] - low(axis).velocity[axis]) / length(axis);
  }

  /// Walls and cell go on for dt [s].
  void advance(double dt) {
    for (Wall<Dim>& wall : walls) wall.point += dt * wall.velocity;
    cell.advance(dt);
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

  /// What presses a face outwards in the last step [N s/m in 2D]: on an end of the cell, moment_kk/length_k,
  /// as at rest on a wall there.
  double outward_impulse(std::size_t face) const {
    if (face < walls.size()) return -dot(impulse[face], walls[face].normal);
    const int axis = Dim - 1 - static_cast<int>(face / 2);
    return moment(axis, axis) / length(axis);
  }

  void visit(StateVisitor& visit) {
    std::vector<Vec<Dim>> point;
    for (const Wall<Dim>& wall : walls) point.push_back(wall.point);
    visit({"wall_point", "m", Owner::wall, Role::state, "point on each wall: bottom, top, left, right"},
          point);
    for (std::size_t w = 0; w < walls.size(); ++w) walls[w].point = point[w];
    if (cell.any()) visit_cell(visit);
  }

 private:
  void visit_cell(StateVisitor& visit) {
    visit_matrix(visit,
                 {"cell", "m", Owner::run, Role::state, "lattice vectors of the periodic cell, as columns"},
                 cell.edges);
    visit_matrix(visit, {"cell_rate", "m/s", Owner::run, Role::state, "their velocities"}, cell.rate);
    visit_matrix(visit,
                 {"cell_moment", "N s", Owner::run, Role::state,
                  "sum of impulse times branch vector over the contacts of the last step"},
                 moment);
    visit({"shear_strain", "", Owner::run, Role::state, "of the periodic cell"}, shear);
  }
};

}  // namespace softgrain
