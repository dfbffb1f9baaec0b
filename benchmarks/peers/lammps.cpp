// LAMMPS (granular package) and softgrain on the same packing under the same attraction between its disks:
// what a unit of simulated time costs, against the overlap that is left. LAMMPS pushes overlapping disks
// apart with springs, so that its step is a share of a contact's duration, which the overlap decides.
#define LAMMPS_SMALLBIG  // as Debian builds it: int identifiers
#include <fmt/core.h>
#include <lammps/library.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>

#include "harness.hpp"
#include "packing.hpp"
#include "softgrain/bpm/attraction_forces.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/rigid/step.hpp"

using namespace softgrain;
using namespace softgrain::bench;

namespace {

// Units, attraction and iterations are those of the comparison with Box2D.
constexpr double dt = 1.0 / 60, F0 = 1e-3 / (dt * dt), mu = 0.5, skin = 0.15;
constexpr int iterations = 20;
constexpr double settling_time = 100 * dt, time_timed = 4 * dt;
/// LAMMPS: share of critical damping (restitution 0.16), and steps in the shortest contact.
constexpr double damping = 0.5, steps_per_contact = 20;

/// What acts on the disks: the attraction, and a body force along x, shear m sin(2 pi y/height).
struct Load {
  const char* name;
  double shear;
  double contact_force;  ///< mean that this load makes
};
/// Within its own cohesion; and pushed so that forces must cross half the packing.
constexpr Load still{"still", 0, 6}, sheared{"sheared", 2, 45};

/// The forces of the load, by the same code for both, once in dt.
class LoadForces {
 public:
  explicit LoadForces(const Load& load) : shear_(load.shear) {}

  void add(const RigidParticles<2>& particles, const NeighbourReference<2>& reference,
           std::span<Vec<2>> force) {
    attraction_.update(particles, reference);
    attraction_.add_forces(particles, force);
    const double wave_number = 2 * std::numbers::pi / particles.walls[2].point[1];
    for (int i = 0; shear_ != 0 && i < particles.size(); ++i)
      force[i][0] += shear_ * particles.mass[i] * std::sin(wave_number * particles.position[i][1]);
  }

 private:
  double shear_;
  AttractionForces attraction_{{.F0 = F0, .gamma = 7}};
};

/// How a packing has come through: overlaps of the pairs that touch, and how far its disks are from where
/// they began, in mean diameters.
struct Outcome {
  double mean = 0, worst = 0, displacement = 0;
};

Outcome outcome(const RigidParticles<2>& start, const RigidParticles<2>& particles) {
  NeighbourReference<2> reference;
  reference.skin = skin;
  set_reference(reference, particles);
  RigidContacts<2> pairs = candidate_contacts(particles, reference, [](int, int) { return 0.0; }, {});
  detect_contacts(particles, pairs);
  Outcome result;
  int touching = 0;
  for (int c = 0; c < pairs.size(); ++c)
    if (pairs.body_b[c] < particles.size() && pairs.gap[c] < 0) {
      result.mean -= pairs.gap[c];
      result.worst = std::max(result.worst, -pairs.gap[c]);
      ++touching;
    }
  result.mean /= std::max(touching, 1);
  double squares = 0;
  for (int i = 0; i < particles.size(); ++i) {
    const Vec<2> moved = particles.position[i] - start.position[i];
    squares += dot(moved, moved);
  }
  result.displacement = std::sqrt(squares / particles.size());
  return result;
}

class Ours {
 public:
  Ours(const RigidParticles<2>& packing, const Load& load, double time_step)
      : dynamics_(
            packing, [](int, int) { return mu; },
            {.solver = {.min_sweeps = iterations, .max_sweeps = iterations}, .law = {}}, skin),
        load_(load),
        time_step_(time_step) {}

  void simulate(double time) {
    for (int k = 0; k < std::lround(time / time_step_); ++k)
      dynamics_.step([&](const RigidParticles<2>& particles,
                         std::span<Vec<2>> force) { load_.add(particles, dynamics_.reference, force); },
                     time_step_);
  }
  const RigidParticles<2>& particles() const { return dynamics_.particles; }

