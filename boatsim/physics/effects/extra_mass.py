"""Extra mass: a point mass on board that the model does not contain."""

from dataclasses import dataclass
from typing import Any, ClassVar

from numba import njit

from boatsim.physics.base import (
    Boat,
    CoefficientChange,
    CoefficientRelease,
    Force,
    Inertia,
    MassMatrix,
    Wrench,
    mass_matrix,
    param,
    shift_parameter,
    wrench,
)
from boatsim.physics.particulars import GRAVITY


@njit(inline="always")
def inertia(q: Any) -> MassMatrix:
    """Return the mass matrix of a point mass fixed to the hull on its centreline.

    Args:
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Entries of the mass matrix [kg, kg m, kg m^2] about the origin of motion.
    """
    first = q.mass * q.x
    second = first * q.x
    return mass_matrix(
        surge=q.mass,
        sway=q.mass,
        heave=q.mass,
        pitch=second,
        yaw=second,
        heave_pitch=-first,
        sway_yaw=first,
    )


@njit(inline="always")
def law(m: Any, q: Any) -> Wrench:
    """Return the force on the hull of a point mass that it carries.

    It consists of the Coriolis and centripetal force of the motion over ground, and the weight,
    which sinks and trims the hull.

    Args:
        m: Motion of the hull: velocities [m/s], rates [rad/s], position [m], attitude [rad].
        q: Parameters of the effect, with the names and units of its class.

    Returns:
        Force [N] and moment [N m] in body axes.
    """
    v, w = m.v + q.x * m.r, m.w - q.x * m.q
    X = q.mass * (v * m.r - w * m.q)
    Y = q.mass * (w * m.p - m.u * m.r)
    Z = q.mass * (m.u * m.q - v * m.p + GRAVITY)
    return wrench(X=X, Y=Y, Z=Z, M=-q.x * Z, N=q.x * Y)


@dataclass(frozen=True)
class ExtraMass(Inertia, Force):
    """Point mass fixed to the hull on its centreline, at the height of the origin.

    M = m [1, x; x, x^2] in sway and yaw, likewise in heave and pitch; weight m g at x

    m is `mass` [kg], x the distance [m] ahead of the origin.
    """

    formula: ClassVar[str] = (
        r"\begin{aligned} X &= -m \left(\dot u - v_P r + w_P q\right), \quad Y = -m "
        r"\left(\dot{v_P} - w_P p + u r\right) \\ Z &= -m \left(\dot{w_P} - u q + v_P p - "
        r"g\right), \quad M = -x Z, \quad N = x Y \\ v_P &= v + x r, \quad w_P = w - x q "
        r"\end{aligned}"
    )
    symbols: ClassVar = {"mass": "m", "x": "x"}
    needs: ClassVar = ("surge",)
    ruled_out_by: ClassVar = {"weighed": (True,)}
    words: ClassVar[str] = "the boat carries a mass that the model does not contain"
    refines: ClassVar[str] = "inertia"
    adds_to: ClassVar = {"mass": "body.mass"}
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = (
        "T. I. Fossen, Handbook of Marine Craft Hydrodynamics, 2nd ed. 2021, section 3.3"
    )
    moves_with: ClassVar[str] = "hull"
    inertia: ClassVar = inertia
    law: ClassVar = law
    strength: ClassVar = ("mass",)
    starts: ClassVar = ({"mass": 0.7, "x": 0.2}, {"mass": 0.7, "x": -0.2})

    mass: float = param(
        0.0,
        low=0.0,
        high=1e9,
        unit="kg",
        words="mass of the load",
        fit=True,
        spread=1.5,
        within=(0.0, 4.6),
    )
    x: float = param(
        0.0,
        low=-250.0,
        high=250.0,
        unit="m",
        words="place of the load, positive forward",
        fit=True,
        spread=0.3,
        within=(-0.6, 0.6),
    )


@dataclass(frozen=True)
class Payload(CoefficientRelease):
    """Additional mass distributed like that of the hull; the radii of gyration do not change.

    A larger draught changes the added mass as well, which is a separate effect
    (`added_mass_error`).
    """

    formula: ClassVar[str] = (
        r"m = m^0 + \Delta m, \quad I_i = I_i^0 \left(1 + \frac{\Delta m}{m^0}\right), "
        r"\quad i = x, y, z"
    )
    symbols: ClassVar = {"mass": r"\Delta m"}

    # a hull that only rolls identifies the ratio of moment to inertia and nothing else
    needs: ClassVar = ("surge", "sway")
    ruled_out_by: ClassVar = {"weighed": (True,)}
    words: ClassVar[str] = (
        "the boat is heavier than specified, or all its forces are smaller by the same factor"
    )
    refines: ClassVar[str] = "inertia"
    adds_to: ClassVar = {"mass": "body.mass"}
    shown_by: ClassVar[str] = "sharp starts and stops in every axis"
    source: ClassVar[str] = ExtraMass.source
    strength: ClassVar = ("mass",)

    mass: float = shift_parameter(
        "body.mass",
        "body.roll_inertia",
        "body.pitch_inertia",
        "body.yaw_inertia",
        words="mass beyond the specified mass",
        unit="kg",
        spread=1.5,
        low=-1e9,
        high=1e9,
        within=(-2.3, 4.6),
    )

    def changes(self, vessel: Boat) -> list[CoefficientChange]:
        """Return by how much a payload changes the vessel's mass and its specified inertias.

        Args:
            vessel: Vessel on which the effect acts.
        """
        return [c for c in super().changes(vessel) if getattr(vessel.body, c.key) is not None]

    def changes_per_unit(self, vessel: Boat) -> dict[str, float]:
        """Return by how much each moment of inertia changes per unit of added mass [m^2].

        The radii of gyration do not change.

        Args:
            vessel: Vessel on which the effect acts.
        """
        body = vessel.body
        inertias = (
            (f"body.{n}", getattr(body, n))
            for n in ("roll_inertia", "pitch_inertia", "yaw_inertia")
        )
        return {place: inertia / body.mass for place, inertia in inertias if inertia is not None}

    def identifiable_ratios(self, vessel: Boat) -> dict[str, tuple[float, str]]:
        """Return force over mass, the only quantity that the motion identifies about a payload.

        Args:
            vessel: Vessel on which the effect acts.

        Returns:
            Name -> (value relative to the file, meaning in words).
        """
        meaning = (
            "relative to the file: motion identifies only this ratio; weigh the boat for its mass"
        )
        return {"force_per_mass": (vessel.body.mass / (vessel.body.mass + self.mass), meaning)}
