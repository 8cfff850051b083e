"""What a missing force may depend on: each idea is what the force would be there up to factors, and how to say it."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import exp

import numpy as np

from boatsim.diagnosis.filter import MappedRecording, axes_of
from boatsim.diagnosis.locate.nominal_forces import actuators, along
from boatsim.physics.base import Array
from boatsim.physics.effects.wall_effect import REACH

THRUST = "thrust"  # role of actuators whose value is a force
# [rad] between a steering command and the angle it stands for; the force hardly depends on it
# beyond scale
PLAY = 0.1
NEAR = 2.0  # [reaches] beyond which a wall is taken to do nothing
TURNING = ("roll", "pitch", "yaw")
SPEED = "forward_speed_mps"  # fact of a recording in which the hull only rolls


@dataclass(frozen=True)
class Idea:
    """One explanation tried."""

    variable: str
    shapes: tuple[Array, ...]  # each (N, axes) [N, N m per factor]
    sentence: Callable[[Array], str]  # of the fitted factors


def ideas(track: MappedRecording, states: Array, damping: Array) -> list[Idea]:
    """Everything tried on a run; `states` (N, 2 NQ) are smoothed, `damping` (N, axes) is the vessel's own."""
    axes = axes_of(track.program.vessel)
    found = [
        *_world(axes, states),
        *_speeds(track, axes, states),
        *_astern(track),
        *_reversals(track),
    ]
    if "roll" in axes:
        found += _rolling(track, axes, states)
    return [*found, *_walls(track, axes, states, damping)]


def _world(axes: tuple[str, ...], states: Array) -> Iterator[Idea]:
    """A direction of the world."""
    if {"surge", "sway", "yaw"} <= set(axes):
        shape = np.eye(len(axes))
        psi = states[:, axes.index("yaw")]
        ahead, aside, c, s = (
            shape[axes.index("surge")],
            shape[axes.index("sway")],
            np.cos(psi),
            np.sin(psi),
        )
        shapes = np.outer(c, ahead) - np.outer(s, aside), np.outer(s, ahead) + np.outer(c, aside)
        yield Idea("heading in the world", shapes, _direction)


def _speeds(track: MappedRecording, axes: tuple[str, ...], states: Array) -> Iterator[Idea]:
    """The square of each speed."""
    rates = track.program.body_rates(states)[:, len(axes) :]
    for i, name in enumerate(axes):
        variable = f"{name} {'rate' if name in TURNING and len(axes) == 1 else 'speed'}"
        w = rates[:, i]
        yield Idea(variable, (np.outer(w * np.abs(w), np.eye(len(axes))[i]),), _square(variable))


def _rolling(track: MappedRecording, axes: tuple[str, ...], states: Array) -> Iterator[Idea]:
    """Amplitude of roll, and the forward speed at which a hull that only rolls does so."""
    shape, i = np.eye(len(axes))[axes.index("roll")], axes.index("roll")
    angle, rate = states[:, i], states[:, len(axes) + i]
    yield Idea("roll angle", (np.outer(angle**3, shape),), _cube)
    if SPEED in track.facts and "surge" not in axes:
        yield Idea("forward speed", (np.outer(rate * float(track.facts[SPEED]), shape),), _forward)


def _astern(track: MappedRecording) -> Iterator[Idea]:
    """Force of the thrusters that push astern."""
    vessel = track.program.vessel
    thrusters = [i for i, a in enumerate(vessel.actuators) if vessel.roles[a] == THRUST]
    if not thrusters:
        return
    idle = actuators(track)
    back = idle.copy()
    back[:, thrusters] = np.minimum(back[:, thrusters], 0.0)
    idle[:, thrusters] = 0.0
    yield Idea("thrust astern", (_at_rest(track, back) - _at_rest(track, idle),), _thrust)


