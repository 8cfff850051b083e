"""Equilibrium of a hull on still water: draught, trim, metacentric heights, righting arms."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from boatsim.errors import BadInput
from boatsim.physics.hull.mesh import ClosedMesh
from boatsim.physics.hull.submerged import Submerged, attitude, submerged_part
from boatsim.physics.signals import Array

# Relative accuracy of the immersion, and absolute one of the trim [rad]; both are those of rounding
FINE = 1e-14
ROUNDING = 1e-13  # lever over length that is zero but for rounding
FIRST_TRIM, WIDER = 0.01, 2.0  # [rad] first change of the trim in search of a bracket, and factor
MOST_TRIM = 1.5  # [rad] beyond which a hull stands on an end
STEEPEST = np.radians(0.01)  # [rad] accuracy of the angle of vanishing stability


@dataclass(frozen=True, eq=False)
class LoadedHull:
    """A hull with the volume that it displaces and its mass centre.

    Attributes:
        mesh: The hull.
        volume: Displaced volume, its mass over the density of the water [m^3].
        centre: Mass centre (3,) in the axes of the mesh [m].
    """

    mesh: ClosedMesh
    volume: float
    centre: Array


@dataclass(frozen=True)
class RightingArm:
    """Equilibrium of a hull at one heel, free in sinkage and trim.

    Attributes:
        heel: Roll angle [rad], starboard down.
        arm: Righting arm GZ [m]: distance to starboard of the centre of buoyancy from the mass
            centre in level axes. A positive arm turns a hull that heels to starboard upright.
        trim: Pitch angle [rad], bow up.
        depth: Depth of the origin of the mesh below the surface [m].
        submerged: Submerged part.
    """

    heel: float
    arm: float
    trim: float
    depth: float
    submerged: Submerged


def depth_of_volume(mesh: ClosedMesh, volume: float, heel: float = 0.0, trim: float = 0.0) -> float:
    """Return the depth of the origin of a mesh at which it displaces a volume [m].

    Args:
        mesh: The hull.
        volume: The volume [m^3].
        heel: Roll angle [rad].
        trim: Pitch angle [rad].

    Raises:
        BadInput: The hull encloses no more than this volume.
    """
    whole = mesh.volume
    if not 0.0 < volume < whole:
        raise BadInput(
            f"the hull encloses {whole:.6g} m^3, and {volume:.6g} m^3 are to be displaced; "
            "allowed is less than the hull encloses"
        )
    heights = mesh.points @ attitude(heel, trim)[2]
    low, high = -float(heights.max()), -float(heights.min())

    def excess(depth: float) -> float:
        return submerged_part(mesh, depth, heel, trim).volume - volume

    return float(brentq(excess, low, high, xtol=FINE * (high - low), rtol=8.9e-16))


def righting_arm(hull: LoadedHull, heel: float, near: float = 0.0) -> RightingArm:
    """Return the equilibrium at a heel, with the sinkage and trim that balance the hull.

    Args:
        hull: The hull.
        heel: Roll angle [rad].
        near: Trim from which the search begins [rad]. The nearest equilibrium is found, also one
            that a hull leaves when its trim is disturbed.

    Raises:
        BadInput: There is no equilibrium with a trim below 86 degrees.
    """

    def ahead(trim: float) -> float:
        return float(_lever(hull, heel, trim)[1][0])

    trim = near
    value = ahead(near)
    if abs(value) > ROUNDING * hull.mesh.length:
        low, high = _bracket(ahead, near, value, heel)
        trim = float(brentq(ahead, low, high, xtol=FINE, rtol=8.9e-16))
    part, lever, depth = _lever(hull, heel, trim)
    return RightingArm(heel, float(lever[1]), trim, depth, part)


def _bracket(
    ahead: Callable[[float], float], near: float, value: float, heel: float
) -> tuple[float, float]:
    """Return two trims between which a lever changes its sign. Raises BadInput without them."""
    before, step = 0.0, FIRST_TRIM
    # A centre of buoyancy that is too far ahead lifts the bow of a hull with a stable trim
    stable = 1.0 if value > 0.0 else -1.0
    while step < 2.0 * MOST_TRIM:
        for side in (stable, -stable):
            other = near + side * step
            if abs(other) < MOST_TRIM and ahead(other) * value <= 0.0:
                return near + side * before, other
        before, step = step, step * WIDER
    raise BadInput(
        f"the hull has no equilibrium at a heel of {np.degrees(heel):.4g} deg: it would stand on "
        "an end"
    )


def _lever(hull: LoadedHull, heel: float, trim: float) -> tuple[Submerged, Array, float]:
    """Return the submerged part, the lever of its centre (3,) [m], and the depth of the origin."""
    depth = depth_of_volume(hull.mesh, hull.volume, heel, trim)
    part = submerged_part(hull.mesh, depth, heel, trim)
    return part, part.centre - part.rotation @ hull.centre, depth


def metacentric_heights(hull: LoadedHull, part: Submerged) -> tuple[float, float]:
    """Return the transverse and the longitudinal metacentric height GM of an upright hull [m].

    Args:
        hull: The hull.
        part: Its submerged part at rest.
    """
    above = float((part.rotation @ hull.centre)[2] - part.centre[2])  # of B above G
    second = part.second / part.volume
    return above + float(second[1, 1]), above + float(second[0, 0])


def righting_arms(hull: LoadedHull, heels: Iterable[float]) -> list[RightingArm]:
    """Return the curve of righting arms, each with the trim nearest to that of the last heel.

    Args:
        hull: The hull.
        heels: Roll angles [rad].
    """
    found: list[RightingArm] = []
    for heel in heels:
        near = found[-1].trim if found else 0.0
        found.append(righting_arm(hull, heel, near))
    return found


def vanishing_angle(hull: LoadedHull, curve: Sequence[RightingArm]) -> float | None:
    """Return the heel beyond which the hull no longer turns upright [rad].

    It is the first heel above zero at which the righting arm falls from positive to negative. None
    if it does so nowhere on the curve.

    Args:
        hull: The hull.
        curve: Its righting arms over increasing heel.
    """
    for before, after in zip(curve[:-1], curve[1:], strict=True):
        if before.heel < 0.0 or before.arm <= 0.0 or after.arm > 0.0:
            continue
        if after.arm == 0.0:
            return after.heel
        low, high, near = before.heel, after.heel, before.trim
        while high - low > STEEPEST:
            middle = righting_arm(hull, 0.5 * (low + high), near)
            if middle.arm > 0.0:
                low, near = middle.heel, middle.trim
            else:
                high = middle.heel
        return 0.5 * (low + high)
    return None
