#include "softgrain/io/page/reference_pages.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/kinds.hpp"
#include "softgrain/experiment/sample.hpp"
#include "softgrain/observe/columns.hpp"
#include "softgrain/state/archive.hpp"

namespace softgrain {
namespace {

struct Group {
  ColumnGroup group;
  std::string_view heading;
};
constexpr std::array groups{
    Group{ColumnGroup::every_run, "Every run"}, Group{ColumnGroup::boxes, "Boxes of many grains"},
    Group{ColumnGroup::bonded, "Bonded grains"}, Group{ColumnGroup::elastic, "Elastic grains"}};

std::string dash(std::string_view unit) { return unit.empty() ? "-" : std::string(unit); }

/// Columns that share one sentence share one row.
std::string table_of(ColumnGroup group) {
  std::string text = "| column | unit | definition |\n|---|---|---|\n";
  const auto columns = all_columns();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].group != group || columns[k].text.empty()) continue;
    std::string names = fmt::format("`{}`", columns[k].name);
    for (std::size_t next = k + 1; next < columns.size() && columns[next].text.empty(); ++next)
      names += fmt::format(", `{}`", columns[next].name);
    text += fmt::format("| {} | {} | {} |\n", names, dash(columns[k].unit), columns[k].text);
  }
  return text;
}

constexpr std::string_view observables_begin = R"(# Observables

<!-- Written by `softgrain schema --columns`; do not edit. -->

Every column of `series.csv` with its definition. What boxes of grains show is computed by one code for all models
(`src/softgrain/observe/`). Numbers in brackets are equations of [theory](theory.md). All numbers are SI, per metre of
depth; stress and strain are positive in compression. Means "since the row before" run over all steps in between, so
that no step is lost. Everything else is as it stands at the time of the row.
)";

constexpr std::string_view observables_end = R"(
A few hundred grains have many neighbours that are walls. Compare `z_with_walls`, not `z`, with the 4 of isostatic
frictionless disks: in boxes of 60 grains it crosses 4 at $\Phi_0$ of 0.81 to 0.83, where `z` reads 3.2 to 3.65.

The explicit step takes 0.01 to 4 % of the wall work (`dissipation_integration`) in slow loading, up to 8 % in impacts.

## In snapshots and pictures

`pressure` of a primary or material point is half the trace of its stress: of a primary by the forces on it and its
share of the area of its grain (28), of a point by the law of its material. Of laws that flow it is a third of the
whole trace, with the stress across the plane, and `von_mises_stress` and `plastic_strain` stand beside it.
`coordination` of a primary counts its contacts that carry force. `force` of a contact is its normal impulse over the
step; elastic grains that touch in many points have one contact with the sum. What each file calls them:
[files of a run](format.md).
)";

constexpr std::string_view checkpoint_begin = R"(# Arrays of a checkpoint

<!-- Written by `softgrain schema --arrays`; do not edit. -->

What lies in the group `/checkpoint` of a snapshot: all that the next step and the next row depend on. Each array is
declared once, by the struct that owns it, and written, read and listed from that declaration
(`src/softgrain/state/field.hpp`). Its part says why it is there. *state*: the equations of motion go on from it.
*start*: an iteration starts from it; without it the next step has other bits. *list*: it decides when lists of
neighbours are made again, and their order. *sum*: it is added up between two rows, or over the run.
)";

std::string_view word(Owner owner) {
  constexpr std::array words{"run", "wall", "grain", "body", "node", "point", "contact"};
  return words[static_cast<std::size_t>(owner)];
}

std::string_view word(Role role) {
  constexpr std::array words{"state", "start", "list", "sum"};
  return words[static_cast<std::size_t>(role)];
}

