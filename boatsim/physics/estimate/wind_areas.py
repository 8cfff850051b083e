"""Drag areas of the part of a small craft above the water, from its length and beam."""

# Height above the water in beams, and drag coefficients across and along (Fossen 2021, section
# 10.1, after Blendermann 1994: speed boat)
HEIGHT = 0.35
ACROSS = 0.9
ALONG = 0.55


def frontal_drag_area(beam: float) -> float:
    """Estimate the drag area of a small craft in a wind from ahead [m^2].

    Args:
        beam: Beam of the craft [m].
    """
    return ALONG * HEIGHT * beam**2


def lateral_drag_area(length: float, beam: float) -> float:
    """Estimate the drag area of a small craft in a wind on the beam [m^2].

    Args:
        length: Length of the craft [m].
        beam: Beam of the craft [m].
    """
    return ACROSS * HEIGHT * length * beam
