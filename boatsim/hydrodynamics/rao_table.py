"""Response amplitude operators over frequency and heading, brought to one convention.

Motions or loads per amplitude of the wave, in SNAME axes (x forward, y to starboard, z down), with
the time factor exp(i w t) for a wave whose crest is at the vessel's origin at t = 0.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BadInput
from boatsim.hydrodynamics.headings import on_starboard_side
from boatsim.physics.signals import AXES, Array
from boatsim.physics.waves.dispersion import wave_number

Complex = NDArray[np.complex128]
Kind = Literal["motion", "load"]
SURGE, SWAY, HEAVE, ROLL, PITCH, YAW = range(6)


@dataclass(frozen=True, eq=False)
class RaoTable:
    """Motions or loads of a vessel per amplitude of regular waves.

    Attributes:
        source: Program and file, in words.
        kind: Whether the values are motions [m/m, rad/m] or loads [N/m, N].
        frequency: Angular frequencies of the waves (N,) [rad/s], increasing.
        heading: Directions (H,) to which the waves run [rad], from 0 to pi, clockwise from x.
        values: Complex values (N, H, 6); nan in the axes that the table does not have.
        depth: Depth of the water [m]; 0 for deep water.
        speed: Forward speed of the vessel [m/s].
        point: Place ahead of the vessel's origin and below it, to which the values and the phase
            of the wave refer [m].
        drift: Mean drift in surge, sway and yaw (N, H, 3) per square of the amplitude, about the
            vessel's origin [N/m^2, N/m]; None if the table has none.

    Raises:
        BadInput: The speed is negative.
    """

    source: str
    kind: Kind
    frequency: Array
    heading: Array
    values: Complex
    depth: float = 0.0
    speed: float = 0.0
    point: tuple[float, float] = (0.0, 0.0)
    drift: Array | None = None

    def __post_init__(self) -> None:
        if self.speed < 0.0:
            raise BadInput(f"{self.source}: speed = {self.speed:g} m/s; allowed is 0 and above")

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the axes that the table has."""
        given = np.asarray(~np.isnan(self.values).any(axis=(0, 1)))
        return tuple(axis for axis, known in zip(AXES, given, strict=True) if known)


def complete_table(waves: Array, values: Complex, path: Path) -> tuple[Array, Array, Complex]:
    """Return a table on a grid of frequencies and headings from 0 to pi.

    Args:
        waves: Frequency and direction of each row (R, 2) [rad/s, rad]; the direction is that to
            which the waves run, clockwise from x.
        values: Complex values of each row (R, 6), nan in axes that are not given.
        path: File, for messages.

    Returns:
        Frequencies (N,), headings (H,) and values (N, H, 6).

    Raises:
        BadInput: A frequency lacks a heading, an axis has a value at some of them only, a frequency
            or direction is not a number, or there are fewer than three frequencies.
    """
    if not np.isfinite(waves).all():
        raise BadInput(f"{path}: a frequency or a direction is not a number")
    if len(waves) == 0:
        raise BadInput(f"{path}: there are no rows")
    frequency = _distinct(waves[:, 0])
    angle = _distinct(waves[:, 1])
    if len(frequency) < 3 or frequency[0] <= 0.0:
        raise BadInput(f"{path}: at least three frequencies above 0 are required")
    grid = np.full((len(frequency), len(angle), 6), np.nan + 0j)
    filled = np.zeros(grid.shape[:2], dtype=bool)
    for (w, direction), row in zip(waves, values, strict=True):
        k = int(np.argmin(np.abs(frequency - w)))
        h = int(np.argmin(np.abs(angle - direction)))
        grid[k, h], filled[k, h] = row, True
    if not filled.all():
        k, h = np.argwhere(~filled)[0]
        raise BadInput(
            f"{path}: every frequency needs the same headings; {frequency[k]:.4g} rad/s lacks "
            f"{np.degrees(angle[h]):.4g} deg"
        )
    refuse_holes(grid, frequency, angle, path)
    heading, complete = on_starboard_side(angle, grid, path)
    return frequency, heading, np.asarray(complete, dtype=complex)


