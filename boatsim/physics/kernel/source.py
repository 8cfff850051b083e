"""Puts the equations of motion together as `motion.py` of a program: what a kernel knows of the freedoms, in Python."""

from boatsim.physics.kernel.equations import CONSTANTS, Writer
from boatsim.physics.signals import AXES

IMPORTS = """from math import cos, sin

import numpy as np

from boatsim.physics.kernel.compiling import inlined, lean
from boatsim.physics.signals import Motion, Shown

from .laws import HELD, flow, wrench
"""


def function(head: str, about: str, body: list[str], compiled: str) -> str:
    """A compiled function of the written program."""
    return "\n".join(
        [
            f"@{compiled}",
            f"def {head}:",
            f'    """{about}"""',
            *(f"    {line}" for line in body),
            "",
            "",
        ]
    )


def entries(array: str, n: int) -> str:
    """Entries of an array, separated by commas."""
    return ", ".join(f"{array}[{i}]" for i in range(n))


def step(n: int) -> list[str]:
    """Body of one Runge-Kutta step of fourth order over 2 n states."""
    moved = [f"s[{i}] + h * z[{n + i}]" for i in range(n)] + [
        f"s[{n + i}] + h * a[{i}]" for i in range(n)
    ]
    ended = [f"s[{i}] + w * v{i}" for i in range(n)] + [f"s[{n + i}] + w * r{i}" for i in range(n)]
    return [
        "begin, middle, end = np.int64(0), np.int64(HELD), np.int64(2 * HELD)  # plain integers count as types",
        f"z, h, at = ({entries('s', 2 * n)}), 0.0, begin",
        f"{' = '.join(f'{c}{i}' for c in 'vr' for i in range(n))} = 0.0",
        "for stage in range(4):  # a loop, so that the laws are compiled once",
        "    a = accelerations(t + h, z, act, at, p, on, k, extra)",
        "    w = 1.0 if stage == 0 or stage == 3 else 2.0",
        *(f"    v{i} += w * z[{n + i}]" for i in range(n)),
        *(f"    r{i} += w * a[{i}]" for i in range(n)),
        "    h, at = (dt, end) if stage == 2 else (0.5 * dt, middle)",
        f"    z = ({', '.join(moved)})",
        "w = dt / 6.0",
        f"return ({', '.join(ended)})",
    ]


def step_in_place(n: int) -> list[str]:
    """Body of the same step on arrays."""
    return [
        f"z = step(t, ({entries('y', 2 * n)}), dt, act, p, on, k, ({entries('extra', n)},))",
        *(f"y[{i}] = z[{i}]" for i in range(2 * n)),
    ]


def steps(n: int) -> list[str]:
    """Body of many steps with the actuators held."""
    return [
        f"z = ({entries('y', 2 * n)})",
        "for i in range(n):",
        f"    z = step(t + i * dt, z, dt, act, p, on, k, ({', '.join(['0.0'] * n)},))",
        *(f"y[{i}] = z[{i}]" for i in range(2 * n)),
    ]


def slopes(n: int) -> list[str]:
    """Body of the derivatives of the joint accelerations by the 2 n states."""
    beside = ", ".join(f"s[{i}] + DIFFERENCE * (j == {i})" for i in range(2 * n))
    return [
        f"force = ({entries('extra', n)},)",
        f"{' = '.join(f'b{i}' for i in range(n))} = 0.0",
        f"for j in range(-1, {2 * n}):  # a loop, so that the laws are compiled once",
        f"    a = accelerations(t, ({beside}), act, np.int64(HELD), p, on, k, force)",
        "    if j < 0:",
        f"        {', '.join(f'b{i}' for i in range(n))}{',' if n == 1 else ''} = a",
        "    else:",
        *(f"        out[{i}, j] = (a[{i}] - b{i}) / DIFFERENCE" for i in range(n)),
    ]


def head(w: Writer) -> list[str]:
    """Imports and constants of the written program."""
    shows = tuple(w.free + [6 + i for i in w.free])
    return [
        f'"""Equations of motion in {", ".join(AXES[i] for i in w.free)}, by boatsim; not meant to be edited."""',
        "",
        IMPORTS,
        f"NQ = {w.n}  # positions; the state has twice as many",
        f"K = {CONSTANTS}  # constants of a pass",
        f"FREE = {tuple(w.free)}  # of (surge, sway, heave, roll, pitch, yaw)",
        f"FREED = {tuple(1.0 if i in w.free else 0.0 for i in range(6))}  # 1 for each of the six that is free",
        f"SHOWS = {shows}  # entries of `Shown` in the order of a state",
        f"TILTS = {w.tilts}  # axes are fixed in the hull",
        f"CLOSED = {w.closed}  # the whole mass matrix is inverted once",
        "DIFFERENCE = 1e-6  # [m, rad, m/s, rad/s] of a one-sided difference",
        "",
        "",
    ]


def written(dof: tuple[str, ...], centred: bool) -> str:
    """`motion.py` of a program; `centred`: the mass centre is the origin of motion."""
    w = Writer(dof, centred)
    functions = [
        function(
            "accelerations(t, s, act, at, p, on, k, extra)",
            "Joint accelerations; extra is a further body force over the freedoms, act[at:] the actuators now.",
            w.accelerations(),
            "inlined",
        ),
        function(
            "step(t, s, dt, act, p, on, k, extra)",
            "One Runge-Kutta step of fourth order; act: the actuators at its begin, middle and end.",
            step(w.n),
            "inlined",
        ),
        function(
            "step_in_place(t, y, dt, act, p, on, k, extra)",
            "`step` on arrays.",
            step_in_place(w.n),
            "lean",
        ),
        function(
            "steps(t, y, dt, n, act, p, on, k)",
            "N steps, actuators held, in place.",
            steps(w.n),
            "lean",
        ),
        function(
            "forces(t, s, act, at, p, on)",
            "Body force of all laws, over the freedoms.",
            w.forces(),
            "lean",
        ),
        function(
            "slopes(t, s, act, p, on, k, extra, out)",
            "Derivatives of the joint accelerations by the state, one-sided.",
            slopes(w.n),
            "lean",
        ),
        function(
            "force_slopes(s, k, A, row, column)",
            "Derivatives of the joint accelerations by a body force over the freedoms, to A[row:, column:].",
            w.force_slopes(),
            "inlined" if w.closed else "lean",
        ),
        function(
            "moved(s)",
            "What instruments that show the truth would show of a state.",
            w.moved(),
            "inlined",
        ),
        function(
            "feels(t, s, act, at, p, on, k, extra)",
            "What instruments aboard would feel: psi, r, acceleration over ground along x and y, u, v, x, y, phi, p.",
            w.feels(),
            "inlined",
        ),
        function(
            "jacobian(s, J)",
            "Body rates per joint rate, to J (6, NQ) of zeros.",
            w.jacobian(),
            "inlined",
        ),
        function(
            "observe_level(s, code, row)",
            "Expected value of one measured channel and its row of the measurement matrix, axes that do not tilt.",
            w.level_rates(),
            "inlined",
        ),
        function(
            "add_to_mujoco(t, q, qd, act, at, p, k, force, M)",
            "Add the passive force and the lower triangle of J' M J, MuJoCo's z-up joints (yaw, pitch, roll last).",
            w.add_to_mujoco(),
            "inlined",
        ),
    ]
    return "\n".join([*head(w), *functions])
