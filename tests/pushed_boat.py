"""The trial boat under a further force, from an integrator that shares no code with the tool, laid
on its filter."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.integrate import odeint

from boatsim.diagnosis.candidates import candidate_library
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.prior_noise import prior_noise_levels
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.diagnosis.search.ranking import fit_baseline
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.program import Program
from boatsim.recordings.table import Notes, Recording

BOAT = vessel.load_vessel("trial_boat")
FEW_ROWS = replace(DEFAULT, load=replace(DEFAULT.load, row_rate=4.0))  # for quick diagnoses
M, IZ, A11, A22, A66 = 4.6, 0.6, 0.3, 9.0, 0.7  # kg, kg m^2
DAMPING, X_MOTOR, Y_MOTOR = np.array([3.0, 10.0, 1.0]), -0.6, 0.19
RATE, ROWS = 6.0, 240
COMMANDS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")
Missing = Callable[
    [float, Array, Array], Array
]  # t, (x, y, psi, u, v, r, and what is late), commands -> X, Y, N
Late = tuple[
    float, Callable[[Array], float]
]  # time constant [s] with which something follows the commands, and what


def push(thrust: Array, steer: Array) -> Array:
    X, Y = thrust * np.cos(steer), thrust * np.sin(steer)
    return np.array([X.sum(), Y.sum(), X_MOTOR * Y.sum() + Y_MOTOR * (X[0] - X[1])])


def weak_astern(t: float, y: Array, command: Array) -> Array:
    """A third of the thrust astern is missing."""
    return np.asarray(-0.33 * push(np.minimum(command[:2], 0.0), command[2:]))


def sail(
    name: str,
    seed: int,
    missing: Missing,
    facts: dict[str, Any] | None = None,
    late: Late | None = None,
    straight: bool = False,
) -> tuple[Recording, Array]:
    """A recording of the trial boat under a further force, and that force at every row.

    Straight: both motors have one thrust ahead, and nothing steers.
    """
    rng = np.random.default_rng(seed)
    levels = np.column_stack(
        [rng.uniform(-0.9, 0.9, (ROWS // 8, 2)), rng.uniform(-0.6, 0.6, (ROWS // 8, 2))]
    )
    if straight:
        levels = np.column_stack([np.abs(levels[:, [0, 0]]), np.zeros((ROWS // 8, 2))])
    commands = np.repeat(levels, 8, axis=0)

    def slope(y: Array, t: float, command: Array) -> list[float]:
        u, v, r = y[3:6]
        X, Y, moment = push(command[:2], command[2:]) - DAMPING * y[3:6] + missing(t, y, command)
        c, s = np.cos(y[2]), np.sin(y[2])
        du, dv = (X + M * v * r) / (M + A11), (Y - M * u * r) / (M + A22)
        slow = [(late[1](command) - y[6]) / late[0]] if late else []
        return [u * c - v * s, u * s + v * c, r, du, dv, moment / (IZ + A66), *slow]

    t, y, poses, forces = np.arange(ROWS) / RATE, np.zeros(6), [], []
    y = np.append(y, late[1](commands[0]) if late else [])
    for now, command in zip(t, commands, strict=True):
        poses.append(y[:3])
        fine = np.linspace(now, now + 1 / RATE, 5)
        path = odeint(slope, y, fine, args=(command,), rtol=1e-7, atol=1e-9)
        forces.append(
            np.mean([missing(a, b, command) for a, b in zip(fine, path, strict=True)], axis=0)
        )
        y = path[-1]
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * [0.003, 0.003, 0.012]
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True)) | dict(
        zip(COMMANDS, commands.T, strict=True)
    )
    return Recording(name, t, signals, Notes(vessel="trial_boat", facts=facts or {})), np.array(
        forces
    )


def laid(*recordings: Recording) -> tuple[Problem, Fit]:
    program = Program(BOAT, candidate_library(BOAT).compiled_effects)
    problem = Problem(
        [map_recording(r, program) for r in recordings],
        prior_noise_levels(BOAT, recordings),
        {"damping": 0.05, "thrust": 0.05},
    )
    return problem, fit_baseline(problem)[1]
