"""Lines of a map that distribute a force and a moment to the drives of a vessel."""

from collections.abc import Mapping, Sequence

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import median_sampling_rate
from boatsim.recordings.importing.signal_classification import Classification

EFFORTS = ("effort_x", "effort_n")  # force ahead and moment to starboard
MIN_SHARE = 1e-6  # smaller shares of a force are rounding


def allocation_lines(
    drives: Sequence[VesselChannel], best: Mapping[str, Sequence[Classification]]
) -> dict[str, str]:
    """Return the lines of fixed drives that together give a force ahead and a moment.

    The thrusts are those of the pseudoinverse of the configuration matrix (Fossen 2021, section
    9.5), without limits, for the log does not show them.

    Args:
        drives: Channels of the vessel.
        best: Column -> classified signals, the most probable first.

    Returns:
        Channel -> line; none if a channel is no fixed drive, or the log has no such orders.
    """
    found = [best[kind][0] for kind in EFFORTS if best.get(kind)]
    if len(found) < len(EFFORTS) or len(drives) < len(EFFORTS):
        return {}
    levers = [drive.lever for drive in drives]
    if None in levers:
        return {}
    configuration = np.array([np.ones(len(drives)), np.array(levers, dtype=float)])
    if np.linalg.matrix_rank(configuration) < len(EFFORTS):
        return {}
    shares = np.linalg.pinv(configuration)
    lines = {}
    for drive, row in zip(drives, shares, strict=True):
        lines[drive.name] = _line(drive, found, row.tolist())
    return lines


def _line(drive: VesselChannel, found: Sequence[Classification], row: Sequence[float]) -> str:
    terms = []
    for g, share in zip(found, row, strict=True):
        if abs(share) > MIN_SHARE:
            sign = "-" if share < 0.0 else ""
            terms.append(toml_value(f"{sign}{g.name} * {abs(share):.6g}"))
    content = f"sum = [{', '.join(terms)}]"
    law = ""
    if drive.coefficients:
        ahead, astern = drive.coefficients
        law = f", coefficient = {ahead:g}, exponent = 2, inverse = true"
        if astern != ahead:
            law = (
                f", coefficient = {ahead:g}, coefficient_below = {astern:g}"
                + law.split(f"{ahead:g}", 1)[1]
            )
    names = " and ".join(g.name for g in found)
    return (
        f"{toml_key(drive.name)} = {{ {content}{law} }}  # "
        f"{median_sampling_rate(found[0].signal.t):.3g} Hz; CHECK: {names} by the vessel's levers "
        "and thrust; add the limits of the program, low and high"
    )
