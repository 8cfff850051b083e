"""Constrained control allocation of a force and moment to any number of thrusters and rudders.

The thrust vectors of azimuth thrusters are variables in Cartesian form (extended thrust), so that
the optimum without rates is a convex program. Rates then limit the step towards it, which is
optimal for the force and moment at the end of the period.

T. A. Johansen, T. I. Fossen, Control allocation - a survey, Automatica 49, 2013; T. A. Johansen,
T. I. Fossen, S. P. Berge, Constrained nonlinear control allocation with singularity avoidance using
sequential quadratic programming, IEEE Trans. Control Systems Technology 12, 2004.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import atan, atan2, ceil, cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from boatsim.control.base import clip, wrap
from boatsim.control.quadratic_program import solve_quadratic_program
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.physics.kernel.compiling import compiled

# Penalty of a missing force over the cost of thrust, both relative to full thrust. An attainable
# demand is then met to 1e-6 of full thrust, and the condition number leaves ten digits.
DEMAND = 1e6
# Costs of the distance to the optimal thrust and angle while rates limit the step: far below
# DEMAND, so that the force comes first, and above rounding.
APPROACH = 1.0
FEWEST_TANGENTS = 8  # of the circle of an azimuth thruster, before those at the solution
MOST_CUTS = 12  # rounds of tangents; each one squares the relative error
ROUND = 1e-9  # a thrust that exceeds its limit by this share counts as within it
# A thrust below this share of the limit has no direction, so that the thruster keeps its angle.
IDLE = 1e-4
# Another sector (ahead or astern, before or behind a forbidden zone) has to be better by this share
# of the cost, or the thruster would turn to and fro between two equal optima.
HYSTERESIS = 0.1
MOST_SECTORS = 256  # combinations of sectors that are compared in one call
FULL_TURN = 2.0 * pi
NEAR_SINGULAR = 1e-3  # relative determinant below which the cost of a singularity is level
# [rad] by which neighbours are turned apart where the derivative is taken: it is zero if all of
# them point exactly alike, a saddle that would hold them
APART = 0.05
ANGLE_STEP = 1e-4  # [rad] over which the derivative of the determinant is taken
REPEATS = 3  # linearisations of a step; the third one changes a thrust by less than 1e-4 of full


@dataclass(frozen=True)
class Thruster:
    """One fixed, tunnel or azimuth thruster, or a rudder, as the allocation sees it.

    `fixed_thruster`, `tunnel_thruster`, `azimuth_thruster`, `rudder` and `propeller_with_rudder`
    create one.

    Attributes:
        name: Name in messages and tables.
        column: Force X, Y [N] and moment N [N m] per unit of the command of a thruster that cannot
            turn; not used for one that turns.
        x: Place of a thruster that turns, ahead of the origin [m].
        y: Place of it to starboard of the origin [m].
        low: Smallest thrust [N], negative astern, or smallest angle of a rudder [rad].
        high: Largest thrust [N], or largest angle of a rudder [rad].
        turns: Whether the direction of the thrust can be turned.
        angle_low: Smallest direction [rad], 0 ahead, positive to starboard; -inf if it turns all
            round.
        angle_high: Largest direction [rad]; inf if it turns all round.
        rate: Largest rate of the thrust [N/s] or of a rudder [rad/s].
        angle_rate: Largest rate of the direction [rad/s].
        weight: Cost of its squared thrust relative to its largest thrust. 1 is usual; a thruster
            with a larger weight is used less.
    """

    name: str
    column: tuple[float, float, float] = (0.0, 0.0, 0.0)
    x: float = 0.0
    y: float = 0.0
    low: float = 0.0
    high: float = 0.0
    turns: bool = False
    angle_low: float = -inf
    angle_high: float = inf
    rate: float = inf
    angle_rate: float = inf
    weight: float = 1.0

    def __post_init__(self) -> None:
        """Check the limits.

        Raises:
            BadInput: The thrust range does not include 0 or is empty, or a limit is not allowed.
        """
        if not self.low <= 0.0 <= self.high or self.low == self.high:
            raise BadInput(
                f"thruster {self.name}: thrust {self.low:g} to {self.high:g}; allowed is a range "
                "that includes 0"
            )
        if not self.angle_low < self.angle_high:
            raise BadInput(
                f"thruster {self.name}: angle {self.angle_low:g} to {self.angle_high:g} rad; "
                "allowed is a lower and an upper limit"
            )
        for name in ("rate", "angle_rate", "weight"):
            if not getattr(self, name) > 0.0:
                raise BadInput(
                    f"thruster {self.name}: {name} = {getattr(self, name):g}; allowed is more "
                    "than 0"
                )

    @property
    def largest(self) -> float:
        """Largest magnitude of the thrust [N] or of the angle of a rudder [rad]."""
        return max(self.high, -self.low)

    @property
    def turns_all_round(self) -> bool:
        """Whether the direction of the thrust is not limited."""
        return self.turns and self.angle_high - self.angle_low >= FULL_TURN

    def effect(self, angle: float) -> tuple[float, float, float]:
        """Return force X, Y [N] and moment N [N m] per unit of thrust.

        Args:
            angle: Direction of the thrust [rad]; not used by a thruster that cannot turn.
        """
        if not self.turns:
            return self.column
        c, s = cos(angle), sin(angle)
        return c, s, self.x * s - self.y * c


def fixed_thruster(
    name: str, x: float, y: float, low: float, high: float, angle: float = 0.0, rate: float = inf
) -> Thruster:
    """Return a thruster whose direction is fixed.

    Args:
        name: Its name.
        x: Place ahead of the origin [m].
        y: Place to starboard of the origin [m].
        low: Smallest thrust [N], negative astern.
        high: Largest thrust [N].
        angle: Direction of the thrust [rad], 0 ahead, positive to starboard.
        rate: Largest rate of the thrust [N/s].

    Raises:
        BadInput: A limit is not allowed.
    """
    c, s = cos(angle), sin(angle)
    return Thruster(name, (c, s, x * s - y * c), x, y, low, high, rate=rate)


def tunnel_thruster(name: str, x: float, low: float, high: float, rate: float = inf) -> Thruster:
    """Return a tunnel thruster, which pushes to starboard with a positive thrust.

    Args:
        name: Its name.
        x: Place ahead of the origin [m].
        low: Smallest thrust [N].
        high: Largest thrust [N].
        rate: Largest rate of the thrust [N/s].

    Raises:
        BadInput: A limit is not allowed.
    """
    column = (0.0, 1.0, x)
    return Thruster(name, column, x, 0.0, low, high, rate=rate)


def azimuth_thruster(
    name: str,
    x: float,
    y: float,
    high: float,
    angle_low: float = -inf,
    angle_high: float = inf,
    rate: float = inf,
    angle_rate: float = inf,
    low: float = 0.0,
) -> Thruster:
    """Return a thruster that turns, all round or within limits.

    Args:
        name: Its name.
        x: Place ahead of the origin [m].
        y: Place to starboard of the origin [m].
        high: Largest thrust [N].
        angle_low: Smallest direction [rad].
        angle_high: Largest direction [rad].
        rate: Largest rate of the thrust [N/s].
        angle_rate: Largest rate of the direction [rad/s].
        low: Smallest thrust [N], negative for a thruster that also runs astern.

    Raises:
        BadInput: A limit is not allowed.
    """
    return Thruster(
        name,
        (0.0, 0.0, 0.0),
        x,
        y,
        low,
        high,
        True,
        angle_low,
        angle_high,
        rate,
        angle_rate,
    )


def rudder(name: str, sway: float, yaw: float, largest: float, rate: float = inf) -> Thruster:
    """Return a rudder whose force is proportional to its angle.

    Args:
        name: Its name.
        sway: Side force per angle [N/rad].
        yaw: Yaw moment per angle [N m/rad].
        largest: Largest angle to either side [rad].
        rate: Largest rate of the angle [rad/s].

    Raises:
        BadInput: A limit is not allowed.
    """
    return Thruster(name, (0.0, sway, yaw), 0.0, 0.0, -largest, largest, rate=rate)


def propeller_with_rudder(
    name: str,
    x: float,
    y: float,
    high: float,
    lift: float,
    largest: float,
    rate: float = inf,
    angle_rate: float = inf,
) -> Thruster:
    """Return a propeller ahead with a rudder in its race, as a thruster that turns in a sector.

    The rudder deflects the race: side force over thrust is `lift` times the rudder angle, so that
    the force lies within atan(lift largest) of ahead. The rudder has no effect without thrust.

    K.-P. Lindegaard, T. I. Fossen, Fuel-efficient rudder and propeller control allocation for
    marine craft, IEEE Trans. Control Systems Technology 11, 2003.

    Args:
        name: Its name.
        x: Place of the rudder ahead of the origin [m].
        y: Place to starboard of the origin [m].
        high: Largest thrust ahead [N].
        lift: Side force per thrust and rudder angle [1/rad].
        largest: Largest rudder angle to either side [rad].
        rate: Largest rate of the thrust [N/s].
        angle_rate: Largest rate of the direction of the force [rad/s].

    Raises:
        BadInput: A limit is not allowed.
    """
    sector = atan(lift * largest)
    return azimuth_thruster(name, x, y, high, -sector, sector, rate, angle_rate)


class Setting(NamedTuple):
    """Thrusts and directions of all thrusters.

    A rudder's angle is its thrust [rad]; thrusters that cannot turn have the direction 0.
    """

    thrust: Array  # (n,) [N]
    angle: Array  # (n,) [rad]


class Allocation(NamedTuple):
    """Result of a control allocation."""

    setting: Setting
    force: Array  # (3,) X, Y [N] and N [N m] that the thrusters give
    cost: float  # squared missing force and squared thrust, relative to full thrust


class Sector(NamedTuple):
    """Convex part of the range of a thrust vector: a sector of a circle of at most half a turn."""

    begin: float  # [rad]
    end: float  # [rad]; both infinite for the whole circle
    largest: float  # [N]
    sign: float  # -1 for thrust astern


def sectors(thruster: Thruster) -> list[Sector]:
    """Return the convex sectors that together are the range of the thrust vector of a thruster.

    Args:
        thruster: A thruster that turns.
    """
    if thruster.turns_all_round:
        return [Sector(-inf, inf, thruster.largest, 1.0)]
    width = thruster.angle_high - thruster.angle_low
    parts = ceil(width / pi - 1e-9)
    found = []
    for sign, largest in ((1.0, thruster.high), (-1.0, -thruster.low)):
        for k in range(parts):
            if largest > 0.0:
                begin = thruster.angle_low + k * width / parts
                begin += 0.0 if sign > 0.0 else pi
                found.append(Sector(begin, begin + width / parts, largest, sign))
    return found


@compiled
def solve_static(
    effects: Array,
    weights: Array,
    demand: Array,
    kinds: Array,
    lows: Array,
    highs: Array,
    begins: Array,
    ends: Array,
) -> tuple[Array, float]:
    """Return the optimal thrust components of fixed and turning thrusters, and the cost.

    All quantities are relative to full thrust. A thruster that turns has two components, and the
    circle of its largest thrust is approximated by tangents, which are added at each solution until
    the solution lies on the circle.

    Args:
        effects: Force and moment per component (3, n).
        weights: Cost of each squared component (n,).
        demand: Force and moment (3,), each with its own weight DEMAND.
        kinds: 0 for a fixed thruster, 1 and 2 for the components of one that turns (n,).
        lows: Lower limits of the components (n,), for fixed thrusters.
        highs: Upper limits of the components or of the length of the thrust vector (n,).
        begins: Begin of the sector [rad] (n,).
        ends: End of the sector [rad] (n,).

    Returns:
        Components (n,) and the cost.
    """
    n = len(weights)
    hessian, gradient = np.zeros((n, n)), np.zeros(n)
    for i in range(n):
        hessian[i, i] = 2.0 * weights[i]
        for axis in range(3):
            gradient[i] -= 2.0 * DEMAND * effects[axis, i] * demand[axis]
            for j in range(n):
                hessian[i, j] += 2.0 * DEMAND * effects[axis, i] * effects[axis, j]
    rows = np.zeros((n * (FEWEST_TANGENTS + 2 + MOST_CUTS), n))
    bounds = np.zeros(len(rows))
    count = 0
    for i in range(n):
        if kinds[i] == 0.0:
            rows[count, i], bounds[count] = 1.0, highs[i]
            rows[count + 1, i], bounds[count + 1] = -1.0, -lows[i]
            count += 2
        elif kinds[i] == 1.0:
            for k in range(FEWEST_TANGENTS):
                angle = 2.0 * pi * k / FEWEST_TANGENTS
                rows[count, i], rows[count, i + 1] = cos(angle), sin(angle)
                bounds[count] = highs[i]
                count += 1
            if np.isfinite(begins[i]):
                rows[count, i], rows[count, i + 1] = sin(begins[i]), -cos(begins[i])
                rows[count + 1, i], rows[count + 1, i + 1] = -sin(ends[i]), cos(ends[i])
                count += 2
    x = np.zeros(n)
    for _ in range(MOST_CUTS):
        x, _ = solve_quadratic_program(hessian, gradient, rows[:count], bounds[:count])
        found = False
        for i in range(n):
            if kinds[i] == 1.0:
                length = sqrt(x[i] * x[i] + x[i + 1] * x[i + 1])
                if length > highs[i] * (1.0 + ROUND):
                    rows[count, i], rows[count, i + 1] = x[i] / length, x[i + 1] / length
                    bounds[count] = highs[i]
                    count += 1
                    found = True
        if not found:
            break
    for i in range(n):
        if kinds[i] == 1.0:
            length = sqrt(x[i] * x[i] + x[i + 1] * x[i + 1])
            if length > highs[i]:
                x[i] *= highs[i] / length
                x[i + 1] *= highs[i] / length
        elif kinds[i] == 0.0:
            x[i] = min(max(x[i], lows[i]), highs[i])
    cost = 0.0
    for axis in range(3):
        missing = demand[axis]
        for i in range(n):
            missing -= effects[axis, i] * x[i]
        cost += DEMAND * missing * missing
    for i in range(n):
        cost += weights[i] * x[i] * x[i]
    return x, cost


class ThrustAllocator:
    """Distributes a force and moment to thrusters such that the cost is smallest.

    The cost is the squared missing force and moment, weighted by axis, and far below it the squared
    thrusts relative to the largest ones, weighted by thruster.

    Attributes:
        thrusters: The thrusters.
    """

    def __init__(
        self,
        thrusters: Sequence[Thruster],
        priorities: tuple[float, float, float] = (1.0, 1.0, 1.0),
        singularity: float = 0.0,
        calm: float = 0.0,
    ) -> None:
        """Prepare the allocation to a set of thrusters.

        Args:
            thrusters: The thrusters.
            priorities: Weights of a missing surge force, sway force and yaw moment, which count if
                the demand is not attainable.
            singularity: Cost of a singular configuration, in which the directions of the thrusters
                leave an axis without force; with less than three thrusters all are singular. It
                keeps directions apart in steps; 0.1 to 10 is usual, 0 for none. 1 equals that of
                directions 1 rad from the optimal ones.
            calm: Share of its largest thrust below which a thruster turns towards the optimal
                direction in proportion to its thrust. It keeps thrusters that are nearly idle from
                turning to and fro; 0 for none.

        Raises:
            BadInput: There is no thruster, or a weight is not positive.
        """
        if not thrusters:
            raise BadInput("a thrust allocation needs at least one thruster")
        if not all(weight > 0.0 for weight in priorities):
            raise BadInput(f"priorities = {priorities}; allowed are three numbers above 0")
        if not singularity >= 0.0:
            raise BadInput(f"singularity = {singularity:g}; allowed is 0 or more")
        self.thrusters = tuple(thrusters)
        if not calm >= 0.0:
            raise BadInput(f"calm = {calm:g}; allowed is 0 or more")
        self.singularity = singularity
        self.calm = calm
        forces, levers = [], []
        for one in self.thrusters:
            X, Y, N = one.column
            force = one.largest * (1.0 if one.turns else hypot(X, Y))
            forces.append(force)
            moment = force * hypot(one.x, one.y) if one.turns else one.largest * abs(N)
            levers.append(moment)
        #: full thrust [N] and a moment [N m] to which all forces and moments are related
        self.full_thrust = sum(forces)
        moment = sum(levers)
        if moment <= 0.0:
            moment = self.full_thrust  # thrusters at the origin: a lever of 1 m
        self.scale = np.array([self.full_thrust, self.full_thrust, moment])
        self._importance = np.sqrt(np.array(priorities))
        self._largest = np.array([one.largest for one in self.thrusters])
        self._turns = np.array([one.turns for one in self.thrusters])
        self._weights = np.array([one.weight for one in self.thrusters])
        self._low = np.array([one.low for one in self.thrusters])
        self._high = np.array([one.high for one in self.thrusters])
        self._rate = np.array([one.rate for one in self.thrusters])
        self._angle_rate = np.array([one.angle_rate for one in self.thrusters])
        self._sectors = [sectors(one) if one.turns else [None] for one in self.thrusters]
        combinations = 1
        for options in self._sectors:
            combinations *= len(options)
        if combinations > MOST_SECTORS:
            raise BadInput(
                f"the directions of the thrusters form {combinations} combinations of sectors; "
                f"allowed are {MOST_SECTORS}"
            )
        self._chosen: tuple[int, ...] | None = None
        self._setting = self.neutral_setting()

    @property
    def setting(self) -> Setting:
        """Thrusts and directions after the last step."""
        return self._setting

    def neutral_setting(self) -> Setting:
        """Return the setting without thrust; directions are those nearest to ahead."""
        angles = []
        for one in self.thrusters:
            angles.append(clip(0.0, one.angle_low, one.angle_high) if one.turns else 0.0)
        return Setting(np.zeros(len(angles)), np.array(angles))

    def reset(self, setting: Setting | None = None) -> None:
        """Begin at a setting, by default without thrust.

        Args:
            setting: Thrusts and directions.
        """
        self._setting = setting or self.neutral_setting()
        self._chosen = None

    def force(self, setting: Setting) -> Array:
        """Return force X, Y [N] and moment N [N m] (3,) that the thrusters give at a setting.

        Args:
            setting: Thrusts and directions.
        """
        return self._effects(setting.angle) @ setting.thrust

    def optimum(self, demand: Array) -> Allocation:
        """Return the optimal setting for a demand, whatever the present one is.

        Rates do not count. Directions of thrusters without thrust are the present ones.

        Args:
            demand: X, Y [N] and N [N m] (3,).
        """
        demand = np.asarray(demand, float)
        best: tuple[float, tuple[int, ...], Array, Array] | None = None
        for choice in product(*(range(len(options)) for options in self._sectors)):
            x, cost, thrust, angle = self._solve_choice(demand, choice)
            held = cost * (1.0 - HYSTERESIS) if choice == self._chosen else cost
            if best is None or held < best[0]:
                best = held, choice, thrust, angle
                final = cost
        assert best is not None
        self._chosen = best[1]
        setting = Setting(best[2], best[3])
        return Allocation(setting, self.force(setting), final)

    def step(self, demand: Array, period: float) -> Allocation:
        """Advance thrusts and directions by one period towards the optimum, within their rates.

        Args:
            demand: X, Y [N] and N [N m] (3,).
            period: Length of the period [s].
        """
        target = self.optimum(demand)
        now = self._setting
        room, turn = self._rate * period, self._angle_rate * period
        low, high = (
            np.maximum(self._low, now.thrust - room),
            np.minimum(self._high, now.thrust + room),
        )
        angle_low, angle_high = now.angle - turn, now.angle + turn
        aim = target.setting.angle.copy()
        for i, one in enumerate(self.thrusters):
            if one.turns_all_round:
                aim[i] = now.angle[i] + wrap(aim[i] - now.angle[i])
            elif one.turns:
                angle_low[i] = max(angle_low[i], one.angle_low)
                angle_high[i] = min(angle_high[i], one.angle_high)
        if self.calm > 0.0:
            share = np.abs(target.setting.thrust) / (self.calm * self._largest)
            aim = now.angle + np.minimum(share, 1.0) * (aim - now.angle)
        thrust = np.clip(target.setting.thrust, low, high)
        angle = np.where(self._turns, np.clip(aim, angle_low, angle_high), 0.0)
        reached = np.array_equal(thrust, target.setting.thrust) and np.array_equal(angle, aim)
        if self.calm > 0.0 or not reached or self.singularity > 0.0:
            for _ in range(REPEATS):
                thrust, angle = self._linearised_step(
                    np.asarray(demand, float),
                    Setting(thrust, angle),
                    Setting(target.setting.thrust, aim),
                    (low, high),
                    (angle_low, angle_high),
                )
        self._setting = Setting(thrust, angle)
        return Allocation(self._setting, self.force(self._setting), target.cost)

    def _effects(self, angle: Array) -> Array:
        """Force and moment per unit of thrust (3, n)."""
        columns = [one.effect(a) for one, a in zip(self.thrusters, angle.tolist(), strict=True)]
        return np.array(columns).T

    def _solve_choice(
        self, demand: Array, choice: tuple[int, ...]
    ) -> tuple[Array, float, Array, Array]:
        """Optimum in one combination of sectors: components, cost, thrusts and directions."""
        columns, rows = [], []
        for i, one in enumerate(self.thrusters):
            sector = self._sectors[i][choice[i]]
            weight = one.weight
            if sector is None:
                columns.append(one.largest * np.array(one.column))
                rows.append((0.0, one.low / one.largest, one.high / one.largest, 0.0, 0.0, weight))
                continue
            for kind, angle in ((1.0, 0.0), (2.0, 0.5 * pi)):
                columns.append(one.largest * np.array(one.effect(angle)))
                largest = sector.largest / one.largest
                rows.append((kind, 0.0, largest, sector.begin, sector.end, weight))
        kinds, lows, highs, begins, ends, weights = np.array(rows, float).T
        scale = self._importance / self.scale
        effects = np.ascontiguousarray(scale[:, None] * np.array(columns).T)
        given = (weights.copy(), scale * demand, kinds.copy(), lows.copy(), highs.copy())
        x, cost = solve_static(effects, *given, begins.copy(), ends.copy())
        thrust, direction = np.zeros(len(self.thrusters)), self._setting.angle.copy()
        at = 0
        for i, one in enumerate(self.thrusters):
            sector = self._sectors[i][choice[i]]
            if sector is None:
                thrust[i] = one.largest * x[at]
                at += 1
                continue
            length = hypot(x[at], x[at + 1])
            thrust[i] = sector.sign * one.largest * length
            if length > IDLE:
                direction[i] = _direction(one, sector, atan2(x[at + 1], x[at]))
            at += 2
        return x, cost, thrust, direction

    def _linearised_step(
        self,
        demand: Array,
        near: Setting,
        target: Setting,
        thrusts: tuple[Array, Array],
        angles: tuple[Array, Array],
    ) -> tuple[Array, Array]:
        """Optimal thrusts and directions within limits, linearised about a setting.

        The variables are the changes of the thrusts relative to the largest ones and those of the
        directions of thrusters that turn [rad].
        """
        n, turning = len(self.thrusters), np.flatnonzero(self._turns)
        scale = self._importance / self.scale
        effects = self._effects(near.angle)
        slopes = self._effects(near.angle + 0.5 * pi)[:, turning] * near.thrust[turning]
        jacobian = scale[:, None] * np.hstack([effects * self._largest, slopes])
        missing = scale * (demand - effects @ near.thrust)
        cost = APPROACH * np.concatenate([self._weights, np.ones(len(turning))])
        offset = np.concatenate(
            [
                (target.thrust - near.thrust) / self._largest,
                (target.angle - near.angle)[turning],
            ]
        )
        hessian = 2.0 * DEMAND * jacobian.T @ jacobian + 2.0 * np.diag(cost)
        gradient = -2.0 * DEMAND * jacobian.T @ missing - 2.0 * cost * offset
        if self.singularity > 0.0:
            gradient[n:] += APPROACH * self.singularity * self._singularity_slopes(near, turning)
        low = [(thrusts[0] - near.thrust) / self._largest, (angles[0] - near.angle)[turning]]
        high = [(thrusts[1] - near.thrust) / self._largest, (angles[1] - near.angle)[turning]]
        lowest, highest = np.concatenate(low), np.concatenate(high)
        size = len(lowest)
        rows = np.vstack([np.eye(size), -np.eye(size)])
        bounds = np.concatenate([highest, -lowest])
        finite = np.isfinite(bounds)
        change, _ = solve_quadratic_program(
            hessian, gradient, np.ascontiguousarray(rows[finite]), bounds[finite]
        )
        change = np.clip(change, lowest, highest)
        thrust = np.clip(near.thrust + change[:n] * self._largest, *thrusts)
        angle = near.angle.copy()
        angle[turning] = np.clip(
            near.angle[turning] + change[n:], angles[0][turning], angles[1][turning]
        )
        return thrust, angle

    def singularity_cost(self, angle: Array) -> float:
        """Return the cost of the directions of the thrusters, large near a singular configuration.

        It is 1 / (e + det(B B')) with the effects B relative to full thrust, scaled to 0 .. 1.

        Args:
            angle: Directions [rad] (n,).
        """
        effects = self._effects(angle) * self._largest / self.scale[:, None]
        share = float(np.linalg.det(effects @ effects.T))
        return NEAR_SINGULAR / (NEAR_SINGULAR + max(share, 0.0))

    def _singularity_slopes(self, near: Setting, turning: NDArray[np.int64]) -> Array:
        """Derivative of the cost of a singular configuration by the directions of `turning`."""
        slopes = []
        apart = near.angle.copy()
        apart[turning] += APART * (-1.0) ** np.arange(len(turning))
        for i in turning.tolist():
            costs = []
            for step in (ANGLE_STEP, -ANGLE_STEP):
                angle = apart.copy()
                angle[i] += step
                costs.append(self.singularity_cost(angle))
            slopes.append((costs[0] - costs[1]) / (2.0 * ANGLE_STEP))
        return np.array(slopes)


def _direction(one: Thruster, sector: Sector, angle: float) -> float:
    """Direction of a thruster for the angle of its thrust vector, within its range."""
    if one.turns_all_round:
        return angle
    middle = 0.5 * (one.angle_low + one.angle_high)
    if sector.sign < 0.0:
        angle -= pi
    return clip(middle + wrap(angle - middle), one.angle_low, one.angle_high)


def with_weights(thrusters: Sequence[Thruster], weights: dict[str, float]) -> list[Thruster]:
    """Return thrusters with other weights.

    Args:
        thrusters: The thrusters.
        weights: Weight by name of the thruster.

    Raises:
        BadInput: There is no such thruster, or a weight is not positive.
    """
    names = [one.name for one in thrusters]
    for name in weights:
        if name not in names:
            raise BadInput(unknown_name_message("thruster", name, names))
    return [replace(one, weight=weights.get(one.name, one.weight)) for one in thrusters]
