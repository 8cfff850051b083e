"""Response amplitude operators of VERES (ShipX): motions NAME.re1 and excitation NAME.re8.

VERES has x aft, y to starboard and z up, the time factor exp(i w t), and headings of 0 for waves
from ahead. Values refer to the point XMTN aft of amidships and ZMTN above the baseline, which the
file states; the vessel's origin is at its mass centre and in the waterplane. Source of the layout:
the reader of T. I. Fossen's MSS toolbox, read_veres_TF.m.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from boatsim.errors import BadInput
from boatsim.hydrodynamics.rao_table import Complex, RaoTable, complete_table

SUFFIXES = {".re1": "motion", ".re8": "load"}
TEXT_LINES = 6  # at the begin of the file
# Sign of each motion and force in SNAME axes
SIGNS = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
SAME_SPEED = 1e-3  # [m/s]
COUNTS = ("speeds", "headings", "frequencies", "motions")  # whose numbers the file states


def read_veres(path: Path, depth: float, speed: float) -> RaoTable:
    """Read motions or excitation of one forward speed.

    Args:
        path: NAME.re1 or NAME.re8.
        depth: Depth of the water [m]; 0 for deep water.
        speed: Forward speed [m/s], one of those in the file.

    Raises:
        BadInput: The file has another form, or not this speed.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file")
    text = path.read_text(encoding="utf-8", errors="replace").splitlines()[TEXT_LINES:]
    numbers = _numbers(text, path)
    speeds: list[float] = []
    try:
        next(numbers), next(numbers)  # density and gravity
        _, _, draught = next(numbers), next(numbers), next(numbers)
        centre, _ = next(numbers), next(numbers)
        counts = [_count(next(numbers), what, path) for what in COUNTS]
        for _ in range(counts[0]):
            own, _, _, aft, above = (next(numbers) for _ in range(5))
            waves, values = _one_speed(numbers, counts[1:], path)
            speeds.append(own)
            if abs(own - speed) < SAME_SPEED:
                frequency, heading, complete = complete_table(waves, values, path)
                return RaoTable(
                    source=f"VERES, {path.name}",
                    kind="motion" if SUFFIXES[path.suffix.lower()] == "motion" else "load",
                    frequency=frequency,
                    heading=heading,
                    values=complete,
                    depth=depth,
                    speed=own,
                    point=(centre - aft, draught - above),
                )
    except StopIteration:
        raise BadInput(f"{path}: the file ends early") from None
    known = ", ".join(f"{one:g}" for one in speeds)
    raise BadInput(f"{path}: --speed = {speed:g} m/s; the table has {known} m/s")


def _numbers(lines: list[str], path: Path) -> Iterator[float]:
    """Yield all numbers of lines. Raises BadInput."""
    for number, line in enumerate(lines, TEXT_LINES + 1):
        for word in line.split():
            try:
                value = float(word.replace("D", "E"))
            except ValueError:
                value = np.nan
            if not np.isfinite(value):
                raise BadInput(f"{path}:{number}: {word!r} is not a number")
            yield value


def _count(number: float, what: str, path: Path) -> int:
    """Return how many speeds, headings, frequencies or motions follow in a file."""
    if number < 1.0 or number != round(number):
        raise BadInput(f"{path}: {number:g} {what}; allowed is a whole number from 1 on")
    return round(number)


def _one_speed(
    numbers: Iterator[float], counts: list[int], path: Path
) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.float64]], Complex]:
    """Return frequency and direction of each row (R, 2), and its values (R, 6)."""
    headings, frequencies, axes = counts
    waves, rows = [], []
    for _ in range(headings):
        heading = next(numbers)
        for _ in range(frequencies):
            frequency = next(numbers)
            row = np.full(6, np.nan + 0j)
            for _ in range(axes):
                axis, real, imaginary = next(numbers), next(numbers), next(numbers)
                if not 1.0 <= axis <= 6.0:
                    raise BadInput(f"{path}: motion {axis:g}; allowed are 1 to 6")
                row[int(axis) - 1] = real + 1j * imaginary
            waves.append((frequency, np.pi - np.radians(heading)))
            rows.append(row * SIGNS)
    return np.array(waves), np.array(rows)
