// The compiled module softgrain._core: a simulation in memory. softgrain/simulation.py is its face, and
// softgrain/_core.pyi says what Python sees of it.
#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "softgrain/core/error.hpp"
#include "softgrain/core/parallel.hpp"
#include "softgrain/experiment/create.hpp"
#include "softgrain/experiment/run.hpp"
#include "softgrain/io/case/case_file.hpp"
#include "softgrain/observe/columns.hpp"

namespace py = pybind11;

namespace softgrain {
namespace {

/// How often a run without the interpreter's lock asks it for signals: below what a hand on the keys notices.
constexpr auto time_between_looks = std::chrono::milliseconds(50);

/// A simulation that one caller at a time moves on or measures.
struct LiveSimulation {
  LiveSimulation(const std::string& case_file, const std::vector<std::string>& sets)
      : simulation(create_simulation(read_case(case_file, sets))) {}

  std::unique_ptr<Simulation> simulation;
  bool in_use = false;  ///< changed under the interpreter's lock only
};

/// Takes the simulation while this object lives. Raises RuntimeError where another thread, or the step that
/// asks a motion, has it.
class Use {
 public:
  explicit Use(LiveSimulation& live) : live_(live) {
    if (live_.in_use)
      throw std::runtime_error("the simulation is at work, in another thread or in this step");
    live_.in_use = true;
  }
  ~Use() { live_.in_use = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  LiveSimulation& live_;
};

/// Lets a run go on while a condition holds and Ctrl-C, looked for between two steps, has not been pressed.
template <class Condition>
class Watch final : public Recorder {
 public:
  explicit Watch(const Condition& go_on) : go_on_(go_on) {}

  bool after_step(AnySimulation&, const StepReport& step, RunReport&) override {
    last = step;
    if (std::chrono::steady_clock::now() - looked_ > time_between_looks) look_for_signals();
    return go_on_();
  }

  StepReport last;

 private:
  void look_for_signals() {
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    looked_ = std::chrono::steady_clock::now();
  }

