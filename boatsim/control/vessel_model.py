"""What a model-based controller knows of its vessel: plain numbers, without the simulator."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import copysign, hypot, sqrt

from boatsim.control.base import Controller
from boatsim.control.thrust_allocation import Setting, Thruster
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array


@dataclass(frozen=True)
class DriveCommands:
    """Command channels of one thruster or rudder, and the law from its thrust to the command.

    Attributes:
        thrust: Channel of the thrust [N], of the shaft rate [rad/s] or of the rudder angle [rad].
        angle: Channel of the direction of the thrust [rad]; "" for a thruster that cannot turn.
        ahead: Thrust over squared shaft rate ahead [N s^2/rad^2]; 0 if the command is the thrust.
        astern: The same astern.
        gain: Thrust over commanded thrust.
    """

    thrust: str
    angle: str = ""
    ahead: float = 0.0
    astern: float = 0.0
    gain: float = 1.0

    def command_for_thrust(self, thrust: float) -> float:
        """Return the command of the channel `thrust` for a thrust.

        Args:
            thrust: Thrust [N], or angle of a rudder [rad].
        """
        wanted = thrust / self.gain
        if self.ahead == 0.0:
            return wanted
        per_square = self.ahead if wanted >= 0.0 else self.astern
        return copysign(sqrt(abs(wanted) / per_square), wanted) if per_square else 0.0


@dataclass(frozen=True)
class WindLoads:
    """Coefficients of the wind force on a hull.

    X = 0.5 rho front U a,  Y = 0.5 rho side U b,  N = (arm + swing a / U) Y

    U is the speed of the air past the hull, a and b its components forward and to starboard.

    Attributes:
        front: Frontal drag area [m^2].
        side: Lateral drag area [m^2].
        arm: Lever of the side force ahead of the origin [m].
        swing: Additional lever with the wind from astern [m].
        density: Density of the air [kg/m^3].
    """

    front: float
    side: float
    arm: float = 0.0
    swing: float = 0.0
    density: float = 1.2

    def force(self, ahead: float, starboard: float) -> tuple[float, float, float]:
        """Return the wind force X, Y [N] and yaw moment N [N m].

        Args:
            ahead: Velocity of the air past the hull, forward [m/s].
            starboard: Velocity of the air past the hull, to starboard [m/s].
        """
        speed = hypot(ahead, starboard)
        if speed == 0.0:
            return 0.0, 0.0, 0.0
        pressure = 0.5 * self.density * speed
        Y = pressure * self.side * starboard
        return pressure * self.front * ahead, Y, (self.arm + self.swing * ahead / speed) * Y


@dataclass(frozen=True)
class VesselModel:
    """Low-speed model of a vessel in surge, sway and yaw, with its thrusters and wind loads.

    M nu' + D nu = tau

    Attributes:
        name: Name of the vessel.
        length: Length [m].
        mass: M, mass matrix with added mass (3, 3) [kg, kg m, kg m^2].
        damping: D, linear damping (3, 3) [N s/m, N s, N m s].
        thrusters: Thrusters and rudders.
        drives: Command channels of each of them, in the same order.
        wind: Wind loads; None if the vessel has no wind coefficients.
        lag: Longest sum of lags and delays between a command and its thrust [s].
    """

    name: str
    length: float
    mass: Array
    damping: Array
    thrusters: tuple[Thruster, ...]
    drives: tuple[DriveCommands, ...]
    wind: WindLoads | None = None
    lag: float = 0.0

    def without(self, names: Sequence[str]) -> "VesselModel":
        """Return the model without some thrusters, which are out of service.

        Args:
            names: Names of the thrusters.

        Raises:
            BadInput: There is no such thruster.
        """
        there = [one.name for one in self.thrusters]
        for name in names:
            if name not in there:
                raise BadInput(unknown_name_message(f"{self.name}: thruster", name, there))
        kept = [i for i, name in enumerate(there) if name not in names]
        thrusters = tuple(self.thrusters[i] for i in kept)
        return replace(self, thrusters=thrusters, drives=tuple(self.drives[i] for i in kept))

    def commands(self, setting: Setting) -> dict[str, float]:
        """Return the commands of all thrusters at a setting, by name of channel.

        Args:
            setting: Thrusts and directions.
        """
        sent: dict[str, float] = {}
        values = zip(self.drives, setting.thrust.tolist(), setting.angle.tolist(), strict=True)
        for drive, thrust, angle in values:
            sent[drive.thrust] = drive.command_for_thrust(thrust)
            if drive.angle:
                sent[drive.angle] = angle
        return sent


class ModelBasedController(Controller):
    """Base class of controllers that need a model of the vessel.

    `use_vessel_model` is called once, before the first run.
    """

    def use_vessel_model(self, model: VesselModel) -> None:
        """Take over what the controller needs to know of its vessel.

        Args:
            model: Low-speed model of the vessel.
        """
        raise NotImplementedError
