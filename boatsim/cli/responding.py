"""Implementation of `boatsim manoeuvre response`: response operators in regular waves."""

import csv
from collections.abc import Sequence
from math import degrees, pi, radians
from pathlib import Path

import numpy as np

from boatsim.atomic_folder import atomic_folder
from boatsim.cli.exits import Exit, print_lines
from boatsim.cli.metric_table import print_text_table
from boatsim.cli.progress import show_task_progress
from boatsim.errors import BadInput
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.wave_response import (
    WaveResponse,
    deep_water_length,
    largest_responses,
    usual_periods,
    wave_response,
)
from boatsim.view.response_plot import response_plot

CSV, SVG = "response.csv", "response.svg"
DIRECTIONS = (0.0, 45.0, 90.0, 135.0, 180.0)  # [deg]
PERIODS = 16  # number of usual periods
LARGEST_ANGLE = (-360.0, 360.0)  # [deg] of a direction
WAVE_PERIODS = (0.2, 40.0)  # [s] of the modal period of a sea
HEIGHT_SHARE = 0.01  # of the length: so low that the response is linear
FASTEST = 50.0  # [m/s] highest speed of the springs
NOTHING = 1e-9  # [m/m, rad/m] rounding errors
TURNING = ("roll", "pitch", "yaw")


def print_response(
    vessel: str,
    loads: Sequence[str],
    directions: str | None,
    periods: str | None,
    height: float | None,
    waves: str | None,
    out: Path | None,
    speed: float = 0.0,
) -> int:
    """Simulate a vessel in regular waves, print its largest responses and write all of them.

    Args:
        vessel: Name or path of a vessel.
        loads: Load conditions.
        directions: Directions of the waves relative to the bow, "DEG,DEG,..."; None for the usual.
        periods: Periods of the waves, "S,S,..."; None for those of waves of half to ten lengths.
        height: Height of the waves [m]; None for a hundredth of the length.
        waves: Effect by which waves act, "NAME,KEY=VALUE,..."; None for that of the vessel.
        out: Output folder; None for out/VESSEL_response.
        speed: Forward speed [m/s].

    Returns:
        Exit code.

    Raises:
        BadInput: An argument is wrong, or the waves exert no force on the vessel.
    """
    if not 0.0 <= speed <= FASTEST:
        raise BadInput(f"--speed {speed:g}: allowed is a number from 0 to {FASTEST:g} m/s")
    boat = load_vessel(vessel, loads)
    angles: tuple[float, ...] = DIRECTIONS
    if directions is not None:
        angles = _numbers("--directions", directions, LARGEST_ANGLE, "deg")
    times = tuple(usual_periods(boat.length, PERIODS).tolist())
    if periods is not None:
        times = _numbers("--periods", periods, WAVE_PERIODS, "s")
    high = HEIGHT_SHARE * boat.length if height is None else height
    table = None if waves is None else parse_waves(waves)
    folder = out or Path("out") / f"{boat.name}_response"
    with atomic_folder(folder) as new:
        with show_task_progress() as progress:
            found = wave_response(
                boat,
                [radians(angle) for angle in angles],
                sorted(set(times)),
                high,
                table,
                lambda share: progress("simulating regular waves", share, ""),
                speed,
            )
        _write_csv(found, new / CSV)
        (new / SVG).write_text(_plot(found, boat.length), encoding="utf-8")
    _print_largest(found)
    print_lines([f"written to {folder}: {SVG}, {CSV}"])
    return Exit.MET


def parse_waves(text: str) -> dict[str, object]:
    """Return the table of the effect that a text NAME,KEY=VALUE,... describes.

    Args:
        text: The text.

    Raises:
        BadInput: A part is no KEY=VALUE.
    """
    name, *settings = text.split(",")
    table: dict[str, object] = {"use": name.strip()}
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not equals:
            raise BadInput(f"--waves {text}: {setting!r} is no parameter; allowed is KEY=VALUE")
        try:
            table[key.strip()] = float(value)
        except ValueError:
            table[key.strip()] = value.strip()
    return table


def _numbers(option: str, text: str, limits: tuple[float, float], unit: str) -> tuple[float, ...]:
    """Numbers of an option within limits, separated by commas."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        values = ()
    low, high = limits
    if not values or not all(low <= value <= high for value in values):
        raise BadInput(
            f"{option} {text}: allowed are numbers from {low:g} to {high:g} {unit}, separated by "
            "commas"
        )
    return values


def _unit(axis: str) -> str:
    """Unit of the response of a degree of freedom."""
    return "rad/m" if axis in TURNING else "m/m"


def _print_largest(found: WaveResponse) -> None:
    """Print the largest response of each degree of freedom."""
    rows = []
    if found.steady.any():
        for axis, size, period, direction in largest_responses(found):
            row = ["0", "", ""]  # rounding errors of an axis that does not move
            if size > NOTHING:
                row = [f"{size:.3g}", f"{period:.2f}", f"{degrees(direction):.0f}"]
            rows.append([f"{axis} [{_unit(axis)}]", *row])
    head = ["freedom", "largest response", "period [s]", "waves run to [deg]"]
    print_text_table(f"{found.vessel} in regular waves of {found.height:g} m", head, rows, 1)
    speed = f"{found.speed:g} m/s" if found.speed else "zero speed"
    lines = [
        f"Motion per amplitude of the waves at {speed}, held by soft springs.",
        "Directions are relative to the bow: 0 deg for waves from astern, 180 deg from ahead.",
    ]
    unsteady = ~found.steady
    if unsteady.any():
        late = np.broadcast_to(found.periods, unsteady.shape)[unsteady]
        lines.append(
            f"{unsteady.sum()} of {unsteady.size} responses did not become steady and are not "
            f"shown, at periods from {late.min():.3g} to {late.max():.3g} s: motion that is hardly "
            "damped, or a drift of the vessel in the waves"
            + (", or waves that run with it" if found.speed else "")
        )
    print_lines(lines)


def _write_csv(found: WaveResponse, path: Path) -> None:
    """Write a row for each direction and period."""
    head = ["direction_rad", "period_s", "frequency_radps"]
    for axis in found.dof:
        unit = _unit(axis).replace("/", "_per_")
        head += [f"{axis}_{unit}", f"{axis}_phase_rad"]
    with path.open("w", newline="", encoding="utf-8") as file:
        if found.speed:
            file.write(f"# speed = {found.speed:g}\r\n")
        writer = csv.writer(file)
        writer.writerow(head)
        for i, direction in enumerate(found.directions.tolist()):
            for k, period in enumerate(found.periods.tolist()):
                row = [f"{direction:.6g}", f"{period:.6g}", f"{2.0 * pi / period:.6g}"]
                for value in found.operators[i, k]:
                    row += [f"{abs(value):.6g}", f"{np.angle(value):.6g}"]
                writer.writerow(row)


def _plot(found: WaveResponse, length: float) -> str:
    """Figure of all responses over the length of the waves in deep water."""
    title = f"{found.vessel}: response to regular waves of {found.height:g} m"
    if found.speed:
        title += f" at {found.speed:g} m/s"
    return response_plot(
        title,
        [f"{axis} [{_unit(axis)}]" for axis in found.dof],
        "wavelength over length of the vessel",
        deep_water_length(found.periods) / length,
        found.directions,
        np.abs(found.operators),
    )
