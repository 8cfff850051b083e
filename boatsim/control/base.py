"""Base classes of controllers and blocks that they share.

A controller uses plain floats and does not depend on the simulator, so that it can be ported to a
boat.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import exp, inf, isnan, nan, pi
from typing import ClassVar, NamedTuple

from boatsim.physics.base import CheckedParameters, param


@dataclass(frozen=True)
class Sense:
    """Sensor readings that a controller receives at one step, in SNAME axes.

    Missing sensors are nan.
    """

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
    # readings of further sensors by name
    more: Mapping[str, float] = field(default_factory=dict)


class Estimate(NamedTuple):
    """One adaptive estimate of a controller with its bounds, for the log of a run."""

    value: float
    low: float
    high: float


@dataclass
class Controller(CheckedParameters):
    """Base class of controllers of a vessel, which turn sensor readings and goals into commands.

    Call `reset` before a run, then `step` once every `period` seconds.
    """

    words: ClassVar[str] = ""  # one line for `boatsim list`
    commands: ClassVar[tuple[str, ...]] = ()  # command channels it sets; empty: any
    # keys a [[goal]] may have; empty: the vessel's command channels
    goals: ClassVar[tuple[str, ...]] = ()
    # ending of the file that `use` names; empty: `use` is the name of the controller
    use_ending: ClassVar[str] = ""
    passes_on: ClassVar[bool] = False  # its goals are the commands; sensors are not used
    tuned: ClassVar[tuple[str, ...]] = ()  # parameters that `boatsim tune` changes by default

    period: float = param(
        0.08, low=0.001, high=10.0, unit="s", words="time between two control steps"
    )

    def reset(self) -> None:
        """Reset all internal states of the controller; called before each run."""

    def channels(self) -> tuple[str, ...]:
        """Return the command channels that the controller sets; none: any."""
        return type(self).commands

    def initial_commands(self) -> dict[str, float]:
        """Return the controller's commands before its first step; missing ones are neutral."""
        return {}

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the controller's commands for the next period by name of channel.

        Args:
            sense: Sensor readings.
            goal: Set points by name.
        """
        raise NotImplementedError

    def time_to_extra_step(self, sense: Sense) -> float:
        """Return the time [s] until the controller needs an additional step within its period.

        It is infinite if none is needed.

        Args:
            sense: Sensor readings.
        """
        return inf

    def estimates(self) -> dict[str, Estimate]:
        """Return the controller's adaptive estimates and reference model states, for the log."""
        return {}

    def largest_goals(self) -> Mapping[str, float]:
        """Return the largest set points for which the controller is designed, by name.

        Others follow from the vessel.
        """
        return {}

    @property
    def done(self) -> bool:
        """Whether the controller's manoeuvre is complete, so that the run may end."""
        return False


@dataclass
class HelmManoeuvre(Controller):
    """Base class of controllers for standard manoeuvres: an approach ahead, then helm angles.

    `ahead` are the commands of the approach, `steer` the commands per rad of helm (positive turns
    to starboard). The approach has the helm `trim`, which keeps the course. The helm angle of the
    manoeuvre is logged as `reference_helm_rad`; it is 0 during the approach.
    """

    angle: float = param(
        0.35, low=-1.6, high=1.6, unit="rad", words="helm angle, positive to starboard"
    )
    execute: float = param(0.0, low=0.0, high=1e6, unit="s", words="when the manoeuvre begins")
    trim: float = param(
        0.0, low=-1.6, high=1.6, unit="rad", words="helm of the approach, which keeps the course"
    )
    ahead: dict[str, float] = field(default_factory=dict)
    steer: dict[str, float] = field(default_factory=dict)
    _helm: float = field(default=0.0, init=False)
    _course: float = field(default=nan, init=False)  # [rad] heading at the start of the run

    def reset(self) -> None:
        """Set the helm of a standard manoeuvre midships, before a run."""
        self._helm, self._course = 0.0, nan

    def initial_commands(self) -> dict[str, float]:
        """Return the commands of the approach ahead, which precedes a standard manoeuvre."""
        return self.commands_at_helm(self.trim)

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the commands of a standard manoeuvre for the next period.

        Until the time `execute` they are those of the approach ahead.

        Args:
            sense: Sensor readings.
            goal: Not used.
        """
        if isnan(self._course):
            self._course = sense.psi
        self._helm = 0.0
        if sense.t < self.execute - 1e-9:
            return self.commands_at_helm(self.trim)
        self._helm = self.helm_angle(sense)
        return self.commands_at_helm(self._helm)

    def helm_angle(self, sense: Sense) -> float:
        """Return the present helm angle of a standard manoeuvre [rad].

        Args:
            sense: Sensor readings.
        """
        raise NotImplementedError

    def commands_at_helm(self, helm: float) -> dict[str, float]:
        """Return the vessel's commands for going ahead at a helm angle of a standard manoeuvre.

        Args:
            helm: Helm angle [rad].
        """
        commands = dict(self.ahead)
        for name, per_rad in self.steer.items():
            commands[name] = self.ahead.get(name, 0.0) + per_rad * helm
        return commands

    def estimates(self) -> dict[str, Estimate]:
        """Return the helm angle of the manoeuvre, for the log of a run."""
        return {"reference_helm_rad": Estimate(self._helm, nan, nan)}


def clip(value: float, low: float, high: float) -> float:
    """Return the value limited to [low, high].

    Args:
        value: Value.
        low: Lower limit.
        high: Upper limit.
    """
    if value < low:
        return low
    if value > high:
        return high
    return value


def wrap(angle: float) -> float:
    """Return the angle wrapped to [-pi, pi).

    Args:
        angle: Angle [rad].
    """
    return (angle + pi) % (2.0 * pi) - pi


@dataclass
class LowPass:
    """First-order low-pass filter wc / (s + wc), exact for an input held over each step."""

    cutoff: float  # [rad/s]
    state: float = 0.0

    def step(self, value: float, dt: float) -> float:
        """Return the output of the low-pass filter at the end of a step.

        Args:
            value: Input, held over the step.
            dt: Length of the step [s].
        """
        self.state += (1.0 - exp(-self.cutoff * dt)) * (value - self.state)
        return self.state
