"""Simulations in memory (the compiled module), against runs of the program `softgrain` and against mechanics."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import softgrain

BPM = {"experiment": {"model": "bpm"}, "bpm": {"primaries": 60}, "loading": {"max_strain": 0.02}, "time": {"step": "1 us"}}
MPM = {"experiment": {"model": "mpm"}, "mpm": {"cells": 8}, "loading": {"max_strain": 0.1}}
LATTICE = {"experiment.model": "mpm", "mpm.cells": 8, "mpm.formulation": "updated_lagrangian", "loading.wall_velocity": "2 m/s",
           "loading.max_strain": 0.01}
BOX = {"sample": {"grains": 9, "packing_fraction": 0.6}, "loading": {"wall_velocity": "5 m/s", "max_strain": 0.1}}
BPM_BOX = {"experiment": {"model": "bpm", "loading": "compaction"}, "bpm": {"primaries": 40, "library": 2},
           "time": {"step": "0.4 us"}, **BOX}
MPM_BOX = {"experiment": {"model": "mpm", "loading": "compaction"}, "mpm": {"cells": 8}, **BOX}
ALL = pytest.mark.parametrize("case", [BPM, MPM, LATTICE, BPM_BOX, MPM_BOX],
                              ids=["bpm", "mpm", "lattice", "bpm box", "mpm box"])
QUIET = {"output": {"vtk": False, "report": False, "snapshots": 1}}


@pytest.mark.parametrize("case", [BPM, MPM_BOX], ids=["bpm", "mpm box"])
def test_the_numbers_are_those_of_the_program(case, tmp_path):
    run = softgrain.run_case(softgrain.Case(case | QUIET | {"output.samples": 10}), tmp_path / "run")
    simulation = softgrain.Simulation(case)
    rows = [simulation.observe()]
    for step in run.series["step"][1:]:
        simulation.step(int(step) - simulation.steps_done)
        rows.append(simulation.observe())
    assert len(rows) > 8 and simulation.finished
    assert simulation.units["stress_top"] == run.units["stress_top"] == "Pa"
    for name, values in run.series.items():
        if name in rows[0]:  # the program adds columns on the solver and the clock
            assert [row[name] for row in rows] == pytest.approx(values, rel=1e-8, abs=1e-300, nan_ok=True), name


@ALL
def test_the_views_of_grains_share_the_memory_and_cannot_be_written(case):
    simulation = softgrain.Simulation(case)
    grain, again = simulation.grains[-1], simulation.grains[-1]
    assert len(grain.outline) > 0 or case in (BPM, BPM_BOX)
    for view, same in zip(grain, again):
        if len(view) == 0:
            continue
        assert view.shape == (len(view), 2) and not view.flags.owndata and np.shares_memory(view, same)
        with pytest.raises(ValueError, match="read-only"):
            view[...] = 0
        with pytest.raises(ValueError):
            view.setflags(write=True)
    before = grain.position.copy()
    simulation.step(simulation.steps_planned // 2)
    assert np.abs(grain.position - before).max() > 0  # the view followed, the copy did not
    np.testing.assert_array_equal(grain.position, simulation.grains[-1].position)


@ALL
def test_views_show_what_the_scene_shows(case):
    simulation = softgrain.Simulation(case)
    simulation.step(3)
    scene, grains = simulation.scene(), simulation.grains
    assert (scene.step, scene.time) == (3, simulation.time)
    outline = np.concatenate([grain.outline for grain in grains])
    if case in (MPM, MPM_BOX, LATTICE):
        np.testing.assert_array_equal(outline, scene.outlines["position"])
    if case in (BPM, BPM_BOX, LATTICE):  # primaries and points, not nodes
        np.testing.assert_array_equal(np.concatenate([grain.position for grain in grains]), scene.particles["position"])
    assert len(grains) == (9 if case in (BPM_BOX, MPM_BOX) else 1)
    assert scene.walls.shape == ((4, 4) if case in (BPM_BOX, MPM_BOX) else (2, 4))


def test_nodes_move_with_their_velocities():
    simulation = softgrain.Simulation(MPM_BOX)
    simulation.step(10)
    before, time = [grain.position.copy() for grain in simulation.grains], simulation.time
    simulation.step()
    moved = np.concatenate([grain.position - x for x, grain in zip(before, simulation.grains)])
    velocity = np.concatenate([grain.velocity for grain in simulation.grains])
    assert np.abs(moved).max() > 1e-6
    np.testing.assert_allclose((simulation.time - time) * velocity, moved, rtol=0, atol=1e-5 * np.abs(moved).max())


def test_a_view_and_a_scene_outlive_the_simulation():
    simulation = softgrain.Simulation(MPM)
    outline, scene = simulation.grains[0].outline, simulation.scene()
    kept = outline.copy()
    gone = weakref.ref(simulation)
    del simulation
    gc.collect()
    assert gone() is not None  # the view keeps it
    np.testing.assert_array_equal(outline, kept)
    del outline
    gc.collect()
    assert gone() is None
    np.testing.assert_array_equal(scene.outlines["position"], kept)


def test_other_threads_run_during_a_run_and_cannot_take_the_simulation():
    simulation = softgrain.Simulation(softgrain.Case(BPM).set("loading.max_strain", 0.3).set("bpm.primaries", 200))
    ticks, refused, stop = [], [], threading.Event()

    def tick():
        while not stop.wait(0.002):
            ticks.append(simulation.steps_done)
            try:
                if ticks[-1] > 0:  # the run has begun: a step of this thread must not come before it
                    simulation.step()
            except RuntimeError as error:
                refused.append(str(error))

    thread = threading.Thread(target=tick)
    begin = time.monotonic()
    thread.start()
    try:
        simulation.run()
    finally:  # a thread that goes on would keep the tests from ending
        stop.set()
        thread.join()
    seconds = time.monotonic() - begin
    assert seconds > 0.2 and len(ticks) > 5 * seconds  # without the lock it would be one tick, or none
    assert len(set(ticks)) > 3  # the run went on meanwhile
    assert any("at work" in message for message in refused)


CTRL_C = """
import softgrain
simulation = softgrain.Simulation({case!r})
print("go", flush=True)
try:
    simulation.run()
