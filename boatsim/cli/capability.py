"""Implementation of `boatsim capability`: the largest wind that a vessel can hold, as a plot."""

import csv
from collections.abc import Sequence
from math import degrees
from pathlib import Path

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import Exit, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.control.vessel_model import WindLoads
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.capability import LARGEST_WIND, Capability, capability
from boatsim.view.polar_plot import polar_plot

CSV, SVG = "capability.csv", "capability.svg"


def print_capability(
    vessel: str,
    loads: Sequence[str],
    areas: tuple[float | None, float | None, float | None],
    current: float,
    share: float,
    directions: int,
    lost: Sequence[str] | None,
    out: Path,
) -> int:
    """Compute the capability of a vessel, print a table and write the plot and its numbers.

    Args:
        vessel: Name or path of a vessel.
        loads: Load conditions.
        areas: Frontal and lateral drag area [m^2] and lever of the side force [m]; None for those
            of the vessel.
        current: Speed of the current in the direction of the wind [m/s].
        share: Share of the thrust that may be used.
        directions: Number of directions.
        lost: Thrusters that are lost one at a time; None for every one.
        out: Output folder.

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong, or vessel and arguments do not fit.
    """
    boat = load_vessel(vessel, loads)
    found = capability(boat, _wind_loads(areas), current, share, directions, lost)
    names = ["case", "smallest [m/s]", "from [deg]", "largest [m/s]", "from [deg]"]
    rows = []
    for case, winds in found.winds.items():
        worst, best = int(winds.argmin()), int(winds.argmax())
        row = [case]
        for at in (worst, best):
            row += [_speed_text(float(winds[at])), f"{degrees(found.directions[at]):.0f}"]
        rows.append(row)
    title = f"{found.vessel}: largest wind that the thrusters hold"
    print_text_table(title, names, rows, 1)
    print_lines(
        [
            "Static balance of wind, current and thrust at constant heading, without waves; "
            "directions are those the wind comes from, clockwise from the bow.",
            f"current {current:g} m/s in the direction of the wind, {100 * share:g} % of the "
            "thrust used",
        ]
    )
    with atomic_folder(out) as folder:
        _write_csv(found, folder / CSV)
        words = f"{title}, current {current:g} m/s"
        plot = polar_plot(words, "m/s", found.directions, found.winds)
        (folder / SVG).write_text(plot, encoding="utf-8")
    print_lines([f"written to {out}: {SVG}, {CSV}"])
    return Exit.MET


def _speed_text(speed: float) -> str:
    """Wind speed in words."""
    return f"over {LARGEST_WIND:g}" if speed >= LARGEST_WIND else f"{speed:.1f}"


def _wind_loads(areas: tuple[float | None, float | None, float | None]) -> WindLoads | None:
    """Wind loads from given areas, None without any. Raises BadInput."""
    front, side, arm = areas
    if front is None and side is None and arm is None:
        return None
    if front is None or side is None:
        raise BadInput("--front and --side belong together; give both drag areas in m^2")
    return WindLoads(front, side, arm or 0.0)


def _write_csv(found: Capability, path: Path) -> None:
    """Write a row for each direction, with a column for each case [m/s]."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        head = [f"{case.replace(' ', '_')}_mps" for case in found.winds]
        writer.writerow(["wind_from_rad", *head])
        for i, angle in enumerate(found.directions.tolist()):
            row = [f"{winds[i]:.4f}" for winds in found.winds.values()]
            writer.writerow([f"{angle:.9g}", *row])
