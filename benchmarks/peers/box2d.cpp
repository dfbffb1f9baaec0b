// Box2D 2.4 and softgrain on the same packing under the same attraction between its disks, in the same steps
// and iterations: CPU time of one contact in one iteration, and the overlap that is left.
#include <box2d/box2d.h>
#include <fmt/core.h>

#include <algorithm>

#include "harness.hpp"
#include "packing.hpp"
#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/rigid/step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

// Units: mean diameter 1, as Box2D likes its bodies, and its usual step. F0 would move a disk by 1e-3
// diameters in a step, as in the paper's grain at 0.25 us.
constexpr double dt = 1.0 / 60, F0 = 1e-3 / (dt * dt), mu = 0.5, skin = 0.15;
constexpr int iterations = 20, steps_before = 100, steps_timed = 5, position_iterations = 3;

/// Overlaps of the pairs that touch, over the mean diameter; both codes are measured on their positions.
struct Overlap {
  double sum = 0, worst = 0;
  int contacts = 0;

  void add(double gap) {
    if (gap > 0) return;
    sum -= gap;
    worst = std::max(worst, -gap);
    ++contacts;
  }
  double mean() const { return sum / std::max(contacts, 1); }
};

Overlap overlap_of(const RigidParticles<2>& particles, RigidContacts<2> contacts) {
  detect_contacts(particles, contacts);
  Overlap overlap;
  for (int c = 0; c < contacts.size(); ++c)
    if (contacts.body_b[c] < particles.size()) overlap.add(contacts.gap[c]);
  return overlap;
}

class Ours {
 public:
  explicit Ours(const RigidParticles<2>& packing)
      : dynamics_(
            packing, [](int, int) { return mu; }, {}, skin) {}

  void step(int sweeps) {
    dynamics_.options.solver = {.min_sweeps = sweeps, .max_sweeps = sweeps};
    dynamics_.step(
        [&](const RigidParticles<2>& particles, std::span<Vec<2>> force) {
          attraction_.update(particles, dynamics_.reference);
          attraction_.add_forces(particles, force);
        },
        dt);
  }
  const RigidDynamics<2>& dynamics() const { return dynamics_; }

 private:
  RigidDynamics<2> dynamics_;
  AttractionForces attraction_{{.F0 = F0, .gamma = 7}};
};

b2Vec2 to_b2(const Vec<2>& x) { return {static_cast<float>(x[0]), static_cast<float>(x[1])}; }

/// The same disks as bodies of Box2D; the attraction is ours, at their positions.
class Theirs {
 public:
  explicit Theirs(const RigidParticles<2>& packing) : particles_(packing) {
    reference_.skin = skin;
    world_.SetAllowSleeping(false);
    world_.SetContinuousPhysics(false);
    for (int i = 0; i < packing.size(); ++i) add_disk(i);
    b2BodyDef fixed;
    ground_ = world_.CreateBody(&fixed);
    for (const Wall<2>& wall : packing.walls) add_wall(wall);
  }

