"""Base classes of autopilots with one rudder and a steering machine."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan, nan, pi, radians
from typing import ClassVar

from boatsim.control.base import Controller, Estimate, Sense, clip, wrap
from boatsim.control.identification import Forgetting, IdentifiedShip
from boatsim.errors import BadInput
from boatsim.physics.base import param


def push_sample(history: list[float], value: float) -> None:
    """Shift a history of samples [now, one period ago, ...] by one period and insert a new sample.

    Args:
        history: Samples, newest first; changed in place.
        value: New sample.
    """
    history.insert(0, value)
    history.pop()


@dataclass
class Helm(Controller):
    """Base class of autopilots with one rudder, which a steering machine turns.

    A subclass returns the wanted rudder angle in `rudder_demand`. The steering machine has a rate
    limit and a range. The command is the angle that it reaches after a period, as in Martin's
    simulation. Positive rudder turns the bow to starboard. Goal: `psi_rad`.
    """

    commands: ClassVar[tuple[str, ...]] = ("rudder_rad",)
    goals: ClassVar[tuple[str, ...]] = ("psi_rad",)

    period: float = param(
        0.5, low=0.01, high=10.0, unit="s", words="time between two control steps"
    )
    rudder_limit: float = param(
        radians(40.0), low=0.01, high=0.5 * pi, unit="rad", words="largest rudder angle"
    )
    rudder_rate: float = param(
        radians(5.0), low=1e-3, high=10.0, unit="rad/s", words="fastest turning of the rudder"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        self.reset()

    def reset(self) -> None:
        """Set the rudder amidships and clear the autopilot's histories of heading and roll."""
        self.rudder = 0.0  # [rad] in force
        self.psi: list[
            float
        ] = []  # [rad] heading relative to the course: now, one period ago, two ago
        self.phi: list[float] = []  # [rad] roll, likewise

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """Return the autopilot's rudder angle command for the next period.

        Args:
            sense: Sensor readings.
            goal: `psi_rad`, the course [rad].
        """
        self.add_sample(sense.psi - goal.get("psi_rad", 0.0), sense.phi)
        self.rudder = self.rudder_after_period(self.rudder_demand())
        return {"rudder_rad": self.rudder}

    def add_sample(self, psi: float, phi: float) -> None:
        """Append heading error and roll to the autopilot's histories.

        The heading is relative to the course. Before the first sample the values are assumed
        constant; full turns are counted. Without a roll sensor the roll is zero.

        Args:
            psi: Heading relative to the course [rad].
            phi: Roll [rad]; nan without a sensor.

        Raises:
            BadInput: There is no roll sensor but the controller needs one.
        """
        if isnan(phi):
            if self.needs_roll():
                raise BadInput(
                    f"{type(self).__name__}: roll_reduction needs [[sensor]] use = 'inclinometer'"
                )
            phi = 0.0
        if not self.psi:
            self.psi, self.phi = [wrap(psi)] * 3, [phi] * 3
        push_sample(self.psi, self.psi[0] + wrap(psi - self.psi[0]))
        push_sample(self.phi, phi)

    def needs_roll(self) -> bool:
        """Return whether the autopilot needs a measured roll angle."""
        return False

    def rudder_demand(self) -> float:
        """Return the rudder angle [rad] that the autopilot wants.

        The limits of the steering machine are applied to it later.
        """
        raise NotImplementedError

    @property
    def largest_rudder_step(self) -> float:
        """Largest angle [rad] that the steering machine can turn the rudder in one period."""
        return self.rudder_rate * self.period

    def rudder_after_period(self, demand: float) -> float:
        """Return the rudder angle [rad] that the steering machine reaches after a period.

        Args:
            demand: Wanted angle [rad].
        """
        near = clip(
            demand, self.rudder - self.largest_rudder_step, self.rudder + self.largest_rudder_step
        )
        return clip(near, -self.rudder_limit, self.rudder_limit)

    def possible_rudder_angles(self) -> list[float]:
        """Return the rudder angles [rad] that a three-way steering machine can reach in one period.

        They are those after a stop and after a movement to port or to starboard.
        """
        swung = (self.rudder - self.largest_rudder_step, self.rudder + self.largest_rudder_step)
        return [self.rudder, *(u for u in swung if abs(u) <= self.rudder_limit + 1e-9)]


@dataclass
class LearningHelm(Forgetting, Helm):
    """Base class of autopilots that identify the ship's response online, from a nominal ship."""

    nominal_yaw: ClassVar[tuple[float, float, float]]  # a2y, b1y, b2y of `Ship`
    nominal_roll: ClassVar[tuple[float, float, float, float]]  # a1r, a2r, b1r, b2r

    roll_reduction: bool = False

    def reset(self) -> None:
        """Reset the autopilot's identification to the nominal ship."""
        super().reset()
        self.ship = IdentifiedShip(self, self.nominal_yaw, self.nominal_roll)

    def needs_roll(self) -> bool:
        """Return whether the autopilot reduces roll and so needs a measured roll angle."""
        return bool(self.roll_reduction)

    def add_sample(self, psi: float, phi: float) -> None:
        """Append heading error and roll to the histories and update the identification of the ship.

        Args:
            psi: Heading relative to the course [rad].
            phi: Roll [rad].
        """
        super().add_sample(psi, phi)
        self.ship.update(self.psi, self.phi, self.rudder)

    def estimates(self) -> dict[str, Estimate]:
        """Return the identified coefficients of the ship's difference equations, for the log."""
        return {
            name: Estimate(value, nan, nan) for name, value in self.ship.named_estimates().items()
        }