def refuse_holes(values: Complex, frequency: Array, direction: Array, path: Path) -> None:
    """Raise BadInput if an axis has a value for some waves only.

    Args:
        values: Complex values (N, H, 6), nan where there is none.
        frequency: Angular frequencies (N,) [rad/s].
        direction: Directions (H,) [rad].
        path: File, for messages.
    """
    absent = np.isnan(values).all(axis=(0, 1))
    holes = np.argwhere(~np.isfinite(values) & ~absent)
    if len(holes):
        k, h, axis = holes[0]
        raise BadInput(
            f"{path}: {AXES[axis]} has no finite value at {frequency[k]:.4g} rad/s and "
            f"{np.degrees(direction[h]) + 0.0:.4g} deg, and has one at other waves"
        )


def _distinct(values: Array) -> Array:
    """Return the different numbers of a column, increasing; rounding does not count."""
    ordered = np.sort(values)
    scale = max(float(np.abs(ordered).max()), 1.0)
    new = np.append(True, np.diff(ordered) > 1e-5 * scale)
    return np.asarray(ordered[new])


def at_origin(table: RaoTable) -> RaoTable:
    """Return a table that refers to the vessel's origin.

    Args:
        table: A table that refers to any point in the plane of symmetry.

    Raises:
        BadInput: An axis at the origin needs another one that the table does not have.
    """
    x, z = table.point
    old = table.values
    new = old.copy()
    if table.kind == "motion":
        _add(new, SURGE, -z, old[..., PITCH])
        _add(new, SWAY, -x, old[..., YAW])
        _add(new, SWAY, z, old[..., ROLL])
        _add(new, HEAVE, x, old[..., PITCH])
    else:
        _add(new, ROLL, -z, old[..., SWAY])
        _add(new, PITCH, z, old[..., SURGE])
        _add(new, PITCH, -x, old[..., HEAVE])
        _add(new, YAW, x, old[..., SWAY])
    lost = np.isnan(new).any(axis=(0, 1)) & ~np.isnan(old).any(axis=(0, 1))
    if lost.any():
        axis = AXES[int(np.argmax(lost))]
        raise BadInput(
            f"{table.source}: {axis} at the vessel's origin, {-x:g} m ahead of the table's point "
            f"and {-z:g} m below it, needs the other axes too; the table has "
            f"{', '.join(table.axes)}"
        )
    number = np.asarray(wave_number(table.frequency, table.depth))
    shift = np.exp(-1j * x * np.outer(number, np.cos(table.heading)))
    return replace(table, values=new * shift[..., None], point=(0.0, 0.0))


def _add(values: Complex, axis: int, arm: float, other: Complex) -> None:
    """Add a multiple of one axis to another; an arm of 0 adds nothing, also of an unknown axis."""
    if arm != 0.0:
        values[..., axis] += arm * other


def opposite_axes(table: RaoTable) -> tuple[str, ...]:
    """Return the axes whose response to the longest waves opposes that of a floating body.

    In long waves a body follows the surface: exp(i w t) of the elevation gives heave -1, surge and
    sway -i times the direction of the waves, roll i k and pitch -i k times it. The loads have the
    same signs in heave, roll and pitch, where buoyancy dominates, and the opposite ones in surge
    and sway, where the mass does.

    Args:
        table: The table.
    """
    along, across = np.cos(table.heading), np.sin(table.heading)
    flat = 1.0 if table.kind == "motion" else -1.0
    zero = np.zeros(len(along))
    expected = np.stack(
        [
            -1j * flat * along,
            -1j * flat * across,
            -1.0 + zero,
            1j * across,
            -1j * along,
            zero,
        ],
        axis=1,
    )
    agreement = np.sum(np.conj(expected) * table.values[0], axis=0).real
    return tuple(axis for axis, value in zip(AXES, agreement, strict=True) if value < 0.0)