  void step(int velocity_iterations) {
    renew_stale_lists(reference_, particles_);
    attraction_.update(particles_, reference_);
    force_.assign(bodies_.size(), {});
    attraction_.add_forces(particles_, force_);
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i]->ApplyForceToCenter(to_b2(force_[i]), true);
    world_.Step(static_cast<float>(dt), velocity_iterations, position_iterations);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      particles_.position[i] = {bodies_[i]->GetPosition().x, bodies_[i]->GetPosition().y};
  }

  int touching() const {
    int count = 0;
    for (const b2Contact* contact = world_.GetContactList(); contact != nullptr; contact = contact->GetNext())
      count += contact->IsTouching() ? 1 : 0;
    return count;
  }
  const RigidParticles<2>& particles() const { return particles_; }

 private:
  void add_disk(int i) {
    b2BodyDef body;
    body.type = b2_dynamicBody;
    body.position = to_b2(particles_.position[i]);
    b2CircleShape circle;
    circle.m_radius = static_cast<float>(particles_.radius[i]);
    b2FixtureDef fixture;
    fixture.shape = &circle;
    fixture.density = 4 / b2_pi;  // mass = diameter^2
    fixture.friction = static_cast<float>(mu);
    bodies_.push_back(world_.CreateBody(&body));
    bodies_.back()->CreateFixture(&fixture);
  }

  void add_wall(const Wall<2>& wall) {
    const Vec<2> along = 1e3 * perpendicular(wall.normal);
    // an edge has a skin of its own: draw it back, so that disks touch at the wall
    const Vec<2> surface = wall.point - static_cast<double>(b2_polygonRadius) * wall.normal;
    b2EdgeShape edge;
    edge.SetTwoSided(to_b2(surface - along), to_b2(surface + along));
    b2FixtureDef fixture;
    fixture.shape = &edge;
    fixture.friction = static_cast<float>(mu);
    ground_->CreateFixture(&fixture);
  }

  RigidParticles<2> particles_;
  b2World world_{{0, 0}};
  b2Body* ground_ = nullptr;
  std::vector<b2Body*> bodies_;
  NeighbourReference<2> reference_;
  AttractionForces attraction_{{.F0 = F0, .gamma = 7}};
  std::vector<Vec<2>> force_;
};

void compare(const PackingSize& size, Results& results) {
  const RigidParticles<2> packing = dense_packing(size);
  Ours ours(packing);
  Theirs theirs(packing);
  for (int k = 0; k < steps_before; ++k) ours.step(iterations), theirs.step(iterations);
  const RigidContacts<2>& candidates = ours.dynamics().contacts;
  const Overlap our_overlap = overlap_of(ours.dynamics().particles, candidates);
  const Overlap their_overlap = overlap_of(theirs.particles(), candidates);
  const auto active = std::ranges::count_if(candidates.impulse, [](const Vec<2>& p) { return p[0] > 0; });
  const int touching = theirs.touching();

  const auto steps = [](auto& code, int count) {
    return [&code, count] {
      for (int k = 0; k < steps_timed; ++k) code.step(count);
    };
  };
  const auto seconds = fastest({steps(ours, iterations), steps(ours, 2 * iterations),
                                steps(theirs, iterations), steps(theirs, 2 * iterations)});
  const double rounds = 1.0 * steps_timed * iterations;
  const double our_ns = 1e9 * (seconds[1] - seconds[0]) / rounds;
  const double their_ns = 1e9 * (seconds[3] - seconds[2]) / rounds;

  results.heading(fmt::format(
      "{} disks, mu = {}, {} iterations a step; Box2D iterates over {} touching contacts, softgrain over {} "
      "candidates, of which {} carry impulse",
      size.disks(), mu, iterations, touching, candidates.size(), active));
  const auto add = [&](const char* what, double our_value, double their_value, const char* unit) {
    const std::string name = fmt::format("{} disks: {}", size.disks(), what);
    results.add({.what = name + ", Box2D", .value = their_value, .unit = unit});
    results.add({.what = name + ", softgrain",
                 .value = our_value,
                 .unit = unit,
                 .ratio = our_value / their_value,
                 .reference = "Box2D"});
  };
  add("one iteration", 1e-3 * our_ns, 1e-3 * their_ns, "us");
  add("one iteration per contact in the loop", our_ns / candidates.size(), their_ns / touching, "ns");
  add("one iteration per contact at work", our_ns / static_cast<double>(active), their_ns / touching, "ns");
  add("whole step", 1e3 * seconds[0] / steps_timed, 1e3 * seconds[2] / steps_timed, "ms");
  add("mean overlap of touching disks", our_overlap.mean(), their_overlap.mean(), "diameters");
  add("worst overlap", our_overlap.worst, their_overlap.worst, "diameters");
}

}  // namespace

int main(int argc, char** argv) {
  Results results("box2d", argc, argv);
  compare(middle_packing, results);
  compare(large_packing, results);
}
