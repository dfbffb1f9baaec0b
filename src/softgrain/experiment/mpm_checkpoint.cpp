#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/experiment/arrays.hpp"
#include "softgrain/experiment/mpm_simulation.hpp"
#include "softgrain/experiment/stable_step_state.hpp"

namespace softgrain {
namespace {

/// Raises IoError for vertices and walls that are not there.
std::vector<OutlineContact> restored_contacts(const Checkpoint& state, int vertices, int walls) {
  const auto bodies = state.arrays.find("contact_bodies");
  const auto* numbers =
      bodies == state.arrays.end() ? nullptr : std::get_if<std::vector<std::int64_t>>(&bodies->second.values);
  if (numbers == nullptr)
    throw IoError("the checkpoint has no array 'contact_bodies': it belongs to another case");
  const std::size_t count = numbers->size() / 6;
  std::vector<Vec<5>> places(count);
  from_array<5>(state, "contact_places", places);
  std::vector<OutlineContact> contacts;
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t k = 0; k < 6; ++k)
      if (const std::int64_t n = (*numbers)[6 * c + k];
          n < (k == 1 ? -1 : 0) || n >= (k == 1 ? walls : vertices))
        throw IoError(fmt::format("the checkpoint's array 'contact_bodies' holds {}", n));
    const auto body = [&](std::size_t k) { return static_cast<int>((*numbers)[6 * c + k]); };
    contacts.push_back({.vertex = body(0),
                        .wall = body(1),
                        .master = {body(2), body(3), body(4), body(5)},
                        .share = places[c][0],
                        .normal = {places[c][1], places[c][2]},
                        .gap = places[c][3],
                        .slip = places[c][4]});
  }
  return contacts;
}

}  // namespace

template <class Dynamics>
Checkpoint MpmSimulation<Dynamics>::checkpoint() const {
  Checkpoint state{.step = step_, .time = time(), .arrays = {}};
  std::vector<double> position, velocity;
  for (const GrainBatch& batch : dynamics_.grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          position.push_back(batch.position[i][d][lane]);
          velocity.push_back(batch.velocity[i][d][lane]);
        }
  state.arrays["position"] = {Wide::size, std::move(position)};
  state.arrays["velocity"] = {Wide::size, std::move(velocity)};
  std::vector<std::int64_t> bodies;
  std::vector<double> places;
  for (const OutlineContact& c : dynamics_.contacts) {
    bodies.insert(bodies.end(), {c.vertex, c.wall});
    bodies.insert(bodies.end(), c.master.begin(), c.master.end());
    places.insert(places.end(), {c.share, c.normal[0], c.normal[1], c.gap, c.slip});
  }
  state.arrays["contact_bodies"] = {6, std::move(bodies)};
  state.arrays["contact_places"] = {5, std::move(places)};
  state.arrays["contact_impulse"] = to_array<2>(dynamics_.impulse);
  std::vector<Vec<2>> wall_point;
  for (const Wall<2>& wall : dynamics_.walls) wall_point.push_back(wall.point);
  state.arrays["wall_point"] = to_array<2>(wall_point);
  const WorkBudget& work = dynamics_.work;
  std::vector<double> sums(sums_.impulse.begin(), sums_.impulse.end());
  sums.insert(sums.end(),
              {sums_.duration, sums_.iterations, sums_.rejected, drive_.state.stress,
               static_cast<double>(drive_.state.ended), dynamics_.impulse_time, work.walls, work.gravity,
               work.internal, work.contacts, work.inertia, work.friction, work.damping});
  state.arrays["sums"] = {1, std::move(sums)};
  state.arrays["fullness"] = {1, std::vector<double>{dynamics_.grains.topology(0).grid.fullness}};
  if constexpr (std::is_same_v<Dynamics, ExplicitDynamics>) save_stable_step(dynamics_.stable, state);
  drive_.save(state);
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>)
    state.arrays["sub_step"] = {1, std::vector<double>{dynamics_.sub_step}};
  return state;
}

template <class Dynamics>
void MpmSimulation<Dynamics>::restore(const Checkpoint& state) {
  if (state.arrays.contains("position") && !state.arrays.contains("fullness"))
    throw IoError(
        "the checkpoint has no array 'fullness': it is of a version whose grains had vertices outside their "
        "circles, which would be strained at once here; begin the run anew with --force");
  std::size_t nodes = 0;
  for (const GrainBatch& batch : dynamics_.grains.batches) nodes += batch.position.size();
  std::vector<Vec<2 * Wide::size>> position(nodes), velocity(nodes);
  from_array<2 * Wide::size>(state, "position", position);
  from_array<2 * Wide::size>(state, "velocity", velocity);
  std::size_t node = 0;
  for (GrainBatch& batch : dynamics_.grains.batches)
    for (std::size_t i = 0; i < batch.position.size(); ++i, ++node)
      for (int d = 0; d < 2; ++d)
        for (int lane = 0; lane < Wide::size; ++lane) {
          batch.position[i][d].set(lane, position[node][Wide::size * d + lane]);
          batch.velocity[i][d].set(lane, velocity[node][Wide::size * d + lane]);
        }
  dynamics_.contacts =
      restored_contacts(state, dynamics_.grains.outline_size(), static_cast<int>(dynamics_.walls.size()));
  dynamics_.impulse.resize(dynamics_.contacts.size());
  from_array<2>(state, "contact_impulse", dynamics_.impulse);
  std::vector<Vec<2>> wall_point(dynamics_.walls.size());
  from_array<2>(state, "wall_point", wall_point);
  for (std::size_t w = 0; w < wall_point.size(); ++w) dynamics_.walls[w].point = wall_point[w];
  std::vector<Vec<1>> sums(17);
  from_array<1>(state, "sums", sums, 15);  // before work of friction, or of damping, was counted
  for (std::size_t w = 0; w < 4; ++w) sums_.impulse[w] = sums[w][0];
  sums_.duration = sums[4][0];
  sums_.iterations = sums[5][0];
  sums_.rejected = sums[6][0];
  drive_.state.stress = sums[7][0];
  drive_.state.ended = static_cast<WallDrive::End>(sums[8][0]);
  drive_.restore(state);
  dynamics_.impulse_time = sums[9][0];
  if constexpr (std::is_same_v<Dynamics, ImplicitDynamics>)
    if (state.arrays.contains("sub_step")) {  // 0.1.0 did not keep it
      std::vector<Vec<1>> sub_step(1);
      from_array<1>(state, "sub_step", sub_step);
      dynamics_.sub_step = sub_step[0][0];
    }
  dynamics_.work = {.walls = sums[10][0],
                    .gravity = sums[11][0],
                    .internal = sums[12][0],
                    .contacts = sums[13][0],
                    .friction = sums[15][0],
                    .inertia = sums[14][0],
                    .damping = sums[16][0]};
  if constexpr (std::is_same_v<Dynamics, ExplicitDynamics>) dynamics_.stable = restored_stable_step(state);
  step_ = state.step;
}

template Checkpoint MpmSimulation<ImplicitDynamics>::checkpoint() const;
template Checkpoint MpmSimulation<ExplicitDynamics>::checkpoint() const;
template void MpmSimulation<ImplicitDynamics>::restore(const Checkpoint& state);
template void MpmSimulation<ExplicitDynamics>::restore(const Checkpoint& state);

}  // namespace softgrain
