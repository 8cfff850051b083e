"""Regions of the state in which a force may be missing, each with the shapes of that force.

A shape is a force over time, known up to a factor.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import exp

import numpy as np

from boatsim.diagnosis.config import LocateConfig
from boatsim.diagnosis.filter import MappedRecording, dof_in_state_order
from boatsim.diagnosis.locate.nominal_forces import actuator_states, body_forces
from boatsim.physics.base import Array
from boatsim.physics.effects.wall_effect import REACH
from boatsim.physics.signals import PLANAR_DOF, ROTATIONS

THRUST = "thrust"  # role of actuators whose value is a force
FORWARD_SPEED = "forward_speed_mps"  # fact of a recording in which the hull only rolls


@dataclass(frozen=True)
class RegionCandidate:
    """A condition under which a force may be missing, such as thrust astern or nearness to a wall.

    It holds the shapes over time that such a force would have in a recording.
    """

    variable: str
    shapes: tuple[Array, ...]  # each (N, axes) [N, N m per factor]
    sentence: Callable[[Array], str]  # statement about the fitted factors


def region_candidates(
    mapped: MappedRecording, states: Array, damping: Array, config: LocateConfig
) -> list[RegionCandidate]:
    """Return all conditions under which a force may be missing that can be tested on a recording.

    Conditions are a direction in the earth frame, high speed, thrust astern, play of the rudder,
    roll and nearness to a wall.

    Args:
        mapped: The mapped recording.
        states: Smoothed states (N, 2 NQ).
        damping: Damping force (N, axes) of the vessel as specified.
        config: Settings for locating a missing force.
    """
    axes = dof_in_state_order(mapped.program.vessel)
    return [
        *_earth_directions(axes, states),
        *_squared_speeds(mapped, axes, states),
        *_thrust_astern(mapped),
        *_steering_play(mapped, config),
        *_roll(mapped, axes, states),
        *_walls(mapped, axes, states, damping, config),
    ]


def _earth_directions(axes: tuple[str, ...], states: Array) -> Iterator[RegionCandidate]:
    """A force of constant direction in the earth frame."""
    if set(axes) >= PLANAR_DOF:
        unit = np.eye(len(axes))
        surge = unit[axes.index("surge")]
        sway = unit[axes.index("sway")]
        c = np.cos(states[:, axes.index("yaw")])
        s = np.sin(states[:, axes.index("yaw")])
        north = np.outer(c, surge) - np.outer(s, sway)
        east = np.outer(s, surge) + np.outer(c, sway)
        yield RegionCandidate("heading in the world", (north, east), _direction_sentence)


def _squared_speeds(
    mapped: MappedRecording, axes: tuple[str, ...], states: Array
) -> Iterator[RegionCandidate]:
    """The square of each speed."""
    rates = mapped.program.to_body_velocities(states)[:, len(axes) :]
    for i, name in enumerate(axes):
        noun = "rate" if name in ROTATIONS and len(axes) == 1 else "speed"
        variable = f"{name} {noun}"
        w = rates[:, i]
        shape = np.outer(w * np.abs(w), np.eye(len(axes))[i])
        yield RegionCandidate(variable, (shape,), _square_sentence(variable))


def _roll(
    mapped: MappedRecording, axes: tuple[str, ...], states: Array
) -> Iterator[RegionCandidate]:
    """Large roll angles, and the forward speed of a hull that only rolls."""
    if "roll" not in axes:
        return
    i = axes.index("roll")
    unit = np.eye(len(axes))[i]
    angle = states[:, i]
    rate = states[:, len(axes) + i]
    yield RegionCandidate("roll angle", (np.outer(angle**3, unit),), _cube_sentence)
    if FORWARD_SPEED in mapped.facts and "surge" not in axes:
        shape = np.outer(rate * float(mapped.facts[FORWARD_SPEED]), unit)
        yield RegionCandidate("forward speed", (shape,), _forward_speed_sentence)


def _thrust_astern(mapped: MappedRecording) -> Iterator[RegionCandidate]:
    """The force of thrusters that push astern."""
    vessel = mapped.program.vessel
    thrusters = [i for i, a in enumerate(vessel.actuators) if vessel.roles[a] == THRUST]
    if not thrusters:
        return
    idle = actuator_states(mapped)
    astern = idle.copy()
    astern[:, thrusters] = np.minimum(astern[:, thrusters], 0.0)
    idle[:, thrusters] = 0.0
    shape = _force_at_rest(mapped, astern) - _force_at_rest(mapped, idle)
    yield RegionCandidate("thrust astern", (shape,), _thrust_sentence)


def _steering_play(mapped: MappedRecording, config: LocateConfig) -> Iterator[RegionCandidate]:
    """The force missing while steering angles lag after a reversal (play operator)."""
    vessel = mapped.program.vessel
    angles = list(map(vessel.actuators.index, vessel.angles))
    if not angles:
        return
    play = config.play_width
    held = actuator_states(mapped)
    lagging = held.copy()
    for row in range(1, len(held)):
        low = held[row, angles] - play / 2
        high = held[row, angles] + play / 2
        lagging[row, angles] = np.clip(lagging[row - 1, angles], low, high)
    for angle, column in zip(vessel.angles, angles, strict=True):
        lagging[:, vessel.law_signals.index(f"cos_{angle}")] = np.cos(lagging[:, column])
        lagging[:, vessel.law_signals.index(f"sin_{angle}")] = np.sin(lagging[:, column])
    shape = (_force_at_rest(mapped, lagging) - _force_at_rest(mapped, held)) / play
    yield RegionCandidate("steering reversals", (shape,), _play_sentence)


def _force_at_rest(mapped: MappedRecording, held: Array) -> Array:
    """(N, axes) force of the vessel at rest with actuator states (N, HELD)."""
    rest = np.zeros((len(held), 2 * mapped.program.module.NQ))
    return body_forces(mapped, rest, held, mapped.values)


def _walls(
    mapped: MappedRecording,
    axes: tuple[str, ...],
    states: Array,
    damping: Array,
    config: LocateConfig,
) -> Iterator[RegionCandidate]:
    """Attraction to the walls, and damping that increases near them."""
    walls = tank_walls(mapped)
    if walls is None or not set(axes) >= PLANAR_DOF:
        return
    reach = REACH * mapped.program.vessel.length
    x_low, x_high, y_low, y_high = walls
    position = states[:, :2]
    high = _proximity(np.array([x_high, y_high]) - position, reach, config)
    low = _proximity(position - np.array([x_low, y_low]), reach, config)
    c = np.cos(states[:, axes.index("yaw")])
    s = np.sin(states[:, axes.index("yaw")])
    north, east = (high - low).T
    attraction = np.zeros((len(states), len(axes)))
    attraction[:, 0] = c * north + s * east
    attraction[:, 1] = c * east - s * north
    near = (high + low).sum(axis=1, keepdims=True)
    sentence = _wall_sentence(reach, 1.0 - exp(-config.wall_range))
    yield RegionCandidate("distance to the walls", (attraction, near * damping), sentence)


def _proximity(distance: Array, reach: float, config: LocateConfig) -> Array:
    """Exponential decrease with the distance [m] to a wall, zero beyond the range of walls."""
    decay = np.exp(-np.maximum(distance, 0.0) / reach)
    return np.asarray(np.maximum(decay - exp(-config.wall_range), 0.0))


def tank_walls(mapped: MappedRecording) -> tuple[float, ...] | None:
    """Return the walls of the tank in a recording as x_low, x_high, y_low, y_high [m].

    None is returned if the facts do not specify them.
    """
    if "walls_m" not in mapped.facts:
        return None
    return tuple(mapped.facts["walls_m"])


def _direction_sentence(factors: Array) -> str:
    size = float(np.hypot(*factors))
    toward = float(np.degrees(np.arctan2(factors[1], factors[0]))) % 360.0
    return (
        "the missing force has a constant direction in the earth frame: "
        f"{size:.2g} N toward {toward:.0f} deg"
    )


def _square_sentence(variable: str) -> Callable[[Array], str]:
    noun = "moment" if variable.startswith(("yaw", "roll")) else "force"

    def square_term_sentence(factors: Array) -> str:
        return f"the missing {noun} {_verb(factors[0])} with the square of the {variable}"

    return square_term_sentence


def _cube_sentence(factors: Array) -> str:
    adjective = "softer" if factors[0] > 0.0 else "stiffer"
    return (
        f"the hull is {adjective} at large roll angles: the missing moment grows with the cube of "
        "the roll angle"
    )


def _forward_speed_sentence(factors: Array) -> str:
    return (
        f"the missing moment {_verb(factors[0])} with the roll rate, in proportion to the forward "
        "speed"
    )


def _verb(factor: float) -> str:
    return "resists" if factor < 0.0 else "pushes"


def _thrust_sentence(factors: Array) -> str:
    verb = "is missing" if factors[0] < 0 else "is added"
    share = abs(100.0 * factors[0])
    return f"while thrust is astern, about {share:.0f} % of the commanded thrust {verb}"


def _play_sentence(factors: Array) -> str:
    play = factors[0]
    if play < 0:
        return (
            f"after a reversal, the steering angle is ahead by {-play:.2g} rad, which no play "
            "explains"
        )
    return f"after a reversal, the steering angle lags as with {play:.2g} rad of play"


def _wall_sentence(reach: float, at_wall: float) -> Callable[[Array], str]:
    """Statement about walls; `at_wall` is the proximity of a boat at a wall."""

    def wall_force_sentence(factors: Array) -> str:
        attraction, increase = factors * at_wall
        comparative = "more" if increase > 0.0 else "less"
        direction = "towards" if attraction > 0.0 else "away from"
        return (
            f"within about {reach:.2g} m of a wall, damping is up to {abs(100.0 * increase):.0f} % "
            f"{comparative}, and the boat is pushed {direction} it by up to {abs(attraction):.2g} N"
        )

    return wall_force_sentence
