"""Low-speed model of a vessel for controllers: mass, damping, thrusters and wind loads."""

from math import inf, sqrt

import numpy as np

from boatsim.control.base import Controller
from boatsim.control.lag_design import LagBasedController
from boatsim.control.thrust_allocation import (
    Thruster,
    azimuth_thruster,
    fixed_thruster,
    rudder,
)
from boatsim.control.vessel_model import (
    DriveCommands,
    ModelBasedController,
    VesselModel,
    WindLoads,
)
from boatsim.errors import BadInput
from boatsim.physics.base import Array, Effect, Force, Inertia, make_motion
from boatsim.physics.effects.command_delay import CommandDelay
from boatsim.physics.effects.fan_wind import AIR_DENSITY
from boatsim.physics.effects.propeller import Propeller
from boatsim.physics.effects.rate_limit import RateLimit
from boatsim.physics.effects.rudder import Rudder
from boatsim.physics.effects.servo import Servo
from boatsim.physics.effects.thrust_lag import ThrustLag
from boatsim.physics.effects.thruster import Thruster as ThrusterEffect
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import AXES
from boatsim.physics.vessel import Vessel
from boatsim.physics.vessel.bindings import FULL_TURN

PLANE = [AXES.index(name) for name in ("surge", "sway", "yaw")]
WIND_KEYS = ("front", "side", "arm", "swing")
# Froude number at which the damping is linearised: 0.6 m/s for a ship of 80 m, 0.1 m/s for a boat
# of 2 m, the speeds of currents and of the motion while a position is held.
LOW_SPEED = 0.02


def has_wind_coefficients(effect: Effect) -> bool:
    """Return whether an effect is a wind force with drag areas.

    Args:
        effect: The effect.
    """
    return isinstance(effect, Force) and type(effect).of_air and hasattr(effect, "front")


def vessel_model(vessel: Vessel) -> VesselModel:
    """Return the low-speed model of a vessel for controllers.

    Args:
        vessel: A vessel that is free in surge, sway and yaw.

    Raises:
        BadInput: The vessel is not free in the plane, or has no thruster, propeller or rudder.
    """
    missing = [name for name in ("surge", "sway", "yaw") if name not in vessel.dof]
    if missing:
        raise BadInput(f"{vessel.name} is not free in {missing[0]}; allowed are vessels that are")
    thrusters, drives = thrusters_of(vessel)
    if not thrusters:
        raise BadInput(
            f"{vessel.name} has no thruster, propeller or rudder to which forces can be allocated"
        )
    return VesselModel(
        vessel.name,
        vessel.length,
        planar_mass(vessel),
        planar_damping(vessel),
        tuple(thrusters),
        tuple(drives),
        wind_loads(vessel),
        command_lag(vessel),
    )


def introduce_vessel(controller: Controller, vessel: Vessel) -> None:
    """Give a controller that needs it a model of its vessel, or the lag of its actuators.

    Args:
        controller: The controller.
        vessel: The vessel.

    Raises:
        BadInput: The vessel has no such model, or does not fit the controller.
    """
    if isinstance(controller, ModelBasedController):
        controller.use_vessel_model(vessel_model(vessel))
    elif isinstance(controller, LagBasedController):
        controller.use_command_lag(command_lag(vessel))


def command_lag(vessel: Vessel) -> float:
    """Return the longest sum of lags and delays between a command and its actuator [s].

    Args:
        vessel: The vessel.
    """
    sums = dict.fromkeys(vessel.commands, 0.0)
    for effect in vessel.effects:
        if isinstance(effect, CommandDelay):
            seconds = effect.delay
        elif isinstance(effect, ThrustLag):
            seconds = effect.time_constant
        elif isinstance(effect, Servo):
            seconds = effect.lag
        else:
            continue
        for channel in set(vessel.target_actuators(effect)) & set(sums):
            sums[channel] += seconds
    return max(sums.values(), default=0.0)


def wind_loads(vessel: Vessel) -> WindLoads | None:
    """Return the wind loads of a vessel, None if it has no wind force with drag areas.

    Args:
        vessel: The vessel.
    """
    for effect in vessel.effects:
        if has_wind_coefficients(effect):
            front, side, arm, swing = (getattr(effect, name, 0.0) for name in WIND_KEYS)
            return WindLoads(front, side, arm, swing, getattr(effect, "density", AIR_DENSITY))
    return None


def planar_mass(vessel: Vessel) -> Array:
    """Return the mass matrix of a vessel with added mass in surge, sway and yaw (3, 3).

    Args:
        vessel: The vessel.
    """
    m, ahead = vessel.body.mass, vessel.body.centre[0]
    mass = np.diag([m, m, vessel.body.yaw_inertia + m * ahead**2])
    mass[1, 2] = mass[2, 1] = m * ahead
    for effect in vessel.effects:
        if isinstance(effect, Inertia):
            mass += effect.matrix()[np.ix_(PLANE, PLANE)]
    return mass