std::vector<FieldShape> fields_of(GrainModel model, Integrator integrator, Formulation formulation,
                                  MaterialLaw law = MaterialLaw::neo_hookean, int dimension = 2) {
  Case c;
  c.experiment.dimension = dimension;
  c.output.report = false;
  c.mpm.law = law;
  c.mpm.material.yield_stress = 1e5;  // of what flows
  c.experiment.model = model;
  c.bpm.primaries = 20;
  c.mpm.cells = 2;
  c.mpm.integrator = integrator;
  c.mpm.formulation = formulation;
  c.mpm.lattice_integrator = integrator;
  StateLister lister;
  create_any_simulation(c)->visit(lister);
  return lister.fields;
}

/// Of bonded grains among elastic ones, what is not an array of either: those of the bonded grains have a
/// prefix.
std::vector<FieldShape> fields_between_models() {
  Case c;
  c.output.report = false;
  c.experiment = {.loading = LoadingPath::compaction, .model = GrainModel::mpm};
  c.mpm.integrator = Integrator::symplectic_euler;
  c.sample.packing_fraction = 0.3;
  Case::Kind elastic = kind_of(c), bonded = elastic;
  elastic.grains = bonded.grains = 1;
  elastic.cells = 2;
  bonded.model = GrainModel::bpm;
  bonded.bpm.primaries = 20;
  bonded.bpm.library = 1;
  c.kinds = {elastic, bonded};
  StateLister lister;
  create_any_simulation(complete_sample(c))->visit(lister);
  std::erase_if(lister.fields,
                [](const FieldShape& shape) { return !shape.field.name.starts_with("primary_contact"); });
  return lister.fields;
}

std::string table_of(const std::vector<FieldShape>& fields) {
  std::string text = "| array | rows | columns | unit | part | what |\n|---|---|---|---|---|---|\n";
  for (const auto& [field, columns, integers] : fields)
    text += fmt::format("| `{}` | {} | {}{} | {} | {} | {} |\n", field.name,
                        field.owner == Owner::run ? "1" : fmt::format("by {}", word(field.owner)), columns,
                        integers ? ", integers" : "", dash(field.unit), word(field.role), field.text);
  return text;
}

}  // namespace

std::string observables_page() {
  std::string text(observables_begin);
  for (const auto& [group, heading] : groups) text += fmt::format("\n## {}\n\n{}", heading, table_of(group));
  return text + std::string(observables_end);
}

std::string checkpoint_page() {
  using enum Integrator;
  using enum Formulation;
  const std::pair<std::string_view, std::vector<FieldShape>> models[] = {
      {"Bonded grains", fields_of(GrainModel::bpm, backward_euler, total_lagrangian)},
      {"Elastic grains, implicit", fields_of(GrainModel::mpm, backward_euler, total_lagrangian)},
      {"Grains that flow, implicit",
       fields_of(GrainModel::mpm, backward_euler, total_lagrangian, MaterialLaw::von_mises)},
      {"Rigid grains, also among elastic ones, implicit",
       fields_of(GrainModel::rigid, backward_euler, total_lagrangian)},
      {"Elastic grains, explicit", fields_of(GrainModel::mpm, symplectic_euler, total_lagrangian)},
      {"Elastic grains, updated Lagrangian",
       fields_of(GrainModel::mpm, symplectic_euler, updated_lagrangian)},
      {"Elastic grains, updated Lagrangian, implicit",
       fields_of(GrainModel::mpm, backward_euler, updated_lagrangian)},
      {"Elastic grains in space",
       fields_of(GrainModel::mpm, symplectic_euler, total_lagrangian, MaterialLaw::neo_hookean, 3)}};
  std::string text(checkpoint_begin);
  for (const auto& [heading, fields] : models)
    text += fmt::format("\n## {}\n\n{}", heading, table_of(fields));
  return text +
         fmt::format(
             "\n## Bonded grains among elastic ones\n\nThe arrays of elastic grains, explicit; those of "
             "bonded grains, each with\n`bonded_` before its name; and\n\n{}",
             table_of(fields_between_models()));
}

}  // namespace softgrain