except KeyboardInterrupt:
    done = simulation.steps_done
    simulation.step()  # it can go on
    print(0 < done < simulation.steps_planned, simulation.observe()["step"] - done)
"""


def test_ctrl_c_ends_a_run_between_two_steps_and_it_can_go_on():
    takes_minutes = BPM | {"loading": {"max_strain": 0.3, "wall_velocity": "1 mm/s"}}
    process = subprocess.Popen([sys.executable, "-c", CTRL_C.format(case=takes_minutes)], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "go\n"
    time.sleep(0.5)  # into the run
    process.send_signal(signal.SIGINT)
    sent = time.monotonic()
    try:
        said, error = process.communicate(timeout=20)
    finally:
        process.kill()
    assert (said, error, process.returncode) == ("True 1.0\n", "", 0)
    assert time.monotonic() - sent < 5


def test_a_run_stops_at_a_strain_and_steps_come_in_their_number():
    simulation = softgrain.Simulation(BPM)
    simulation.run(until=0.01)
    reached = simulation.strain
    assert 0.01 <= reached < 0.0101 and simulation.observe()["strain"] == reached
    steps = [s.steps_done - simulation.steps_planned for s in simulation.steps(every=100)]
    assert steps[-1] == 0 and set(np.diff(steps)[:-1]) == {100}
    assert simulation.finished and simulation.progress == 1
    assert list(simulation.steps()) == []


def test_the_last_step_is_reported():
    report = softgrain.Simulation(MPM).step(5)
    assert report.converged and report.contacts > 0 and 0 < report.residual_max < 1


WRONG = {
    "an unknown key": {"contact.frction": 0.3},
    "two mistakes": {"contact.friction": -1, "grain.radius": "5 kg"},
    "a mistake that shows when the sample is made": {"experiment.model": "mpm", "loading.unload_at": [0.3, 0.2]},
}


@pytest.mark.parametrize("values", WRONG.values(), ids=WRONG)
def test_a_wrong_case_raises_the_words_of_the_program(values, tmp_path):
    with pytest.raises(softgrain.CaseError) as by_program:
        softgrain.run_case(softgrain.Case(values), tmp_path / "run")
    with pytest.raises(softgrain.CaseError) as in_memory:
        softgrain.Simulation(values)
    assert str(in_memory.value) == str(by_program.value)
    assert isinstance(in_memory.value, ValueError)


def test_a_case_file_that_is_missing_or_wrong_raises_the_words_of_the_program(tmp_path):
    (tmp_path / "case.toml").write_text("[grain]\nradius = 5\ndensty = 1\n")
    for name in ("case.toml", "none.toml"):
        with pytest.raises(softgrain.CaseError) as by_program:
            softgrain.Case(tmp_path / name).resolve()
        with pytest.raises(softgrain.CaseError) as in_memory:
            softgrain.Simulation(tmp_path / name)
        assert str(in_memory.value) == str(by_program.value)


def test_what_breaks_down_raises_the_words_and_the_code_of_the_program(tmp_path):
    hopeless = softgrain.Case(BPM | QUIET).set("loading.wall_velocity", "50 m/s").set("loading.max_strain", 2).set(
        "solver.max_sweeps", 1).set("solver.min_sweeps", 1)
    with pytest.raises(softgrain.RunFailed) as by_program:
        softgrain.run_case(hopeless, tmp_path / "run")
    with pytest.raises(softgrain.RunFailed) as in_memory:
        softgrain.Simulation(hopeless).run()
    assert in_memory.value.code == by_program.value.code == 3
    assert str(in_memory.value) in str(by_program.value)  # which goes on with the last snapshot


def test_a_motion_moves_the_plates_and_is_asked_once_a_step():
    asked = []

    def swing(time):
        asked.append(time)
        return -0.3 * np.cos(2 * np.pi * time / 1e-3)

    simulation = softgrain.Simulation(BPM, motion=swing, duration=1e-3)
    start = simulation.observe()["wall_height"]
    heights = [s.observe()["wall_height"] for s in simulation.steps()]
    dt = simulation.time / simulation.steps_done
    np.testing.assert_allclose(asked, dt * np.arange(1000), rtol=1e-12)
    np.testing.assert_allclose(heights, start + dt * np.cumsum(-0.3 * np.cos(2 * np.pi * np.arange(1000) / 1000)), rtol=1e-12)


def test_the_speed_of_the_case_as_a_motion_gives_the_numbers_of_the_case():
    own = softgrain.Simulation(MPM_BOX)
    given = softgrain.Simulation(MPM_BOX, motion=lambda time: -5, duration=1)
    for simulation in (own, given):
        simulation.step(20)
    assert own.observe() == given.observe()
    np.testing.assert_array_equal(own.grains[4].position, given.grains[4].position)


def test_a_motion_moves_the_walls_that_the_case_moves():
    case = softgrain.Case(MPM_BOX).set("experiment.loading", "isotropic")
    simulation = softgrain.Simulation(case, motion=lambda time: -2, duration=1e-3)
    before = simulation.scene().walls
    simulation.step(10)
    after = simulation.scene().walls
    shrunk = np.ptp(before[:, 0]) - np.ptp(after[:, 0])
    assert shrunk == pytest.approx(2 * simulation.time) == pytest.approx(np.ptp(before[:, 1]) - np.ptp(after[:, 1]))


@pytest.mark.parametrize("case", [BPM, MPM, LATTICE], ids=["bpm", "mpm", "lattice"])
def test_a_wrong_motion_is_refused_and_its_errors_come_back(case):
    for duration in (None, 0, -1, np.inf):
        with pytest.raises(softgrain.CaseError, match="duration"):
            softgrain.Simulation(case, motion=lambda time: -1, duration=duration)
    not_finite = softgrain.Simulation(case, motion=lambda time: np.nan, duration=1e-3)
    with pytest.raises(softgrain.CaseError, match="nan m/s at 0 s"):
        not_finite.step()
    broken = softgrain.Simulation(case, motion=lambda time: 1 / time, duration=1e-3)
    with pytest.raises(ZeroDivisionError):
        broken.run()
    greedy = softgrain.Simulation(case, motion=lambda time: greedy.step() and 0, duration=1e-3)
    with pytest.raises(RuntimeError, match="at work"):
        greedy.step()
    assert (not_finite.steps_done, broken.steps_done, greedy.steps_done) == (0, 0, 0)
    late = softgrain.Simulation(case)
    late.step()
    with pytest.raises(softgrain.CaseError, match="before the first step"):
        late.follow(1, lambda time: -1)


def test_a_simulation_and_a_motion_that_know_each_other_can_go():
    known = {}
    simulation = softgrain.Simulation(BPM, motion=lambda time, known=known: -0.1 * (known["it"].strain < 1), duration=1e-3)
    known["it"] = simulation
    simulation.step(3)
    gone = weakref.ref(simulation)
    del simulation, known
    gc.collect()
    assert gone() is None


def last_row(seed):
    simulation = softgrain.Simulation(softgrain.Case(MPM_BOX).set("sample.seed", seed).set("sample.packing_fraction", 0.5))
    simulation.run()
    return simulation.observe()


def test_simulations_side_by_side_and_on_several_threads_have_the_numbers_of_one_alone():
    alone = [last_row(seed) for seed in (1, 2, 3)]
    before = softgrain.threads()
    softgrain.set_threads(before + 2)
    try:
        assert softgrain.threads() == before + 2
        with ThreadPoolExecutor(3) as pool:
            assert list(pool.map(last_row, (1, 2, 3))) == alone
    finally:
        softgrain.set_threads(before)


def test_without_the_compiled_module_the_reader_works_and_a_simulation_says_what_is_missing(tmp_path):
    package = os.path.dirname(os.path.realpath(softgrain.__file__))  # the sources have no compiled module
    script = ("import softgrain\ntry: softgrain.Simulation\nexcept ImportError as error: print(error)\n"
              "from softgrain import *\nprint(Case({'grain.radius': 1}).values)")
    result = subprocess.run([sys.executable, "-c", script], env=os.environ | {"PYTHONPATH": os.path.dirname(package)},
                            capture_output=True, text=True)
    assert "softgrain.Simulation needs the compiled module softgrain._core" in result.stdout, result.stderr
    assert "(('grain.radius', '1'),)" in result.stdout


def test_what_makes_no_sense_is_refused_with_words():
    simulation = softgrain.Simulation(MPM)
    for every in (0, -1, 0.5, float("nan")):
        with pytest.raises(ValueError, match="every must be a whole number, at least 1"):
            simulation.steps(every=every)
    with pytest.raises(ValueError, match="count must be a whole number, at least 0"):
        simulation.step(-1)
    for call in (simulation.run, simulation.steps):
        with pytest.raises(ValueError, match="until is nan"):
            call(until=float("nan"))
    assert simulation.steps_done == 0
    for answer in (None, "fast", [1, 2]):
        forgetful = softgrain.Simulation(MPM, motion=lambda time: answer, duration=1e-3)
        with pytest.raises(ValueError, match="the motion asks for .* at .* s"):
            forgetful.step()


def test_contacts_of_elastic_grains_are_pairs_of_grains():
    simulation = softgrain.Simulation(MPM_BOX | {"loading": {"wall_velocity": "5 m/s", "max_strain": 0.4}})
    simulation.run()
    scene = simulation.scene()
    pair = scene.contacts["pair"]
    inner = pair[:, 1] < len(scene.bodies())
    assert len(scene.bodies()) == 9 and pair.max() < 9 + 4
    assert 2 * inner.sum() / 9 == pytest.approx(simulation.observe()["z"]) and inner.any()
    ends = scene.bodies()[pair[inner]]
    along = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
    assert ((along * scene.contacts["normal"][inner]).sum(axis=1) > 0.8).all()
