#include "softgrain/observe/columns.hpp"

#include <array>
#include <cstddef>

namespace softgrain {
namespace {

using Value = std::optional<double>;
using enum ColumnGroup;

constexpr std::string_view as_before;

/// Of a wall, by its number.
template <int Number>
Value force_on(const Observation& o) {
  return o.wall_force[Number];
}

/// Over a stress of the load; 0 where it presses on nothing.
double ratio_to(double load, double stress) { return load > 0 ? stress / load : 0; }

Value mean_side_force(const Observation& o) {
  double sum = 0;
  for (std::size_t w = 2; w < o.wall_force.size(); ++w) sum += o.wall_force[w];
  return sum / static_cast<double>(o.wall_force.size() - 2);
}

/// What bottom and top, and each side wall, press on.
double face_of(const Observation& o) { return o.dimension == 2 ? o.width : o.face; }
double side_face_of(const Observation& o) { return o.dimension == 2 ? o.height : o.side_face; }

/// Of a packing in space.
template <int I, int J>
Value stress_in_space(const Observation& o) {
  if (!o.packing || o.dimension == 2) return std::nullopt;
  return (o.packing->stress(I, J) + o.packing->stress(J, I)) / 2;
}

/// What only boxes have.
template <class Function>
constexpr auto in_box(Function) {
  return [](const Observation& o) { return o.packing ? Value(Function{}(*o.packing)) : std::nullopt; };
}

/// What the steps took.
template <class Function>
constexpr auto in_steps(Function) {
  return [](const Observation& o) { return o.means ? Value(Function{}(*o.means)) : std::nullopt; };
}

// clang-format off
#define ENERGY(member) [](const Observation& o) -> Value { return o.energies.member; }
#define PACKING(expression) in_box([](const PackingMeasures& p) { return expression; })
#define MEANS(member) in_steps([](const StepMeans& m) { return m.member; })
#define NUMBER(name) [](const Observation& o) { return o.number(name); }

constexpr std::array table{
    Column{"step", "", every_run, "steps done", [](const Observation& o) -> Value { return static_cast<double>(o.step); }},
    Column{"time", "s", every_run, "their number times the time step", [](const Observation& o) -> Value { return o.time; }},
    Column{"strain", "", every_run,
        R"(one grain: $-\ln(1-\lvert d\rvert/R)$ with $\lvert d\rvert$ half the approach of the walls (26); a box: $\ln(h_\mathrm{start}/h)$ (54))",
        [](const Observation& o) -> Value { return o.strain; }},
    Column{"leg", "", every_run, "stage of the loading: 0 the first, then one more after every turn",
        [](const Observation& o) -> Value { return o.leg; }},
    Column{"wall_height", "m", every_run, "distance $h$ of the bottom and the top wall", [](const Observation& o) -> Value { return o.height; }},
    Column{"width", "m", every_run, "one grain: its extent across the load; a box: distance of its side walls",
        [](const Observation& o) -> Value { return o.width; }},
    Column{"stress_bottom", "Pa", every_run, "`force_bottom` over `width` (27); in space over the area of the box, or of a grain's section, pi/4 `width`^2", [](const Observation& o) -> Value { return o.wall_force[0] / face_of(o); }},
    Column{"stress_top", "Pa", every_run, "the same of the top wall", [](const Observation& o) -> Value { return o.wall_force[1] / face_of(o); }},
    Column{"stress_side", "Pa", boxes, "mean of the two side walls",
        [](const Observation& o) { return o.packing ? Value(*mean_side_force(o) / side_face_of(o)) : std::nullopt; }},
    Column{"transmission_ratio", "", boxes, "`stress_bottom` over `stress_top`: what friction at the side walls leaves of the load of the top wall. 0 while that bears nothing",
        [](const Observation& o) { return o.packing ? Value(ratio_to(o.wall_force[1], o.wall_force[0])) : std::nullopt; }},
    Column{"radial_ratio", "", boxes, "`stress_side` over the mean of `stress_bottom` and `stress_top`: radial over axial stress of a die. 0 while nothing presses",
        [](const Observation& o) { return o.packing ? Value(ratio_to((o.wall_force[0] + o.wall_force[1]) / 2 * side_face_of(o), *mean_side_force(o) * face_of(o))) : std::nullopt; }},
    Column{"force_bottom", "N/m", every_run, "outward force on the bottom wall: impulses of the steps since the row before over their time", force_on<0>},
    Column{"force_top", "N/m", every_run, "the same of the top wall", force_on<1>},
    Column{"sigma_I", "Pa", bonded, R"($F_0/\langle a_0\rangle$, the internal cohesive pressure by which stresses are scaled (16))", NUMBER("sigma_I")},
    Column{"solid_fraction", "", bonded, "area of the primaries over that of the box (boxes only)", NUMBER("solid_fraction")},
    Column{"phi_0", "", boxes, R"($\Phi_0 = \sum_g\pi R_g^2/A$: area of the undeformed grains over that of the box (54))", PACKING(p.phi.undeformed)},
    Column{"phi", "", boxes,
        R"($\Phi = \sum_g A_g/A$: area of the deformed grains over that of the box (54): elastic, $\pi R_g^2$ times the mean $J$; bonded, inside the outline)",
        PACKING(p.phi.deformed)},
    Column{"area_ratio", "", every_run, R"(box: $\Phi/\Phi_0$; one elastic grain: its area over that at the start)",
        [](const Observation& o) { return o.packing ? Value(o.packing->phi.deformed / o.packing->phi.undeformed) : o.number("area_ratio"); }},
    Column{"z", "", boxes,
        R"($Z = 2 N_\text{pairs}/N_\text{grains}$; a pair of grains that carries force counts once, walls not (54))", PACKING(p.coordination.z)},
    Column{"z_no_rattlers", "", boxes,
        "`z` without rattlers: grains that have fewer than two contacts, walls among them, taken out one after the other", PACKING(p.coordination.z_no_rattlers)},
    Column{"rattlers", "", boxes, "share of the grains that are rattlers", PACKING(p.coordination.rattlers)},
    Column{"z_with_walls", "", boxes,
        R"($2\,(N_\text{pairs}+N_\text{wall pairs})/N_\text{grains}$: walls count as neighbours)",
        PACKING(p.coordination.z_with_walls)},
    Column{"z_backbone", "", boxes,
        R"($Z$ among the grains that are left when those with fewer than *three* contacts, walls among them, are taken out one after the other. Without friction two contacts hold a disk only where they lie opposite each other)",
        PACKING(p.coordination.z_backbone)},
    Column{"backbone", "", boxes, "share of the grains in the backbone; it jumps from 0 to 0.8 or more where a frictionless packing jams",
        PACKING(p.coordination.backbone)},
    Column{"sides", "", boxes, "mean number of sides along which a grain touches others", NUMBER("sides")},
    Column{"stress_xx", "Pa", boxes, "Love-Weber's tensor from contact forces and branch vectors, with the motion's part (62)", PACKING(p.stress(0, 0))},
    Column{"stress_yy", "Pa", boxes, as_before, PACKING(p.stress(1, 1))},
    Column{"stress_xy", "Pa", boxes, as_before, PACKING((p.stress(0, 1) + p.stress(1, 0)) / 2)},
    Column{"stress_zz", "Pa", boxes, "the same tensor in space; there z is vertical", stress_in_space<2, 2>},
    Column{"stress_xz", "Pa", boxes, as_before, stress_in_space<0, 2>},
    Column{"stress_yz", "Pa", boxes, as_before, stress_in_space<1, 2>},
    Column{"shear_strain", "", boxes, R"($\gamma = \int L_{xy}\,\mathrm dt$ of a periodic cell (66); periodic cells only)", [](const Observation& o) { return o.shear; }},
    Column{"stress_ratio", "", boxes, R"(shear stress over vertical stress, $-\sigma_{xy}/\sigma_{yy}$; periodic cells only)",
        [](const Observation& o) { return o.shear && o.packing->stress(1, 1) != 0 ? Value(-o.packing->stress(0, 1) / o.packing->stress(1, 1)) : o.shear ? Value(0.0) : std::nullopt; }},
    Column{"stress_kinetic", "Pa", boxes, "half the trace of the motion's part", NUMBER("stress_kinetic")},
    Column{"inertial_number", "", boxes,
        R"($I = \lvert\dot\varepsilon\rvert\,d\,\sqrt{\rho/p}$ of the fastest strain, along an axis or in shear; below $10^{-3}$ loading is quasi-static (63). 0 while nothing touches, as in the first row)",
        NUMBER("inertial_number")},
    Column{"anisotropy", "", boxes, "$a$ of the normals between grains (64)", NUMBER("anisotropy")},
    Column{"force_mean", "N/m", boxes, "mean normal force of the pairs", NUMBER("force_mean")},
    Column{"circularity", "", boxes, R"(mean over the grains of $4\pi A_g/P_g^2$ (65))", NUMBER("circularity")},
    Column{"aspect_ratio", "", boxes, R"(mean over the grains of $\sqrt{M_1/M_2}$ (65))", NUMBER("aspect_ratio")},
    Column{"sphericity", "", boxes, R"(mean over the grains of $(36\pi V_g^2)^{1/3}/A_g$, 1 for a sphere; in space)", NUMBER("sphericity")},
    Column{"least_J", "", elastic,
        R"(least $\det\mathbf F$ of all material points: a point that reaches 0 is turned inside out, and the run ends)", NUMBER("least_J")},
    Column{"contacts", "", every_run, "contacts that carry impulse; of primaries (bpm), of outline vertices (mpm)", NUMBER("contacts")},
    Column{"z_primaries", "", bonded, "twice the contacts between primaries that carry force, over the primaries", NUMBER("z_primaries")},
    Column{"clusters", "", bonded, "pieces in which primaries hold together: as many as grains, unless one broke", NUMBER("clusters")},
    Column{"kinetic_energy", "J/m", every_run, R"($\sum\tfrac12 m v^2$, spins included (29))", ENERGY(kinetic)},
    Column{"attraction_energy", "J/m", bonded, R"($\sum U$ over pairs in reach (15))", NUMBER("attraction_energy")},
    Column{"elastic_energy", "J/m", elastic, "(43), summed over the cells", NUMBER("elastic_energy")},
    Column{"adhesion_energy", "J/m", every_run, R"($\sum l\,\Phi(g)$ of surfaces that adhere, below 0 (78); it belongs to the budget as the elastic energy does; with adhesion only)", NUMBER("adhesion_energy")},
    Column{"attraction_ratio", "", every_run, "sum of the attractions over the sum of the repulsions at all contacts: 1 where grains hold by themselves, below while they are pressed, above while they are pulled apart; with adhesion only", NUMBER("attraction_ratio")},
    Column{"wall_work", "J/m", every_run, "done on the grains by moving walls, since the start (29)", ENERGY(wall_work)},
    Column{"gravity_work", "J/m", boxes, R"(done by gravity, $\sum m\,\mathbf g\cdot\Delta\mathbf x$, since the start; with gravity only)", NUMBER("gravity_work")},
    Column{"dissipation", "J/m", every_run,
        "by contacts (friction, plastic impact) and, for mpm, by the integrator and by damping, since the start (30)", ENERGY(dissipation)},
    Column{"dissipation_rearrangement", "J/m", bonded,
        "`dissipation` less `dissipation_contact`, taken by contacts of primaries inside grains as they rearrange", NUMBER("dissipation_rearrangement")},
    Column{"dissipation_contact", "J/m", every_run, "of it by contacts between grains and with walls, friction included", ENERGY(contact)},
    Column{"dissipation_friction", "J/m", every_run, R"(of that by sliding: $-\sum p_t\cdot\tfrac12(u_t + u_t^+)$)", ENERGY(friction)},
    Column{"dissipation_integration", "J/m", elastic,
        "by backward Euler, less what free grains get back with their spin; by the explicit step, which damps the mesh's own vibrations (53a); updated Lagrangian: also what is lost between points and nodes",
        NUMBER("dissipation_integration")},
    Column{"dissipation_plastic", "J/m", elastic, "by flow, creep and relaxation of the material, hardening included, since the start; laws that do so only (46), (46d)", NUMBER("dissipation_plastic")},
    Column{"plastic_strain", "", elastic, R"(mean over the area of the equivalent plastic strain $\alpha$ (45); laws that flow only)", NUMBER("plastic_strain")},
    Column{"plastic_strain_max", "", elastic, "the largest of all points", NUMBER("plastic_strain_max")},
    Column{"yielding", "", elastic, "share of the undeformed area that flowed in the last step", NUMBER("yielding")},
    Column{"dissipation_damping", "J/m", elastic, R"(by `mpm.damping`, $-\sum\mathbf f^\mathrm{damp}\cdot\Delta\mathbf x$)", NUMBER("dissipation_damping")},
    Column{"energy_error", "J/m", every_run, "work of walls and gravity less kinetic, stored and dissipated energy (31): what the budget leaves unexplained", ENERGY(error)},
    Column{"iterations", "", elastic, "of Newton's method; explicit: sub-steps; mean of a step since the row before", NUMBER("iterations")},
    Column{"rejected_steps", "", elastic, "sub-steps taken back and tried again with a quarter of their length, since the start", NUMBER("rejected_steps")},
    Column{"sweeps", "", every_run, "of the contact solver, mean of a step since the row before", MEANS(sweeps)},
    Column{"residual_mean", "", every_run, "violation of the law of contact (22): mean of the steps' means", MEANS(residual_mean)},
    Column{"residual_max", "", every_run, "worst contact of the worst step", MEANS(residual_max)},
    Column{"overlap_mean", "", every_run, "overlap of the contacts that carry impulse, over the mean radius of the primaries (bpm) or the smallest radius of the grains (mpm): mean of the steps' means", MEANS(overlap_mean)},
    Column{"overlap_max", "", every_run, "worst contact of the worst step", MEANS(overlap_max)},
    Column{"wall_seconds", "s", every_run, "wall time since the run began, all resumed parts together", MEANS(wall_seconds)},
};
// clang-format on

}  // namespace

std::span<const Column> all_columns() { return table; }

namespace {

/// What is per metre of depth in the plane is not in space.
std::string unit_in(int dimension, std::string_view unit) {
  if (dimension == 2 || !unit.ends_with("/m")) return std::string(unit);
  return std::string(unit.substr(0, unit.size() - 2));
}

}  // namespace

std::vector<Quantity> row_of(const Observation& observation) {
  std::vector<Quantity> row;
  for (const Column& column : table)
    if (const Value value = column.value(observation))
      row.push_back({std::string(column.name), unit_in(observation.dimension, column.unit), *value});
  return row;
}

}  // namespace softgrain
