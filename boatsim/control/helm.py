"""Course keeping by one rudder: what a helm remembers, and the steering machine that bounds what it may ask for."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isnan, nan, pi, radians
from typing import ClassVar

from boatsim.control.base import Controller, Estimate, Sense, clip, wrap
from boatsim.control.identification import Forgetting, Ship
from boatsim.errors import BadInput
from boatsim.physics.base import param


def push(history: list[float], value: float) -> None:
    """Shift a history [now, one period ago, ...] by one sample."""
    history.insert(0, value)
    history.pop()


@dataclass
class Helm(Controller):
    """Base of autopilots: a subclass says in `demand` which rudder angle it wants, from the histories kept here.

    The steering machine turns at one rate at most and stops at one angle; the command is what it will have done after
    a period, as in Martin's simulation. Positive rudder turns the bow to starboard. Goal: `psi_rad`.
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
        """Rudder amidships, nothing seen."""
        self.rudder = 0.0  # [rad] in force
        self.psi: list[float] = []  # [rad] heading beside the course: now, one period ago, two ago
        self.phi: list[float] = []  # [rad] roll, likewise

    def step(self, sense: Sense, goal: Mapping[str, float]) -> dict[str, float]:
        """The angle the rudder takes for the next period."""
        self.see(sense.psi - goal.get("psi_rad", 0.0), sense.phi)
        self.rudder = self.reached(self.demand())
        return {"rudder_rad": self.rudder}

    def see(self, psi: float, phi: float) -> None:
        """Heading beside the course and roll [rad] into the histories.

        Before her first sight the ship is taken to have lain as she is seen; turns are counted, not cut at pi. Raises
        BadInput without a roll sensor where one is needed; elsewhere she is then taken to stand upright.
        """
        if isnan(phi):
            if self.needs_roll():
                raise BadInput(
                    f"{type(self).__name__}: roll_reduction needs [[sensor]] use = 'inclinometer'"
                )
            phi = 0.0
        if not self.psi:
            self.psi, self.phi = [wrap(psi)] * 3, [phi] * 3
        push(self.psi, self.psi[0] + wrap(psi - self.psi[0]))
        push(self.phi, phi)

    def needs_roll(self) -> bool:
        """Whether it cannot do without the roll angle."""
        return False

    def demand(self) -> float:
        """Rudder angle wanted [rad]."""
        raise NotImplementedError

    @property
    def swing(self) -> float:
        """Angle [rad] that the rudder can turn in one period."""
        return self.rudder_rate * self.period

    def reached(self, demand: float) -> float:
        """Angle [rad] at which the steering machine stands after a period."""
        near = clip(demand, self.rudder - self.swing, self.rudder + self.swing)
        return clip(near, -self.rudder_limit, self.rudder_limit)

    def choices(self) -> list[float]:
        """Rudder angles [rad] of a machine that knows port, stop and starboard only; stop comes first."""
        swung = (self.rudder - self.swing, self.rudder + self.swing)
        return [self.rudder, *(u for u in swung if abs(u) <= self.rudder_limit + 1e-9)]


@dataclass
class LearningHelm(Forgetting, Helm):
    """Base of autopilots that identify their ship while they steer her, from a nominal one that the subclass states."""

    nominal_yaw: ClassVar[tuple[float, float, float]]  # a2y, b1y, b2y of `Ship`
    nominal_roll: ClassVar[tuple[float, float, float, float]]  # a1r, a2r, b1r, b2r

    roll_reduction: bool = False

    def reset(self) -> None:
        """Nothing learnt beyond the nominal ship."""
        super().reset()
        self.ship = Ship(self, self.nominal_yaw, self.nominal_roll)

    def needs_roll(self) -> bool:
        """With roll reduction."""
        return bool(self.roll_reduction)

    def see(self, psi: float, phi: float) -> None:
        """Into the histories, and a lesson from the period gone by."""
        super().see(psi, phi)
        self.ship.learn(self.psi, self.phi, self.rudder)

    def estimates(self) -> dict[str, Estimate]:
        """The identified ship."""
        return {name: Estimate(value, nan, nan) for name, value in self.ship.named().items()}
