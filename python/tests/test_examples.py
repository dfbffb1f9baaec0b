"""The examples in examples/python, as they stand, against what is known of them."""

import importlib.util
import sys
import types
from functools import cache
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "python"


@cache
def example(name):
    """The example as a module, whose simulation runs once for all tests."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for simulating in ("squeeze", "compact"):
        if hasattr(module, simulating):
            setattr(module, simulating, cache(lambda original=getattr(module, simulating): original()))
    return module


def test_every_example_is_tested():
    assert {path.stem for path in EXAMPLES.glob("*.py")} == {"loading_path", "observable", "grainlearn_calibration"}


def test_the_cycles_go_as_deep_as_they_say_and_take_the_work_of_their_loops():
    loading_path = example("loading_path")
    series = loading_path.squeeze()
    table = loading_path.cycle_table(series)
    assert [depth for depth, _, _ in table] == pytest.approx(loading_path.DEPTHS, rel=1e-2)
    height = series["wall_height"]
    assert height[-1] == pytest.approx(height[0], abs=1e-8)  # back where it began
    loop = -np.sum(series["force_top"][1:] * np.diff(height))  # the mean force of each row times its way
    assert sum(work for _, _, work in table) == pytest.approx(loop, rel=0.02)
    assert all(work > 0 for _, _, work in table)


def test_the_circularity_of_polygons_is_the_known_one():
    circularity = example("observable").circularity
    for n in (3, 4, 6, 96):
        angle = 2 * np.pi * np.arange(n) / n
        assert circularity(3 + 2 * np.c_[np.cos(angle), np.sin(angle)]) == pytest.approx(np.pi / (n * np.tan(np.pi / n)))


def test_the_observable_of_the_example_has_the_mean_that_the_series_has():
    rows = example("observable").compact()
    assert len(rows) > 15
    for row in rows:
        assert row["circularity_mean"] == pytest.approx(row["circularity"], rel=1e-9)
        assert row["circularity_least"] < row["circularity_mean"] < 1


@pytest.mark.parametrize("name, said", [("loading_path", "not given back"), ("observable", "circularity 0.9")])
def test_an_example_says_what_it_found_and_draws_it(name, said, tmp_path, capsys):
    example(name).main(tmp_path / "figure.png")
    assert said in capsys.readouterr().out
    assert (tmp_path / "figure.png").stat().st_size > 5000


class Calibration:
    """GrainLearn's calling convention (bayesian_calibration.py, dynamic_systems.py of its version 2), without its
    inference: three samples, and the most probable is the one with the smallest error."""

    def __init__(self, description):
        self.callback, given = description["callback"], description["system"]
        assert {"num_iter", "callback", "system", "inference", "save_fig"} == description.keys()
        assert {"Bayes_filter", "sampling"} == description["inference"].keys()
        least, most = np.array(given["param_min"]), np.array(given["param_max"])
        truth = np.array(example("grainlearn_calibration").TRUTH)
        assert (least < truth).all() and (truth < most).all()
        self.system = types.SimpleNamespace(
            param_data=np.array([(least[0], truth[1]), truth, (truth[0], most[1])]), ctrl_data=given["ctrl_data"],
            obs_data=np.array(given["obs_data"], ndmin=2), sim_data=None)
        self.system.set_sim_data = lambda data: setattr(self.system, "sim_data", np.array(data))

    from_dict = classmethod(lambda cls, description: cls(description))

    def run(self):
        self.callback(self)
        assert self.system.sim_data.shape == (3, *self.system.obs_data.shape)  # samples, observables, steps

    def get_most_prob_params(self):
        self.errors = np.abs(self.system.sim_data - self.system.obs_data).mean(axis=(1, 2))
        return self.system.param_data[np.argmin(self.errors)]


def test_grainlearn_gets_curves_in_its_shape_and_finds_the_parameters_of_a_known_one(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "grainlearning", types.SimpleNamespace(BayesianCalibration=Calibration))
    example("grainlearn_calibration").main()
    assert capsys.readouterr().out == "mpm.young_modulus = 8e+06\nmpm.poisson_ratio = 0.4\n"


def test_a_measured_curve_is_read_from_its_file(monkeypatch, tmp_path):
    module = example("grainlearn_calibration")
    seen = {}
    monkeypatch.setattr(module, "calibrate", lambda strain, stress: seen.update(strain=strain, stress=stress) or [1, 2])
    (tmp_path / "curve.csv").write_text("0.1,1e5\n0.2,3e5\n")
    module.main(tmp_path / "curve.csv")
    assert seen["strain"].tolist() == [0.1, 0.2] and seen["stress"].tolist() == [1e5, 3e5]