def hull_force(
    vessel: Vessel, ahead: float, starboard: float, turning: float
) -> tuple[float, float, float]:
    """Return the force X, Y [N] and moment N [N m] of the water on a hull without thrust.

    Forces of the air, of waves and of thrusters, and forces that depend on commands do not count.

    Args:
        vessel: The vessel.
        ahead: Speed through the water, forward [m/s].
        starboard: Speed through the water, to starboard [m/s].
        turning: Yaw rate [rad/s].
    """
    m = make_motion(u=ahead, v=starboard, r=turning)
    total = np.zeros(3)
    for effect in vessel.effects:
        if not isinstance(effect, Force) or type(effect).roles or effect.per_instance_of:
            continue
        if type(effect).of_air or type(effect).tied_to:
            continue
        if getattr(effect, "significant_height", 0.0):
            continue
        found = effect.wrench(m)
        total += [found.X, found.Y, found.N]
    X, Y, N = total.tolist()
    return X, Y, N


def planar_damping(vessel: Vessel) -> Array:
    """Return the linear damping matrix of a vessel at low speed (3, 3).

    Columns are central differences of the hull force over +- LOW_SPEED.

    Args:
        vessel: The vessel.
    """
    speed = LOW_SPEED * sqrt(GRAVITY * vessel.length)
    columns = []
    for axis, step in enumerate((speed, speed, speed / vessel.length)):
        motion = [0.0, 0.0, 0.0]
        motion[axis] = step
        more = np.array(hull_force(vessel, motion[0], motion[1], motion[2]))
        less = np.array(hull_force(vessel, -motion[0], -motion[1], -motion[2]))
        columns.append(-(more - less) / (2.0 * step))
    return np.array(columns).T


def thrusters_of(vessel: Vessel) -> tuple[list[Thruster], list[DriveCommands]]:
    """Return the thrusters and rudders of a vessel and their command channels.

    They are effects `thruster`, `propeller` and `rudder`. Ranges are those of the channels and of
    servos, rates those of `servo` and `rate_limit`. A rate of a shaft has no limit here.

    Args:
        vessel: The vessel.
    """
    thrusters, drives = [], []
    for effect in vessel.effects:
        bound = vessel.bindings(effect)
        if isinstance(effect, ThrusterEffect | Propeller):
            found = _thruster(vessel, effect, dict(bound))
        elif isinstance(effect, Rudder) and bound["angle"] in vessel.commands:
            channel = str(bound["angle"])
            low, high, rate = _limits(vessel, channel)
            found = (
                rudder(effect.name, effect.sway, effect.yaw, min(-low, high), rate),
                DriveCommands(channel),
            )
        else:
            continue
        if found is not None:
            thrusters.append(found[0])
            drives.append(found[1])
    return thrusters, drives


def _thruster(
    vessel: Vessel, effect: ThrusterEffect | Propeller, bound: dict[str, object]
) -> tuple[Thruster, DriveCommands] | None:
    """A thruster or propeller and its channels; None if its thrust is no command."""
    shaft = isinstance(effect, Propeller)
    channel, angle = str(bound["shaft" if shaft else "thrust"]), bound.get("angle", 0.0)
    if channel not in vessel.commands:
        return None
    low, high, rate = _limits(vessel, channel)
    if isinstance(effect, Propeller):
        drive = DriveCommands(channel, "", effect.ahead, effect.astern, effect.gain)
        low, high = -effect.astern * low * low, effect.ahead * high * high
        rate = inf
    else:
        drive = DriveCommands(channel, gain=effect.gain)
    low, high, rate = (effect.gain * x for x in (low, high, rate))
    if not isinstance(angle, str):
        direction = float(angle)  # type: ignore[arg-type]
        thruster = fixed_thruster(effect.name, effect.x, effect.y, low, high, direction, rate)
        return thruster, drive
    least, most, turn = _limits(vessel, angle)
    if most - least >= FULL_TURN:
        least, most = -inf, inf
    drive = DriveCommands(channel, angle, drive.ahead, drive.astern, drive.gain)
    place = (effect.name, effect.x, effect.y, high)
    return azimuth_thruster(*place, least, most, rate, turn, low), drive


def _limits(vessel: Vessel, channel: str) -> tuple[float, float, float]:
    """Range and largest rate of a command channel."""
    command = vessel.commands[channel]
    low, high, rate = command.low, command.high, inf
    for effect in vessel.effects:
        if isinstance(effect, Servo | RateLimit) and channel in vessel.target_actuators(effect):
            rate = min(rate, effect.rate)
            if isinstance(effect, Servo):
                low, high = max(low, -effect.range), min(high, effect.range)
    return low, high, rate
