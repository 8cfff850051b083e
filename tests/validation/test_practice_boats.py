"""The boats of the practice set and of the calibration campaign sail as those of boatsim do."""

import ast
from pathlib import Path

import numpy as np
import pytest

from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.simulate.batch import Batch
from validation.calibration.vessels import BOATS
from validation.practice import motion

COMMANDS = {  # seconds and rows of commands in the vessel's order
    "catamaran": (3.0, [[6.0, 0.4], [2.0, -0.9], [10.0, 0.1], [0.0, 0.0], [4.0, 1.2]]),
    "joystick_boat": (3.0, [
        [0.0, 0.0, 0.3, 0.3, 120, 80], [0.0, 0.0, -0.7, 0.2, -60, 150], [0.1, 0.0, 0.5, -0.5, 200, 200],
        [0.0, 0.0, 0.0, 0.0, 0, 0], [0.0, -0.1, 0.7, 0.7, -150, -90],
    ]),
    "otter": (3.0, [[60.0, 80.0], [90.0, 20.0], [-40.0, 50.0], [0.0, 0.0], [70.0, -70.0]]),
    "eastward_ho": (20.0, [[0.2], [-0.35], [0.0], [0.5], [-0.1]]),
    "martin_tank_model": (2.0, [[], [], [], [], []]),
    "blueboat": (3.0, [[20.0, 5.0], [-10.0, 30.0], [40.0, 40.0], [0.0, 0.0], [-20.0, 10.0]]),
    "mariner": (60.0, [[0.2], [-0.35], [0.0], [0.5], [-0.1]]),
}  # fmt: skip
STARTS = {
    "eastward_ho": {"u": 6.68777},
    "mariner": {"u": 7.7175},
    "martin_tank_model": {"phi": 0.3},
}
SYMBOLS = ("x", "y", "z", "phi", "theta", "psi", "u", "v", "w", "p", "q", "r")


def sailed(name: str, dt: float) -> Array:
    """States (12,) after each row of commands, by the independent integrator."""
    boat, (held, rows) = BOATS[name](), COMMANDS[name]
    state = np.array([[STARTS.get(name, {}).get(s, 0.0)] for s in SYMBOLS])
    q, nu, t, run = state[:6], state[6:], np.zeros(1), np.zeros(1, dtype=np.int64)
    y, out, inverse = boat.drive.goals(np.array([rows[0]], dtype=float).T), [], boat.inverse()
    for row in rows:
        goal = boat.drive.goals(np.array([row], dtype=float).T)
        for _ in range(round(held / dt)):
            acts = tuple(
                np.where((boat.drive.lag > 0)[:, None], boat.drive.follow(y, goal, s), goal)
                for s in (0.0, dt / 2, dt)
            )
            q, nu = motion.runge_kutta_step(
                boat,
                t,
                run,
                q,
                nu,
                (acts[0], acts[1], acts[2]),
                dt,
                np.zeros((6, 1)),
                lambda m: np.zeros_like(m.nu),
                lambda t, q, run: None,
                inverse,
            )
            t, y = t + dt, acts[2]
        out.append(np.concatenate([q, nu])[:, 0])
    return np.array(out)


@pytest.mark.parametrize("name", COMMANDS)
def test_a_boat_with_nothing_concealed_sails_as_the_tools_own(name: str) -> None:
    held, rows = COMMANDS[name]
    boat = vessel.load_vessel(name)
    free = BOATS[name]().free
    at = [*free, *(6 + i for i in free)]
    start = [STARTS.get(name, {}).get(SYMBOLS[i], 0.0) for i in at]
    theirs = Batch(boat, step=held / 1000).rollout(
        start, np.array(rows, dtype=float).reshape(5, -1), held
    )[1:]
    ours = sailed(name, held / 150)[:, at]
    size = np.array(
        [boat.length if i % 6 < 3 else 1.0 for i in at]
    )  # [m] or [rad], and a second for rates
    assert np.abs(ours - theirs).max(axis=0) / size == pytest.approx(0.0, abs=1e-4)


def test_no_file_of_the_practice_set_imports_the_tool() -> None:
    for file in Path(motion.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not any(n.split(".")[0] == "boatsim" for n in names), file
