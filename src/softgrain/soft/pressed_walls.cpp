#include "softgrain/soft/pressed_walls.hpp"

#include <algorithm>
#include <cmath>

namespace softgrain {

template <int Dim>
PushedBodies pressed_walls(const Box<Dim>& box, Contacts<Dim> contacts, Impulses<Dim> impulse, double dt) {
  PushedBodies pushed;
  if (box.presses.empty()) return pushed;
  std::vector<Pushing> of_wall(box.walls.size());
  for (const Press& press : box.presses) {
    const int body = static_cast<int>(pushed.bodies.size());
    for (std::size_t w = 0; w < box.walls.size(); ++w)
      if (press.share[w] != 0) of_wall[w] = {.contact = 0, .body = body, .share = press.share[w]};
    pushed.bodies.push_back({.free = press.free_speed(dt),
                             .mobility = press.mobility(dt),
                             .most = press.most,
                             .assumed = box.speed_of(press)});
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts[c].wall < 0) continue;
    Pushing pushing = of_wall[static_cast<std::size_t>(contacts[c].wall)];
    pushing.contact = static_cast<int>(c);
    if (pushing.share != 0) pushed.add(pushing, impulse[c][0], static_cast<int>(contacts.size()));
  }
  return pushed;
}

template <int Dim>
double move_presses(Box<Dim>& box, const PushedBodies& solved, double dt) {
  double furthest = 0;
  for (std::size_t k = 0; k < solved.bodies.size(); ++k) {
    const Press& press = box.presses[k];
    const double v = solved.bodies[k].velocity(), change = v - box.speed_of(press);
    box.set_speed(press, v);
    for (std::size_t w = 0; w < box.walls.size(); ++w) {
      box.walls[w].point += (dt * press.share[w] * change) * box.walls[w].normal;
      furthest = std::max(furthest, std::abs(dt * press.share[w] * change));
    }
  }
  return furthest;
}

template <int Dim>
void end_step_of_presses(Box<Dim>& box, Contacts<Dim> contacts, Impulses<Dim> impulse, double dt,
                         std::span<const double> more) {
  const PushedBodies pushed = pressed_walls(box, contacts, impulse, dt);
  for (std::size_t k = 0; k < box.presses.size(); ++k)
    box.presses[k].end_step(box.speed_of(box.presses[k]),
                            more.empty() ? pushed.bodies[k].push : pushed.bodies[k].push + more[k], dt);
}

template PushedBodies pressed_walls(const Box<2>&, Contacts<2>, Impulses<2>, double);
template double move_presses(Box<2>&, const PushedBodies&, double);
template void end_step_of_presses(Box<2>&, Contacts<2>, Impulses<2>, double, std::span<const double>);
template PushedBodies pressed_walls(const Box<3>&, Contacts<3>, Impulses<3>, double);
template double move_presses(Box<3>&, const PushedBodies&, double);
template void end_step_of_presses(Box<3>&, Contacts<3>, Impulses<3>, double, std::span<const double>);

}  // namespace softgrain
