#pragma once
#include <span>

#include "softgrain/contact/pushed_bodies.hpp"
#include "softgrain/geometry/box.hpp"
#include "softgrain/soft/contact_of.hpp"

namespace softgrain {

/// The presses of a box as bodies that contacts push in a step of dt [s]. The contacts were found with the
/// walls at the velocities that they have in the box; `impulse` is what they carry, (p_n, p_t) [N s/m].
template <int Dim>
PushedBodies pressed_walls(const Box<Dim>& box, Contacts<Dim> contacts, Impulses<Dim> impulse, double dt);

/// Gives the walls of the presses the velocities of their bodies, and brings them to where these lead in dt.
/// Returns the furthest that this moves a wall [m].
template <int Dim>
double move_presses(Box<Dim>& box, const PushedBodies& solved, double dt);

/// A step of dt [s] is over. more: (presses) pushes of other bodies [N s/m]; empty: none.
template <int Dim>
void end_step_of_presses(Box<Dim>& box, Contacts<Dim> contacts, Impulses<Dim> impulse, double dt,
                         std::span<const double> more = {});

}  // namespace softgrain
