"""Implementation of `boatsim spectrum`: a spectrum of the sea from a file, or of a scenario."""

from math import degrees, pi
from pathlib import Path

import numpy as np

from boatsim.cli.exits import print_lines
from boatsim.errors import BadInput, escape_for_terminal
from boatsim.hydrodynamics.wave_spectra import WRITERS, read_file, write_file
from boatsim.physics.waves.sea_parameters import SeaParameters
from boatsim.physics.waves.sea_spectrum import spectrum_of_seas, write_spectrum
from boatsim.physics.waves.tabulated import TabulatedSpectrum, read_spectrum
from boatsim.simulate import scenario

TABLE = ".csv"


def convert_spectrum(source: str, kind: str | None, time: int, site: int, out: Path | None) -> int:
    """Print the particulars of a spectrum, and write it to a file.

    Args:
        source: File of a spectrum, or name of a scenario.
        kind: Format of the file as wavespectra has it; None for a table or a scenario.
        time: Number of the time in the file, from 0; -1 for the last one.
        site: Number of the site in the file, from 0.
        out: File to write; None for none.

    Returns:
        Exit code.

    Raises:
        BadInput: The spectrum cannot be read or written.
    """
    allowed = (TABLE, *WRITERS)
    if out is not None and out.suffix.lower() not in allowed:
        raise BadInput(f"--out {out}: allowed are names that end in {', '.join(allowed)}")
    if kind is not None:
        found = read_file(Path(source), kind, time, site)
    elif Path(source).suffix.lower() == TABLE:
        found = read_spectrum(source)
    else:
        found = _of_scenario(source)
    print_lines([escape_for_terminal(source), *_particulars(found)])
    if out is None:
        return 0
    if out.suffix.lower() == TABLE:
        write_spectrum(out, found)
    else:
        write_file(out, found)
    print_lines([escape_for_terminal(f"written to {out}")])
    return 0


def _of_scenario(name: str) -> TabulatedSpectrum:
    loaded = scenario.load(name)
    seas = []
    for effect in loaded.vessel.effects:
        if isinstance(effect, SeaParameters) and effect.significant_height > 0.0:
            seas.append(effect)
    try:
        return spectrum_of_seas(seas)
    except BadInput as error:
        raise BadInput(f"{name}: {error}") from None


def _particulars(found: TabulatedSpectrum) -> list[str]:
    """Lines on height, periods and mean direction of a spectrum."""
    plain = found.over_frequency
    energy = np.trapezoid(plain, found.frequency)
    peak = 2.0 * pi / found.frequency[int(np.argmax(plain))]
    second = np.trapezoid(plain * found.frequency**2, found.frequency)
    crossing = 2.0 * pi * np.sqrt(energy / second)
    lines = [
        f"{len(found.frequency)} frequencies from {found.frequency[0] / (2.0 * pi):.3g} to "
        f"{found.frequency[-1] / (2.0 * pi):.3g} Hz, {len(found.direction)} directions",
        f"significant height {found.significant_height:.4g} m, peak period {peak:.4g} s, "
        f"zero-crossing period {crossing:.4g} s",
    ]
    if len(found.direction):
        over = np.trapezoid(found.density, found.frequency, axis=0)
        widths = (np.roll(found.direction, -1) - np.roll(found.direction, 1)) % (2.0 * pi)
        mean = np.sum(over * widths * np.exp(1j * found.direction))
        lines.append(
            f"waves run to {degrees(np.angle(mean)) % 360.0:.4g} deg on average, clockwise from "
            "north"
        )
    return lines