 private:
  RigidDynamics<2> dynamics_;
  LoadForces load_;
  double time_step_;
};

/// Disks with linear springs of stiffness k_n, dashpots and friction with memory.
class Lammps {
 public:
  Lammps(const RigidParticles<2>& packing, const Load& load, double k_n)
      : particles_(packing), load_(load), force_(packing.size()) {
    reference_.skin = skin;
    std::array<std::string, 7> words{"lammps", "-screen", "none", "-log", "none", "-nocite", ""};
    std::array<char*, 7> arguments{};
    for (std::size_t k = 0; k + 1 < words.size(); ++k) arguments[k] = words[k].data();
    handle_ = lammps_open_no_mpi(6, arguments.data(), nullptr);
    // a pair of the smallest: m_eff = m/2, contact time pi sqrt(m_eff/k_n)
    const double smallest = *std::ranges::min_element(packing.mass);
    step_ = std::numbers::pi * std::sqrt(smallest / 2 / k_n) / steps_per_contact;
    step_ = dt / std::ceil(dt / step_);
    const double gamma_n = 2 * damping * std::sqrt(2 * k_n);  // of mean masses, m_eff = 1/2
    const Vec<2> corner = packing.walls[2].point;
    const std::string law = fmt::format("hooke/history {} NULL {} NULL {} 1", k_n, gamma_n, mu);
    command(
        fmt::format("units lj\ndimension 2\nboundary f f p\natom_style sphere\nnewton off\n"
                    "comm_modify vel yes\nneighbor {} bin\nregion box block -2 {} -2 {} -0.5 0.5\n"
                    "create_box 1 box",
                    skin, corner[0] + 2, corner[1] + 2));
    create_disks();
    command(
        fmt::format("pair_style gran/{0}\npair_coeff * *\ntimestep {1}\nfix move all nve/sphere disc\n"
                    "fix x all wall/gran {0} xplane 0 {2}\nfix y all wall/gran {0} yplane 0 {3}\n"
                    "fix load all external pf/callback {4} 1\nfix plane all enforce2d\nthermo 1000000",
                    law, step_, corner[0], corner[1], std::lround(dt / step_)));
    lammps_set_fix_external_callback(handle_, "load", &Lammps::add_load, this);
    command("run 0 post no");
  }
  Lammps(const Lammps&) = delete;
  Lammps& operator=(const Lammps&) = delete;
  ~Lammps() { lammps_close(handle_); }

  void simulate(double time) { command(fmt::format("run {} pre no post no", std::lround(time / step_))); }

  double steps_per_dt() const { return dt / step_; }
  const RigidParticles<2>& particles() {
    read_positions(lammps_extract_setting(handle_, "nlocal"), array<int*>("id"), array<double**>("x"));
    return particles_;
  }

 private:
  void command(const std::string& text) {
    lammps_commands_string(handle_, text.c_str());
    std::array<char, 512> message{};
    if (lammps_has_error(handle_) != 0) {
      lammps_get_last_error_message(handle_, message.data(), message.size());
      throw NumericalError(message.data());
    }
  }

  template <class T>
  T array(const char* name) {
    return static_cast<T>(lammps_extract_atom(handle_, name));
  }

  void create_disks() {
    const int n = particles_.size();
    const std::vector<int> type(n, 1);
    std::vector<double> x;
    for (const Vec<2>& position : particles_.position) x.insert(x.end(), {position[0], position[1], 0});
    lammps_create_atoms(handle_, n, nullptr, type.data(), x.data(), nullptr, nullptr, 0);
    for (int i = 0; i < n; ++i) {
      const int disk = array<int*>("id")[i] - 1;
      array<double*>("radius")[i] = particles_.radius[disk];
      array<double*>("rmass")[i] = particles_.mass[disk];
    }
  }

  void read_positions(int count, const int* id, double** x) {
    for (int i = 0; i < count; ++i) particles_.position[id[i] - 1] = {x[i][0], x[i][1]};
  }

