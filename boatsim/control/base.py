"""What a controller is, and the blocks controllers share.

A controller works in plain floats and knows nothing of the simulator, so it could move to a boat.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import exp, inf, isnan, nan, pi
from typing import ClassVar, NamedTuple

from boatsim.physics.base import Checked, param


@dataclass(frozen=True)
class Sense:
    """What the sensors say at one control step, SNAME axes; nan where the boat has no such sensor."""

    t: float  # [s] since the start
    psi: float  # [rad] heading, compass (magnetometer)
    r: float  # [rad/s] yaw rate, gyro
    ax: float  # [m/s^2] forward acceleration of the CG
    ay: float  # [m/s^2] acceleration to starboard
    u: float  # [m/s] surge velocity
    v: float  # [m/s] sway velocity
    x: float  # [m] position in start axes
    y: float  # [m]
    phi: float = nan  # [rad] roll
    p: float = nan  # [rad/s] roll rate
    # what further sensors of the boat read, by name
    more: Mapping[str, float] = field(default_factory=dict)


class Estimate(NamedTuple):
    """An adaptive estimate and the bounds that hold it, for the log."""

    value: float
    low: float
    high: float


@dataclass
class Controller(Checked):
    """Base of controllers: `reset` before a run, then `step` once every `period` seconds."""

    words: ClassVar[str] = ""  # one line for `boatsim list`
    commands: ClassVar[tuple[str, ...]] = ()  # command channels it sets; empty: any
    # keys a [[goal]] may have; empty: the vessel's command channels
    goals: ClassVar[tuple[str, ...]] = ()
    passes_on: ClassVar[bool] = False  # its goals are the commands, whatever is sensed

    period: float = param(
        0.08, low=0.001, high=10.0, unit="s", words="time between two control steps"
    )

    def reset(self) -> None:
        """Forget everything; called before each run."""

    def initial_commands(self) -> dict[str, float]:
        """Commands in force before the first step (servos may be parked at an angle); missing ones are neutral."""
        return {}

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Commands for the next period, name of channel -> value."""
        raise NotImplementedError

    def early(self, sense: Sense) -> float:
        """Time [s] after which it wants its next step, where it must act at an instant at which no period ends."""
        return inf

    def estimates(self) -> dict[str, Estimate]:
        """Adaptive estimates with their bounds, and the reference model's states where there is one, for the log."""
        return {}

    def largest_goals(self) -> Mapping[str, float]:
        """The largest goals that it is made for, by key: a joystick's full way. Others follow from the vessel."""
        return {}

    @property
    def done(self) -> bool:
        """Whether all it was to do is done, so that the run may end."""
        return False


@dataclass
class Steered(Controller):
    """Base of controllers that play a standard manoeuvre: the ship goes ahead, then an angle is demanded of its helm.

    `ahead` are the commands of the approach, `steer` the command per rad of helm (positive turns to starboard). The
    angle in force is logged as `reference_helm_rad`.
    """

    angle: float = param(
        0.35, low=-1.6, high=1.6, unit="rad", words="helm angle, positive to starboard"
    )
    execute: float = param(0.0, low=0.0, high=1e6, unit="s", words="when the manoeuvre begins")
    ahead: dict[str, float] = field(default_factory=dict)
    steer: dict[str, float] = field(default_factory=dict)
    _helm: float = field(default=0.0, init=False)
    _course: float = field(default=nan, init=False)  # [rad] heading at the start of the run

    def reset(self) -> None:
        """Helm midships."""
        self._helm, self._course = 0.0, nan

    def initial_commands(self) -> dict[str, float]:
        """Those of the approach."""
        return self.commanded(0.0)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Approach until it is time, then the manoeuvre."""
        self._course = sense.psi if isnan(self._course) else self._course
        self._helm = self.helm(sense) if sense.t >= self.execute - 1e-9 else 0.0
        return self.commanded(self._helm)

    def helm(self, sense: Sense) -> float:
        """Helm angle [rad] of the manoeuvre now."""
        raise NotImplementedError

    def commanded(self, helm: float) -> dict[str, float]:
        """Commands with which the ship goes ahead at a helm angle."""
        turned = {
            name: self.ahead.get(name, 0.0) + per_rad * helm for name, per_rad in self.steer.items()
        }
        return {**self.ahead, **turned}

    def estimates(self) -> dict[str, Estimate]:
        """The helm angle, for the log."""
        return {"reference_helm_rad": Estimate(self._helm, nan, nan)}


def clip(value: float, low: float, high: float) -> float:
    """Nearest value inside [low, high]."""
    return low if value < low else high if value > high else value


def wrap(angle: float) -> float:
    """The same direction inside [-pi, pi)."""
    return (angle + pi) % (2.0 * pi) - pi


@dataclass
class LowPass:
    """First-order low-pass wc/(s + wc), exact for an input held over each step."""

    cutoff: float  # [rad/s]
    state: float = 0.0

    def step(self, value: float, dt: float) -> float:
        """Feed one value held for dt [s]; returns the output at the end of it."""
        self.state += (1.0 - exp(-self.cutoff * dt)) * (value - self.state)
        return self.state