def _reversals(track: MappedRecording) -> Iterator[Idea]:
    """Force that is missing while the angles stay behind a steering that has reversed (play operator)."""
    vessel = track.program.vessel
    angles = [vessel.actuators.index(a) for a in vessel.angles]
    if not angles:
        return
    held = actuators(track)
    late = held.copy()
    for row in range(1, len(held)):
        late[row, angles] = np.clip(
            late[row - 1, angles], held[row, angles] - PLAY / 2, held[row, angles] + PLAY / 2
        )
    for angle, column in zip(vessel.angles, angles, strict=True):
        for part, of in (("cos", np.cos), ("sin", np.sin)):
            late[:, vessel.held.index(f"{part}_{angle}")] = of(late[:, column])
    yield Idea(
        "steering reversals", ((_at_rest(track, late) - _at_rest(track, held)) / PLAY,), _play
    )


def _at_rest(track: MappedRecording, held: Array) -> Array:
    """(N, axes) force of the vessel at rest with given actuators."""
    still = np.zeros((len(held), 2 * track.program.module.NQ))
    return along(track, still, held, track.values)


def _walls(
    track: MappedRecording, axes: tuple[str, ...], states: Array, damping: Array
) -> Iterator[Idea]:
    """Pull towards the walls and damping that rises near them."""
    walls = walls_of(track)
    if walls is None or not {"surge", "sway", "yaw"} <= set(axes):
        return
    reach = REACH * track.program.vessel.length
    high, low = (
        np.maximum(
            np.exp(-np.maximum(side * (np.array(walls)[ends] - states[:, :2]), 0.0) / reach)
            - exp(-NEAR),
            0.0,
        )
        for side, ends in ((1.0, [1, 3]), (-1.0, [0, 2]))
    )
    c, s = np.cos(states[:, axes.index("yaw")]), np.sin(states[:, axes.index("yaw")])
    north, east = (high - low).T
    pull = np.zeros((len(states), len(axes)))
    pull[:, 0], pull[:, 1] = c * north + s * east, c * east - s * north
    near = (high + low).sum(axis=1, keepdims=True)
    yield Idea("distance to the walls", (pull, near * damping), _near(reach))


def walls_of(track: MappedRecording) -> tuple[float, ...] | None:
    """x_low, x_high, y_low, y_high [m] of the tank, as the recording or its vessel states them."""
    return tuple(track.facts["walls_m"]) if "walls_m" in track.facts else None


def _direction(factors: Array) -> str:
    size, toward = (
        float(np.hypot(*factors)),
        float(np.degrees(np.arctan2(factors[1], factors[0]))) % 360.0,
    )
    return (
        f"the missing force keeps its direction in the world: {size:.2g} N toward {toward:.0f} deg"
    )


def _square(variable: str) -> Callable[[Array], str]:
    what = "moment" if variable.startswith(("yaw", "roll")) else "force"
    return lambda factors: (
        f"the missing {what} {_way(factors[0])} with the square of the {variable}"
    )


def _cube(factors: Array) -> str:
    way = "softer" if factors[0] > 0.0 else "stiffer"
    return f"the hull gets {way} the further it rolls: the missing moment grows with the cube of the roll angle"


def _forward(factors: Array) -> str:
    return f"the missing moment {_way(factors[0])} with the roll rate, the more the faster the ship goes ahead"


def _way(factor: float) -> str:
    return "resists" if factor < 0.0 else "pushes"


def _thrust(factors: Array) -> str:
    what = "is missing" if factors[0] < 0 else "comes on top"
    return f"while thrust is astern, about {abs(100.0 * factors[0]):.0f} % of the commanded thrust {what}"


def _play(factors: Array) -> str:
    if factors[0] < 0:
        return f"after the steering reverses, its angle is ahead by {-factors[0]:.2g} rad, which no play explains"
    return (
        f"after the steering reverses, its angle stays behind as with {factors[0]:.2g} rad of play"
    )


def _near(reach: float) -> Callable[[Array], str]:
    def sentence(factors: Array) -> str:
        pull, rise = factors * (1.0 - exp(-NEAR))  # at the wall
        more, way = "more" if rise > 0.0 else "less", "towards" if pull > 0.0 else "away from"
        return (
            f"within about {reach:.2g} m of a wall the boat drags up to {abs(100.0 * rise):.0f} % {more} and is pushed "
            f"{way} it by up to {abs(pull):.2g} N"
        )

    return sentence