  static void add_load(void* self, std::int64_t, int count, int* id, double** x, double** force) {
    auto& lammps = *static_cast<Lammps*>(self);
    lammps.read_positions(count, id, x);
    renew_stale_lists(lammps.reference_, lammps.particles_);
    lammps.force_.assign(lammps.force_.size(), {});
    lammps.load_.add(lammps.particles_, lammps.reference_, lammps.force_);
    for (int i = 0; i < count; ++i) std::ranges::copy(lammps.force_[id[i] - 1].c, force[i]);
  }

  RigidParticles<2> particles_;
  NeighbourReference<2> reference_;
  LoadForces load_;
  std::vector<Vec<2>> force_;
  void* handle_ = nullptr;
  double step_ = 0;
};

/// Mean or worst overlap [diameters], and what it costs [s of CPU time per disk and unit of time].
struct Point {
  double overlap, cost;
};

/// On the line through the points nearest in overlap, in logarithms: for springs, cost ~ overlap^-1/2.
double cost_at(double overlap, std::span<const Point> points) {
  std::size_t k = 1;
  while (k + 1 < points.size() && points[k].overlap > overlap) ++k;
  const Point &a = points[k - 1], &b = points[k];
  const double slope = std::log(b.cost / a.cost) / std::log(b.overlap / a.overlap);
  return a.cost * std::pow(overlap / a.overlap, slope);
}

void compare(const PackingSize& size, const Load& load, Results& results) {
  const RigidParticles<2> packing = dense_packing(size);
  Ours fine(packing, load, dt), coarse(packing, load, 4 * dt);
  fine.simulate(settling_time), coarse.simulate(settling_time);
  std::vector<std::unique_ptr<Lammps>> springs;
  std::vector<Outcome> outcomes;
  for (const double overlap : {1e-2, 1e-3, 1e-4, 2e-5}) {
    springs.push_back(std::make_unique<Lammps>(packing, load, load.contact_force / overlap));
    springs.back()->simulate(settling_time);
    outcomes.push_back(outcome(packing, springs.back()->particles()));
  }
  for (const Ours* code : {&fine, &coarse}) outcomes.push_back(outcome(packing, code->particles()));
  const auto run = [](auto& code) { return [&] { code.simulate(time_timed); }; };
  std::vector<double> cost = fastest(
      {run(*springs[0]), run(*springs[1]), run(*springs[2]), run(*springs[3]), run(fine), run(coarse)});
  for (double& seconds : cost) seconds /= size.disks() * time_timed;

  results.heading(fmt::format("{} disks, {}, mu = {}; cost: CPU time per disk and unit of time", size.disks(),
                              load.name, mu));
  std::vector<Point> mean, worst;
  for (std::size_t k = 0; k < cost.size(); ++k) {
    const bool springy = k < springs.size();
    const std::string code = springy  ? fmt::format("LAMMPS, {:.0f} steps", springs[k]->steps_per_dt())
                             : k == 4 ? "softgrain, 1 step"
                                      : "softgrain, 1/4 step";
    const std::string name = fmt::format("{} {}: {}: ", size.disks(), load.name, code);
    results.add({.what = name + "mean overlap", .value = outcomes[k].mean, .unit = "diameters"});
    results.add({.what = name + "worst overlap", .value = outcomes[k].worst, .unit = "diameters"});
    results.add({.what = name + "rms displacement", .value = outcomes[k].displacement, .unit = "diameters"});
    results.add({.what = name + "cost", .value = 1e6 * cost[k], .unit = "us"});
    if (springy) {
      mean.push_back({outcomes[k].mean, cost[k]});
      worst.push_back({outcomes[k].worst, cost[k]});
      continue;
    }
    const auto ratio = [&](const char* what, double theirs) {
      results.add({.what = name + "LAMMPS, same " + what + " overlap",
                   .value = 1e6 * theirs,
                   .unit = "us",
                   .ratio = cost[k] / theirs,
                   .reference = "ours over theirs"});
    };
    ratio("mean", cost_at(outcomes[k].mean, mean));
    ratio("worst", cost_at(outcomes[k].worst, worst));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Results results("lammps", argc, argv);
  compare(middle_packing, still, results);
  compare(middle_packing, sheared, results);
  compare(large_packing, still, results);
}
