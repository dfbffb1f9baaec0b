#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "python_program.hpp"
#include "verbs.hpp"

namespace softgrain {

void add_paraview_verb(CLI::App& app) {
  auto* verb = app.add_subcommand("paraview", "Write a script that shows a run in ParaView");
  auto run = std::make_shared<std::string>();
  verb->add_option("RUN", *run, "a run's directory, with its vtk/")->required();
  verb->footer(
      "Example:\n"
      "  paraview --script=$(softgrain paraview squeeze/case_run)\n"
      "\nRUN/paraview/scene.py shows grains, particles coloured by pressure, contacts as tubes, and walls.\n"
      "Needs Python with NumPy and h5py: /usr/bin/python3, or what SOFTGRAIN_PYTHON names.");
  verb->callback([run] { become_python("export", {"--to=paraview", "--", *run}); });
}

}  // namespace softgrain
