"""Motion of a freely floating hull in regular waves, in the frequency domain."""

from dataclasses import dataclass

import numpy as np

from boatsim.errors import BadInput
from boatsim.physics.coefficients.table import Coefficients
from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import Array

ROLL, PITCH = 3, 4  # places among the axes


@dataclass(frozen=True)
class Ballast:
    """Distribution of the mass of a freely floating hull, which weighs what it displaces.

    Its mass centre is above or below the centre of buoyancy.

    Attributes:
        depth: Depth of the mass centre below the waterline, negative above it [m].
        gyradii: Radii of gyration in roll, pitch and yaw about the mass centre [m].
        roll_damping: Damping of roll in addition to that of the radiated waves, as a share of the
            critical damping [-].
    """

    depth: float
    gyradii: tuple[float, float, float]
    roll_damping: float = 0.0

    def words(self, found: Coefficients) -> str:
        """Return the floating hull in words, for the file of its coefficients.

        Args:
            found: Coefficients of the hull.
        """
        roll, pitch, yaw = self.gyradii
        side = "above" if self.depth < 0.0 else "below"
        text = (
            f"freely floating, {found.volume * found.density:.6g} kg, mass centre "
            f"{abs(self.depth):.4g} m {side} the waterline, gyradii {roll:.4g}, {pitch:.4g}, "
            f"{yaw:.4g} m"
        )
        if self.roll_damping > 0.0:
            text += f", further roll damping {self.roll_damping:.4g} of the critical"
        return text


def linear_stiffness(found: Coefficients, mass: float, depth: float) -> Array:
    """Return the hydrostatic stiffness (6, 6) of a floating hull with its weight.

    Args:
        found: Coefficients of the hull.
        mass: Mass of the hull [kg].
        depth: Depth of the mass centre below the origin [m].
    """
    stiffness = found.restoring.copy()
    stiffness[3, 3] += mass * GRAVITY * depth
    stiffness[4, 4] += mass * GRAVITY * depth
    return stiffness


def rigid_body(mass: float, centre: tuple[float, float], inertia: Array) -> Array:
    """Return the mass matrix (6, 6) of a rigid body about the origin.

    Args:
        mass: Mass [kg].
        centre: Mass centre ahead of the origin and below it [m].
        inertia: Moments of inertia (3,) about the mass centre [kg m^2].
    """
    x, z = centre
    lever = np.array([[0.0, -z, 0.0], [z, 0.0, -x], [0.0, x, 0.0]])
    found = np.zeros((6, 6))
    found[:3, :3] = mass * np.eye(3)
    found[:3, 3:] = -mass * lever
    found[3:, :3] = mass * lever
    found[3:, 3:] = np.diag(inertia) - mass * lever @ lever
    return found


def extra_damping(found: Coefficients, body: Array, stiffness: Array, share: float) -> Array:
    """Return a damping matrix (6, 6) with a share of the critical damping in roll.

    The critical damping is 2 sqrt(C (I + A)), with the added mass at the frequency of the table
    that is closest to the natural one.

    Args:
        found: Coefficients of the hull.
        body: Mass matrix (6, 6).
        stiffness: Stiffness (6, 6).
        share: Share of the critical damping [-].
    """
    inertia = body[ROLL, ROLL] + found.added_mass[:, ROLL, ROLL]
    own = int(np.argmin(np.abs(stiffness[ROLL, ROLL] - found.frequency**2 * inertia)))
    damping = np.zeros((6, 6))
    damping[ROLL, ROLL] = share * 2.0 * np.sqrt(stiffness[ROLL, ROLL] * inertia[own])
    return damping


def floating_response(found: Coefficients, ballast: Ballast) -> tuple[Array, Array]:
    """Return the motion of a freely floating hull in waves of unit amplitude.

    Args:
        found: Coefficients of the hull.
        ballast: Distribution of its mass.

    Returns:
        Complex amplitudes (N, H, 6) of the time dependence exp(i w t) [m/m, rad/m], and the damping
        in addition to that of the radiated waves (6, 6).

    Raises:
        BadInput: The hull would capsize.
    """
    mass = found.volume * found.density
    centre = (float(found.buoyancy[0]), ballast.depth)
    body = rigid_body(mass, centre, mass * np.array(ballast.gyradii) ** 2)
    stiffness = linear_stiffness(found, mass, ballast.depth)
    for place, axis in ((ROLL, "roll"), (PITCH, "pitch")):
        if stiffness[place, place] <= 0.0:
            raise BadInput(
                f"the hull capsizes: its stiffness in {axis} is {stiffness[place, place]:.3g} N m "
                f"with --centre-depth = {ballast.depth:g} m"
            )
    extra = extra_damping(found, body, stiffness, ballast.roll_damping)
    w = found.frequency[:, None, None]
    dynamic = stiffness + 1j * w * (found.damping + extra) - w * w * (body + found.added_mass)
    motion = np.linalg.solve(dynamic, np.swapaxes(found.excitation, 1, 2))
    return np.asarray(np.swapaxes(motion, 1, 2)), extra
