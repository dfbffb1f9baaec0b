#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "choices.hpp"
#include "python_program.hpp"
#include "softgrain/core/error.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/io/format/file.hpp"
#include "softgrain/material/element_test.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace softgrain {

namespace {

struct LawArguments {
  CaseArguments the_case;
  ElementTest test;
  std::string path = "uniaxial", table, figure;
};

constexpr std::array<std::pair<std::string_view, ElementPath>, 4> paths{{{"shear", ElementPath::shear},
                                                                         {"uniaxial", ElementPath::uniaxial},
                                                                         {"confined", ElementPath::confined},
                                                                         {"cycle", ElementPath::cycle}}};

std::vector<std::string> path_words() {
  std::vector<std::string> words;
  for (const auto& [word, path] : paths) words.emplace_back(word);
  return words;
}

/// One line for each row, in SI, with all digits.
std::string table_of(const std::vector<ElementRow>& rows) {
  using Column = std::pair<std::string_view, double ElementRow::*>;
  constexpr std::array columns{Column{"time", &ElementRow::time},
                               Column{"strain", &ElementRow::strain},
                               Column{"stretch_y", &ElementRow::stretch},
                               Column{"stress_xx", &ElementRow::stress_xx},
                               Column{"stress_yy", &ElementRow::stress_yy},
                               Column{"stress_zz", &ElementRow::stress_zz},
                               Column{"stress_xy", &ElementRow::stress_xy},
                               Column{"pressure", &ElementRow::pressure},
                               Column{"von_mises_stress", &ElementRow::von_mises},
                               Column{"plastic_strain", &ElementRow::plastic_strain},
                               Column{"work", &ElementRow::work},
                               Column{"stored", &ElementRow::stored},
                               Column{"dissipated", &ElementRow::dissipated}};
  std::string text;
  const auto add_line = [&](const auto& cell) {
    for (const Column& column : columns)
      text += fmt::format("{}{}", &column == columns.data() ? "" : ",", cell(column));
    text += '\n';
  };
  add_line([](const Column& column) { return column.first; });
  for (const ElementRow& row : rows) add_line([&](const Column& column) { return row.*column.second; });
  return text;
}

void drive(LawArguments& arguments) {
  require(arguments.figure.empty() || !arguments.table.empty(),
          "--plot draws what -o writes: give -o FILE.csv too");
  const Case the_case = read_case(arguments.the_case.path, arguments.the_case.sets);
  require(is_elastic(the_case),
          "{} has {} grains, which have no law of a material point: experiment.model must be \"mpm\"",
          arguments.the_case.path, is_bonded(the_case) ? "bonded" : "rigid");
  arguments.test.path =
      std::ranges::find(paths, arguments.path, [](const auto& p) { return p.first; })->second;
  const AnyLaw law = make_law(the_case.mpm.law, the_case.mpm.material);
  const std::string table = table_of(drive_point(law, arguments.test));
  if (arguments.table.empty()) return print_result(table);
  write_file(arguments.table, table);
  if (!arguments.figure.empty())
    become_python({"law", "--path=" + arguments.path,
                   fmt::format("--law={}", law_choice(the_case.mpm.law).name), "--", arguments.table,
                   arguments.figure});
}

}  // namespace

void add_law_verb(CLI::App& app) {
  auto arguments = std::make_shared<LawArguments>();
  CLI::App* verb = app.add_subcommand("law", "Drive one material point of a case's law; print its curve");
  add_case_arguments(*verb, arguments->the_case);
  take_one_of(
      verb->add_option("--path", arguments->path,
                       "in plane strain: shear (simple), uniaxial (along x, y free of stress), confined "
                       "(the same, y held), cycle (as uniaxial: there, back, and there again)"),
      path_words())
      ->capture_default_str();
  verb->add_option("--strain", arguments->test.strain,
                   "where to go: tan of the angle of shear, or ln of the stretch along x; below 0 pressed")
      ->capture_default_str();
  verb->add_option("--rate", arguments->test.rate, "of strain [1/s], for laws with time in them")
      ->capture_default_str();
  verb->add_option("--steps", arguments->test.steps, "of each way")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  verb->add_option("-o,--output", arguments->table, "CSV file instead of stdout")->type_name("FILE");
  verb->add_option("--plot", arguments->figure, "figure of the table that -o writes: .png, .svg or .pdf")
      ->type_name("FILE");
  verb->footer(
      "Stresses are Cauchy's in Pa, tension positive; stored and dissipated are energies per undeformed "
      "volume\n"
      "in J/m^3; work is what was done on the point, their sum but for the length of the steps.\n"
      "Examples:\n"
      "  softgrain law case.toml --path shear --strain 0.5\n"
      "  softgrain law case.toml --path cycle --strain -0.2 --rate 10 -o law.csv --plot law.png\n"
      "  softgrain law case.toml --set mpm.law=yeoh --set mpm.c30=1e5 --path uniaxial > yeoh.csv");
  verb->callback([arguments] { drive(*arguments); });
}

}  // namespace softgrain
