"""A patched vessel moves alike in MuJoCo and in the diagnosis filter."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from boatsim.diagnosis.candidates import diagnosis_program
from boatsim.diagnosis.config import DEFAULT
from boatsim.physics import content, vessel
from boatsim.physics.base import Array, CoefficientRelease
from boatsim.physics.kernel.records import Inputs, VesselNumbers
from boatsim.simulate.engine import Engine

WALLS = {"x_low": -4.0, "x_high": 4.0, "y_low": -3.0, "y_high": 3.0}
SMOOTH: list[dict[str, Any]] = [
    {"use": "wind", "force": 0.1, "toward": 0.7, "arm": 0.05},
    {"use": "current", "north": 0.03, "east": -0.02},
    {"use": "cross_flow_drag", "section_drag_coefficient": 0.6, "surge_quadratic": 2.0},
    {"use": "lateral_centre_shift", "shift": 0.08},
    {"use": "mass_centre_shift", "shift": -0.05},
    {"use": "extra_mass", "mass": 1.0, "x": 0.2},
    {"use": "added_mass_coriolis", "fraction": 0.6},
    {"use": "prop_walk", "side_force_per_thrust": 0.08},
    {
        "use": "tether",
        "tension": 0.03,
        "stiffness": 0.05,
        "length": 1.0,
        "north": 2.0,
        "east": 1.0,
        "drag": 0.2,
    },
    {"use": "damping_error", "surge_factor": 1.3, "sway_factor": 0.8, "yaw_factor": 1.2},
]
HELD: list[dict[str, Any]] = [
    {"use": "thrust_deadband", "width": 0.08},
    {"use": "thrust_lag", "time_constant": 0.4},
    {"use": "weak_reverse", "astern_factor": 0.7},
    {"use": "thrust_imbalance", "fraction": 0.1},
    {"use": "thrust_gain_error", "factor": 0.9},
    {"use": "steering_offset", "port": 0.05, "starboard": -0.03},
    {
        "use": "wall_effect",
        "damping_rise": 1.0,
        "pull": 0.05,
        "x_low": -4.0,
        "x_high": 4.0,
        "y_low": -3.0,
        "y_high": 3.0,
    },
]
DEAD: list[dict[str, Any]] = [
    {"use": "command_delay", "delay": 0.37},
    {"use": "steering_backlash", "width": 0.15},
    {"use": "steering_offset", "port": 0.05, "starboard": -0.03},
]
ROW, STEP, ROWS = 0.1, 0.02, 61  # [s], [s]: 6 s


def commanded(names: list[str]) -> Array:
    """Random steps of thrust and steering, held for half a second."""
    rng = np.random.default_rng(5)
    levels = np.repeat(rng.uniform(-1.0, 1.0, (ROWS // 5 + 1, 4)), 5, axis=0)[:ROWS]
    return np.ascontiguousarray(levels * [0.9 if n.startswith("thrust") else 0.6 for n in names])


@pytest.mark.parametrize(
    ("extra", "within"),
    [(SMOOTH, 1e-6), (HELD, 1e-6), (DEAD, 1e-4)],
    ids=["smooth", "held", "dead"],
)
def test_engine_and_filter_agree_over_six_seconds(
    extra: list[dict[str, Any]], within: float
) -> None:
    boat = vessel.load_vessel("trial_boat", extra=extra)
    commands = commanded(list(boat.commands))
    engine = Engine(boat, step=STEP)
    engine.reset(commands=dict(zip(boat.commands, commands[0].tolist(), strict=True)))
    in_mujoco = []
    for row in commands:
        in_mujoco.append((engine.state.x, engine.state.y, engine.state.psi))
        engine.command(dict(zip(boat.commands, row.tolist(), strict=True)))
        engine.advance(round(ROW / STEP))
    laws = {
        e["use"]
        for e in extra
        if not issubclass(content.load_class("effect", e["use"]), CoefficientRelease)
    }
    program, acting = diagnosis_program(replace(boat, found=tuple(laws)))
    assert set(acting) == laws  # a release is its coefficient's new value, in both
    times, out = ROW * np.arange(ROWS), np.full((1, ROWS, 6), np.nan)
    program.estimation_functions.simulate_intervals(
        Inputs(times, times, commands),
        DEFAULT.filter.free_run_step,
        VesselNumbers(program.body, program.values(), program.effect_switches(acting)),
        np.array([0]),
        np.array([ROWS - 1]),
        np.zeros((1, 6)),
        out,
    )
    off = np.abs(np.array(in_mujoco) - out[0, :, :3]).max(axis=0)
    assert (off < within).all(), off
    assert np.ptp(out[0, :, :2], axis=0).max() > 0.3  # it did move
