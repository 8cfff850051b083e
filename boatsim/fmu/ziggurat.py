"""Tables of the ziggurat method for normal and exponential random numbers, as C source.

G. Marsaglia and W. W. Tsang, The Ziggurat Method for Generating Random Variables, Journal of
Statistical Software 5 (8), 2000. The area under a density is covered by 256 layers of equal area,
the lowest of which contains the tail beyond a radius r. The radii, the number of layers and the
bits of a number are those of NumPy's generator. NumPy's tables have rounding errors of their own,
so that a normal number differs from NumPy's by up to 4e-15; exponential ones are the same.
"""

from collections.abc import Callable
from decimal import Decimal, localcontext
from functools import cache
from typing import NamedTuple

LAYERS = 256
NORMAL_RADIUS = "3.6541528853610087963519472518"  # where 256 layers of equal area close
EXPONENTIAL_RADIUS = "7.6971174701310497140446280481"
NORMAL_BITS, EXPONENTIAL_BITS = 52, 53  # of the position within a layer
DIGITS = 40  # more than twice those of a double, which the recursion over the layers needs
FRACTIONS = 400  # of the continued fraction of the tail: exact to DIGITS at the normal radius


class Ziggurat(NamedTuple):
    """Tables (256,) of a density with the value 1 at 0.

    Attributes:
        sure: Positions below which a number of the layer lies under the density.
        width: Length of a unit of position.
        height: Density at the outer end of the layer.
    """

    sure: list[int]
    width: list[float]
    height: list[float]


def ziggurat(
    radius: Decimal,
    area: Decimal,
    bits: int,
    density: Callable[[Decimal], Decimal],
    inverse: Callable[[Decimal], Decimal],
) -> Ziggurat:
    """Return the tables of a decreasing density.

    Args:
        radius: Where the tail begins.
        area: Area of each layer.
        bits: Number of bits of a position.
        density: The density, 1 at 0.
        inverse: Its inverse function.
    """
    positions = Decimal(2) ** bits
    ends = [radius]  # outer ends of the layers, from the lowest one on
    while len(ends) < LAYERS - 1:
        ends.append(inverse(area / ends[-1] + density(ends[-1])))
    ends.reverse()  # of layers 1 to 255
    lowest = area / density(radius)  # length of a box with the area of the lowest layer
    sure = [int(radius / lowest * positions), 0]
    for inner, outer in zip(ends, ends[1:], strict=False):
        sure.append(int(inner / outer * positions))
    width = [float(end / positions) for end in (lowest, *ends)]
    height = [1.0, *(float(density(end)) for end in ends)]
    return Ziggurat(sure, width, height)


@cache
def normal_ziggurat() -> Ziggurat:
    """Return the tables of the density exp(-x^2 / 2)."""
    with localcontext(prec=DIGITS):
        r = Decimal(NORMAL_RADIUS)
        fraction = r
        for k in range(FRACTIONS, 0, -1):
            fraction = r + k / fraction
        tail = 1 / fraction  # integral beyond r over the density there (Laplace 1805)
        return ziggurat(
            r,
            (r + tail) * (-r * r / 2).exp(),
            NORMAL_BITS,
            lambda x: (-x * x / 2).exp(),
            lambda y: (-2 * y.ln()).sqrt(),
        )


@cache
def exponential_ziggurat() -> Ziggurat:
    """Return the tables of the density exp(-x)."""
    with localcontext(prec=DIGITS):
        r = Decimal(EXPONENTIAL_RADIUS)
        return ziggurat(
            r,
            (r + 1) * (-r).exp(),
            EXPONENTIAL_BITS,
            lambda x: (-x).exp(),
            lambda y: -y.ln(),
        )


def ziggurat_source() -> str:
    """Return the C source of both tables and their radii."""
    lines = [
        f"#define NORMAL_RADIUS {float(NORMAL_RADIUS).hex()}",
        f"#define EXPONENTIAL_RADIUS {float(EXPONENTIAL_RADIUS).hex()}",
    ]
    for name, table in (("NORMAL", normal_ziggurat()), ("EXPONENTIAL", exponential_ziggurat())):
        sure = ", ".join(f"UINT64_C({position})" for position in table.sure)
        lines.append(f"static const uint64_t {name}_SURE[] = {{{sure}}};")
        for part, numbers in (("WIDTH", table.width), ("HEIGHT", table.height)):
            inside = ", ".join(number.hex() for number in numbers)
            lines.append(f"static const double {name}_{part}[] = {{{inside}}};")
    return "\n".join(lines)
