"""The examples in examples/python, as they stand, against what is known of them."""

import importlib.util
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
    assert {path.stem for path in EXAMPLES.glob("*.py")} == {"loading_path", "observable"}


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
