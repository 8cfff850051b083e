"""Steady course of a vessel: speed, drift, heel and helm at which no acceleration is left."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from boatsim.physics.signals import AXES, STATE, Array
from boatsim.physics.vessel import ManoeuvringTable, Vessel
from boatsim.simulate.batch import Batch

# Largest acceleration of a steady course, relative to speed per time of travel of one length. The
# state then changes by less than this share over a length.
STEADY = 1e-7
PERTURBATION = 1e-5  # of the scaled unknowns, for derivatives; the error of a difference is 1e-11
MOST_ITERATIONS = 40  # of Newton's method; three suffice for ships with a small bias
SMALLEST_STEP = 1e-3  # share of a Newton step below which the search for a smaller residual ends
# A slower solution, as a share of the expected speed, is a ship that lies still
SLOWEST = 0.2


class SteadyCourse(NamedTuple):
    """State and helm at which a vessel keeps course and speed without turning."""

    state: Mapping[str, float]  # by SNAME symbol, position and heading left out [m, rad, m/s]
    helm: float  # [rad] positive to starboard


def steering_commands(table: ManoeuvringTable, helm: float) -> dict[str, float]:
    """Return the commands of the steering channels for going ahead with some helm.

    Args:
        table: Complete [manoeuvring] table of the vessel.
        helm: Helm angle [rad], positive to starboard.
    """
    commands: dict[str, float] = {}
    for name, per_rad in table.steer.items():
        commands[name] = table.ahead.get(name, 0.0) + per_rad * helm
    return commands


def find_steady_course(
    vessel: Vessel, speed: float, largest_helm: float, step: float, *, hold_speed: bool
) -> SteadyCourse | None:
    """Return the steady course of a vessel under its commands ahead, to north.

    The unknowns are the velocities in surge and sway, the pose in heave, roll and pitch, and the
    helm; the conditions are that all accelerations vanish. Newton's method solves them, so that
    ships without straight-line stability have a steady course, too.

    Args:
        vessel: The vessel, with a complete [manoeuvring] table, free in surge and yaw.
        speed: Expected speed [m/s].
        largest_helm: Largest helm to either side [rad].
        step: Integration step [s] over which the change of the velocities is taken.
        hold_speed: Whether surge keeps the speed; its acceleration does not count then.

    Returns:
        The steady course; None if there is none near the expected speed.
    """
    balance = _Balance(vessel, speed, step, hold_speed)
    limits = np.full(len(balance.unknown), np.inf)
    limits[balance.unknown.index("yaw")] = largest_helm / balance.scale["yaw"]
    x = balance.start()
    residual = balance.residuals(x[None])[0]
    for _ in range(MOST_ITERATIONS):
        if np.abs(residual).max() < STEADY:
            break
        moved = balance.residuals(x + PERTURBATION * np.eye(len(x)))
        slopes = (moved - residual).T / PERTURBATION
        if not np.isfinite(slopes).all():
            return None
        newton = -np.linalg.lstsq(slopes, residual, rcond=None)[0]
        share = 1.0
        while share > SMALLEST_STEP:
            further = np.clip(x + share * newton, -limits, limits)
            new = balance.residuals(further[None])[0]
            if np.linalg.norm(new) < np.linalg.norm(residual):
                break
            share *= 0.5
        else:
            return None
        x, residual = further, new
    found = balance.course(x)
    if not np.abs(residual).max() < STEADY or found.state["u"] < SLOWEST * speed:
        return None
    return found


class _Balance:
    """Accelerations of a vessel on a straight course as a function of scaled unknowns."""

    def __init__(self, vessel: Vessel, speed: float, step: float, hold_speed: bool) -> None:
        self.vessel, self.speed, self.step = vessel, speed, step
        self.axes = [axis for axis in AXES if axis in vessel.dof]  # in the order of a state
        self.unknown = list(self.axes)
        if hold_speed:
            self.unknown.remove("surge")
        tenth = 0.1  # [rad] of heel, trim and helm
        self.scale = {
            "surge": speed,
            "sway": speed,
            "heave": 0.1 * vessel.draught,
            "roll": tenth,
            "pitch": tenth,
            "yaw": tenth,
        }
        self._batch = Batch(vessel, len(self.unknown), step=step)

    def start(self) -> Array:
        """Return the scaled unknowns (n,) of a course straight ahead at the expected speed."""
        x = np.zeros(len(self.unknown))
        if "surge" in self.unknown:
            x[self.unknown.index("surge")] = 1.0
        return x

    def residuals(self, rows: Array) -> Array:
        """Return the scaled accelerations (N, n) of rows (N, n) of unknowns, N at most n."""
        program, nq = self._batch.program, len(self.axes)
        boats = np.arange(len(rows))
        joints = np.array([self._joint_state(x) for x in rows])
        commands = np.array([self._commands(x) for x in rows])
        before = program.to_body_velocities(joints)
        self._batch.reset(before, commands, boats)
        self._batch.advance(steps=1)
        after = program.to_joint_rates(self._batch.states[boats])
        change = (after - joints)[:, nq:] / self.step
        unit = self.vessel.length / self.speed
        columns = []
        for axis in self.unknown:
            scale = self.speed / unit
            if axis in ("roll", "pitch", "yaw"):
                scale = 1.0 / unit**2
            columns.append(change[:, self.axes.index(axis)] / scale)
        return np.column_stack(columns)

    def course(self, x: Array) -> SteadyCourse:
        """Return state and helm of scaled unknowns (n,)."""
        values = self._batch.program.to_body_velocities(self._joint_state(x)[None])[0]
        state: dict[str, float] = {}
        for signal in STATE:
            if signal.axis in self.axes and signal.symbol not in ("x", "y", "psi"):
                place = self.axes.index(signal.axis) + len(self.axes) * signal.rate
                state[signal.symbol] = float(values[place])
        return SteadyCourse(state, self._helm(x))

    def _helm(self, x: Array) -> float:
        return float(x[self.unknown.index("yaw")] * self.scale["yaw"])

    def _joint_state(self, x: Array) -> Array:
        """Coordinates and joint rates (2 NQ,); only surge and sway have rates."""
        axes = self.axes
        state = np.zeros(2 * len(axes))
        state[len(axes) + axes.index("surge")] = self.speed
        for value, axis in zip(x, self.unknown, strict=True):
            if axis in ("surge", "sway"):
                state[len(axes) + axes.index(axis)] = value * self.scale[axis]
            elif axis != "yaw":
                state[axes.index(axis)] = value * self.scale[axis]
        return state

    def _commands(self, x: Array) -> Array:
        table = self.vessel.manoeuvring
        commands = {**table.ahead, **steering_commands(table, self._helm(x))}
        return self._batch.program.command_array(commands)