  const Condition& go_on_;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
};

/// Steps while `go_on()`, without the interpreter's lock. Ctrl-C raises KeyboardInterrupt.
template <class Condition>
StepReport advance(LiveSimulation& live, const Condition& go_on) {
  const Use use(live);
  const py::gil_scoped_release unlocked;
  Watch watch(go_on);
  if (go_on()) run(*live.simulation, watch);
  return watch.last;
}

/// A read-only array (rows, 2) on the simulation's own memory, which it keeps alive.
py::array view_of(const VectorView& view, const py::object& owner) {
  const auto bytes = [](std::size_t numbers) { return static_cast<py::ssize_t>(numbers * sizeof(double)); };
  py::array_t<double> array(std::vector<py::ssize_t>{static_cast<py::ssize_t>(view.rows), 2},
                            {bytes(view.row), bytes(view.component)}, view.begin, owner);
  array.attr("setflags")(false);
  return array;
}

py::list views_of(const py::object& self) {
  py::list views;
  for (const GrainView& grain : self.cast<LiveSimulation&>().simulation->grains())
    views.append(py::make_tuple(view_of(grain.position, self), view_of(grain.velocity, self),
                                view_of(grain.outline, self)));
  return views;
}

/// A NumPy array that takes over the numbers.
template <class T>
py::array array_of(std::vector<T> values, std::size_t columns) {
  const auto rows = static_cast<py::ssize_t>(values.size() / columns);
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  if (columns == 1) return py::array_t<T>(rows, kept->data(), owner);
  return py::array_t<T>({rows, static_cast<py::ssize_t>(columns)}, kept->data(), owner);
}

py::dict arrays_of(std::map<std::string, Array>& fields) {
  py::dict arrays;
  for (auto& [name, field] : fields) {
    const auto moved = [columns = field.columns](auto& values) {
      return array_of(std::move(values), columns);
    };
    arrays[py::str(name)] = std::visit(moved, field.values);
  }
  return arrays;
}

py::dict scene_parts(LiveSimulation& live) {
  Scene scene;
  {
    const Use use(live);
    const py::gil_scoped_release unlocked;
    scene = live.simulation->scene();
  }
  py::dict parts;
  parts["particles"] = arrays_of(scene.particles);
  parts["contacts"] = arrays_of(scene.contacts);
  parts["outlines"] = arrays_of(scene.outlines);
  parts["walls"] = array_of(std::move(scene.wall_segments), 4);
  parts["cell"] = array_of(std::move(scene.cell), 2);
  return parts;
}

std::vector<std::tuple<std::string, std::string, double>> next_row(LiveSimulation& live) {
  std::vector<std::tuple<std::string, std::string, double>> row;
  const Use use(live);
  const py::gil_scoped_release unlocked;
  for (const Quantity& quantity : softgrain::row_of(live.simulation->observe()))
    row.emplace_back(quantity.name, quantity.unit, quantity.value);
  live.simulation->begin_row();
  return row;
}

void follow(LiveSimulation& live, double duration, std::function<double(double)> velocity) {
  const Use use(live);
  require(live.simulation->steps_done() == 0, "a motion is given before the first step");
  live.simulation->follow({.duration = duration, .velocity = std::move(velocity)});
}

/// Our errors become the exceptions of softgrain/case.py, with the words of the program.
void translate(std::exception_ptr error) {
  const auto raise = [](const char* type, auto... arguments) {
    const py::object exception = py::module_::import("softgrain.case").attr(type);
    PyErr_SetObject(exception.ptr(), exception(arguments...).ptr());
  };
  try {
    if (error) std::rethrow_exception(error);
  } catch (const CaseFileError& wrong) {
    raise("CaseError", py::str(wrong.what()).attr("strip")());
  } catch (const UsageError& wrong) {
    raise("CaseError", fmt::format("error: {}", wrong.what()));
  } catch (const NumericalError& failure) {
    raise("RunFailed", fmt::format("error: {}", failure.what()), 3);
  } catch (const IoError& failure) {
    PyErr_SetString(PyExc_OSError, failure.what());
  }
}

/// A property that the simulation knows without being moved.
template <class Class, class T>
void say(Class& type, const char* name, T (Simulation::*question)() const) {
  type.def_property_readonly(
      name, [question](const LiveSimulation& live) { return ((*live.simulation).*question)(); });
}

}  // namespace
}  // namespace softgrain

PYBIND11_MODULE(_core, module) {
  using namespace softgrain;
  py::register_exception_translator(translate);
  module.def("set_threads", &set_threads, py::arg("count"));
  module.def("threads", &threads);

  py::class_<StepReport>(module, "StepReport")
      .def_readonly("contacts", &StepReport::contacts)
      .def_readonly("sweeps", &StepReport::sweeps)
      .def_readonly("residual_mean", &StepReport::residual_mean)
      .def_readonly("residual_max", &StepReport::residual_max)
      .def_readonly("residual_limit", &StepReport::residual_limit)
      .def_readonly("overlap_mean", &StepReport::overlap_mean)
      .def_readonly("overlap_max", &StepReport::overlap_max)
      .def_readonly("converged", &StepReport::converged);

  py::class_<LiveSimulation> type(module, "Simulation");
  type.def(py::init<const std::string&, const std::vector<std::string>&>(), py::arg("case_file"),
           py::arg("sets"), py::call_guard<py::gil_scoped_release>())
      .def("follow", &follow, py::arg("duration"), py::arg("velocity"))
      .def(
          "step",
          [](LiveSimulation& live, std::int64_t count) {
            const Simulation& simulation = *live.simulation;
            const std::int64_t last = simulation.steps_done() + count;
            return advance(live, [&] { return simulation.steps_done() < last; });
          },
          py::arg("count"))
      .def(
          "run",
          [](LiveSimulation& live, double until) {
            advance(live, [&] { return live.simulation->strain() < until; });
          },
          py::arg("until"))
      .def("row", &next_row)
      .def("scene_parts", &scene_parts)
      .def("views", &views_of);
  say(type, "finished", &Simulation::finished);
  say(type, "progress", &Simulation::progress);
  say(type, "time", &Simulation::time);
  say(type, "strain", &Simulation::strain);
  say(type, "steps_done", &Simulation::steps_done);
  say(type, "steps_planned", &Simulation::steps_planned);
  say(type, "early_end", &Simulation::early_end);
}
