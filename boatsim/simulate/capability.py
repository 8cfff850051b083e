"""Station-keeping capability: the largest wind from each direction that the thrusters can hold.

The wind, a current in the same direction and the thrust are in static balance at constant heading,
as in IMCA M 140, Specification for DP capability plots.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, inf, pi, sin

import numpy as np

from boatsim.control.thrust_allocation import ThrustAllocator
from boatsim.control.vessel_model import WindLoads
from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.vessel_model import hull_force, vessel_model

INTACT = "intact"
LARGEST_WIND = 100.0  # [m/s] beyond any hurricane; a larger capability is reported as this one
# A force that misses the demand by this share of full thrust counts as the demand. The allocation
# itself misses attainable demands by 1e-6.
ATTAINED = 1e-5
HALVINGS = 24  # of the interval 0 .. LARGEST_WIND: to 6e-6 m/s


@dataclass(frozen=True)
class Capability:
    """Largest wind that a vessel can hold, by direction and by the thruster that is lost.

    Attributes:
        vessel: Name of the vessel.
        directions: Directions from which the wind comes, clockwise from the bow (n,) [rad].
        winds: Largest wind speed (n,) [m/s] by case: "intact", then "without NAME" for each lost
            thruster; LARGEST_WIND where it is not limited.
        current: Speed of the current in the direction of the wind [m/s].
        share: Share of the thrust that is used.
    """

    vessel: str
    directions: Array
    winds: dict[str, Array]
    current: float
    share: float


def capability(
    vessel: Vessel,
    wind: WindLoads | None = None,
    current: float = 0.0,
    share: float = 1.0,
    directions: int = 36,
    lost: Sequence[str] | None = None,
) -> Capability:
    """Compute the largest wind from each direction that the thrusters of a vessel can hold.

    Args:
        vessel: The vessel.
        wind: Wind loads; by default those of the vessel's own wind force.
        current: Speed of a current in the direction of the wind [m/s].
        share: Share of the thrust that may be used; 0.8 leaves a reserve of 20 % for motions.
        directions: Number of directions.
        lost: Thrusters of which each one alone is lost in a further case; by default every one.

    Raises:
        BadInput: The vessel has no thrusters or no wind coefficients, or an argument is wrong.
    """
    model = vessel_model(vessel)
    wind = wind or model.wind
    if wind is None:
        raise BadInput(
            f"{vessel.name} has no wind force with drag areas (such as gusty_wind); give them by "
            "--front and --side"
        )
    if not current >= 0.0:
        raise BadInput(f"current = {current:g} m/s; allowed is 0 or more")
    if not 0.0 < share <= 1.0:
        raise BadInput(f"share = {share:g}; allowed is more than 0, up to 1")
    if directions < 4:
        raise BadInput(f"directions = {directions}; allowed is 4 or more")
    names = [one.name for one in model.thrusters]
    cases: dict[str, ThrustAllocator | None] = {INTACT: ThrustAllocator(model.thrusters)}
    for name in names if lost is None else lost:
        if name not in names:
            raise BadInput(unknown_name_message(f"{vessel.name}: thruster", name, names))
        rest = model.without([name]).thrusters
        cases[f"without {name}"] = ThrustAllocator(rest) if rest else None
    angles = 2.0 * pi * np.arange(directions) / directions
    winds: dict[str, Array] = {}
    for case, allocator in cases.items():
        found = np.zeros(directions)
        for i, angle in enumerate(angles.tolist()):
            drift = current_load(vessel, current, angle)
            if allocator is not None:
                found[i] = largest_wind(allocator, wind, drift, angle, share)
        winds[case] = found
    return Capability(vessel.name, angles, winds, current, share)


def current_load(vessel: Vessel, speed: float, angle: float) -> Array:
    """Return the force of a current on a hull that lies still (3,) [N, N, N m].

    Args:
        vessel: The vessel.
        speed: Speed of the current [m/s].
        angle: Direction from which it comes, clockwise from the bow [rad].
    """
    return np.array(hull_force(vessel, speed * cos(angle), speed * sin(angle), 0.0))


def largest_wind(
    allocator: ThrustAllocator, wind: WindLoads, drift: Array, angle: float, share: float = 1.0
) -> float:
    """Return the largest speed of the wind from a direction that thrusters can hold [m/s].

    Wind loads grow with the square of the speed, so that demands lie on a ray. Without forbidden
    directions of thrusters the attainable forces are a convex set, and one interval of the ray lies
    in it.

    Args:
        allocator: Allocation to the thrusters.
        wind: Wind loads.
        drift: Force of the current X, Y [N], N [N m] (3,).
        angle: Direction from which the wind comes, clockwise from the bow [rad].
        share: Share of the thrust that may be used.

    Returns:
        The speed; 0 if even the current cannot be held, LARGEST_WIND if no wind is too strong.
    """
    unit = np.array(wind.force(-cos(angle), -sin(angle)))
    if not _holds(allocator, drift / share):
        return 0.0
    low, high = 0.0, LARGEST_WIND
    if _holds(allocator, (drift + unit * high**2) / share):
        return LARGEST_WIND
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if _holds(allocator, (drift + unit * middle**2) / share):
            low = middle
        else:
            high = middle
    return low


def _holds(allocator: ThrustAllocator, load: Array) -> bool:
    """Whether the thrusters can balance a load."""
    found = allocator.optimum(-load)
    missing = np.abs(found.force + load) / allocator.scale
    return bool(missing.max(initial=0.0) < ATTAINED * _relative_size(load, allocator))


def _relative_size(load: Array, allocator: ThrustAllocator) -> float:
    """Size of a load relative to full thrust, at least 1, as errors grow with the demand."""
    return max(1.0, min(float(np.abs(load / allocator.scale).max()), inf))
