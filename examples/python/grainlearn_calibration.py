"""Parameters of a grain from a measured curve by GrainLearn's Bayesian calibration: what it calls back runs softgrain.

    python3 examples/python/grainlearn_calibration.py [CURVE.csv]      two columns: strain, stress [Pa]

Without a curve, one of known parameters takes its place. Needs GrainLearn (https://grainlearning.readthedocs.io) and the
program; `softgrain fit` needs neither GrainLearn nor many samples where a least squares fit is enough.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import softgrain

CASE = softgrain.Case({"experiment": {"model": "mpm"}, "mpm": {"cells": 4}, "loading": {"max_strain": 0.25, "unload_at": []},
                       "output": {"samples": 100, "snapshots": 1, "report": False, "vtk": False}})
NAMES = ["mpm.young_modulus", "mpm.poisson_ratio"]
LEAST, MOST = [2e6, 0.2], [20e6, 0.49]  # [Pa], 1
TRUTH = (8e6, 0.4)
COLUMN = "stress_top"


def curve(parameters, strain):
    """The stress [Pa] at these strains of a run with these parameters, in the order of NAMES."""
    case = CASE
    for name, value in zip(NAMES, parameters):
        case = case.set(name, float(value))
    with tempfile.TemporaryDirectory() as folder:
        series = softgrain.run_case(case, Path(folder) / "run").series
    return np.interp(strain, series["strain"], series[COLUMN])


def run_samples(calibration):
    """What GrainLearn calls: for each row of system.param_data (samples, parameters) the curve at system.ctrl_data, handed
    back as (samples, observables, steps)."""
    system = calibration.system
    system.set_sim_data([curve(row, system.ctrl_data)[None, :] for row in system.param_data])


def calibrate(strain, stress, samples=20, iterations=4):
    """The most probable parameters, in the order of NAMES."""
    from grainlearning import BayesianCalibration

    calibration = BayesianCalibration.from_dict({
        "num_iter": iterations,
        "callback": run_samples,
        "system": {"param_names": NAMES, "param_min": LEAST, "param_max": MOST, "num_samples": samples,
                   "obs_names": [COLUMN], "obs_data": stress, "ctrl_name": "strain", "ctrl_data": strain, "sim_name": "softgrain"},
        "inference": {"Bayes_filter": {"ess_target": 0.3}, "sampling": {"max_num_components": 1}},
        "save_fig": -1,
    })
    calibration.run()
    return calibration.get_most_prob_params()


def main(*arguments):
    if arguments:
        strain, stress = np.loadtxt(arguments[0], delimiter=",", unpack=True)
    else:
        strain = np.linspace(0.02, 0.2, 19)
        stress = curve(TRUTH, strain)
    for name, value in zip(NAMES, calibrate(strain, stress)):
        print(f"{name} = {value:.4g}")


if __name__ == "__main__":
    main(*sys.argv[1:])
