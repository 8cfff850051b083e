"""Breadth and draught of a hull of known length, beam and mass."""

from boatsim.errors import BadInput
from boatsim.physics.estimate.base import DENSITY, Estimate, HullParticulars
from boatsim.physics.particulars import check_slenderness

# displaced water per length x beam x draught; C_b of a pontoon of the Otter, MSS otter.m
BLOCK = 0.4
PONTOON = 0.25  # beam of one of two hulls per beam overall; Otter 0.25 m of 1.08 m, MSS otter.m
FULLEST = 1.0  # a box


def hull_breadth(beam: float, hulls: int) -> Estimate:
    """Estimate the breadth [m] of one hull of a boat from the beam overall.

    Args:
        beam: Beam overall [m].
        hulls: Number of hulls, 1 or 2.
    """
    if hulls == 1:
        return Estimate(beam, "the boat's own")
    return Estimate(
        PONTOON * beam, f"{PONTOON:g} of the beam for each of two hulls, as the Otter (MSS otter.m)"
    )


def hull_draught(
    length: float, beam: float, mass: float, hulls: int, breadth: float | None = None
) -> Estimate:
    """Estimate the draught [m] at which a boat of given size and mass floats.

    It is the draught at the usual block coefficient of small hulls.

    Args:
        length: Length of the waterline [m].
        beam: Beam overall [m].
        mass: Mass [kg].
        hulls: Number of hulls, 1 or 2.
        breadth: Breadth of one hull [m]; None: estimated.
    """
    value = mass / (DENSITY * BLOCK * hulls * length * (breadth or hull_breadth(beam, hulls).value))
    return Estimate(
        value, f"mass / (rho C_b L B), C_b = {BLOCK:g} as a pontoon of the Otter (MSS otter.m)"
    )


def hull_particulars(
    length: float,
    beam: float,
    mass: float,
    hulls: int,
    stated: float | None,
    breadth: float | None = None,
) -> HullParticulars:
    """Return a boat's main particulars; breadth and, if not given, draught are estimated.

    Args:
        length: Length of the waterline [m].
        beam: Beam overall [m].
        mass: Mass [kg].
        hulls: Number of hulls, 1 or 2.
        stated: Specified draught [m]; None: estimated.
        breadth: Specified breadth of one hull [m]; None: estimated.

    Raises:
        BadInput: Mass and size do not fit together.
    """
    found = HullParticulars(
        length,
        beam,
        mass,
        stated or hull_draught(length, beam, mass, hulls, breadth).value,
        hulls,
        breadth or hull_breadth(beam, hulls).value,
    )
    if found.block_coefficient > FULLEST + 1e-9:
        raise BadInput(
            f"draught = {found.draught:g} m; a boat of {mass:g} kg, {length:g} m by {beam:g} "
            "m, lies at least "
            f"{found.draught * found.block_coefficient:.3g} m deep"
        )
    if found.draught >= 0.5 * length:
        raise BadInput(
            f"mass = {mass:g} kg; a boat of {length:g} m by {beam:g} m would lie "
            f"{found.draught:.3g} m deep; "
            "is the mass in kg?"
        )
    check_slenderness(length, mass)
    return found
