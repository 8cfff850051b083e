"""What a diagnosis takes for granted before it has seen data: one rule for each number, the same for every boat.

Each rule is a number for a boat of 1.2 m, carried to others by Froude's law: forces with the weight, times and speeds
with the root of the length. A vessel may override one in its [diagnosis] table and must say why; the report prints it.
"""

from collections.abc import Mapping, Sequence
from math import comb

import numpy as np

from boatsim.physics.particulars import GRAVITY
from boatsim.physics.signals import STATE
from boatsim.physics.vessel import Vessel
from boatsim.recordings.table import Recording

SMALL_BOAT = 1.2  # [m] length for which the times below are stated
# of the weight: a force that nobody calls missing physics, rms; 10 mN on a boat of 4.6 kg in a tank
CALM = 2.2e-4
YAW_ARM, PITCH_ARM = 0.25, 0.25  # [lengths] at which that force turns and trims the hull
ROLL_ARM = 1.0  # [draughts] at which it heels her
CORRELATED = 1.0  # [s] over which what the water does is alike
FREE_RUN = 6.0  # [s] of a free run: a boat sails five lengths at a Froude number of 0.3
ROWS = 20.0  # [Hz] of rows that are used: errors of closer ones are not independent
PLENTY, COARSEST = (
    12_000,
    0.25,
)  # rows that tell enough: where there are more, fewer a second, down to this share
# of length, of a radian, of the speed that belongs to the length: no instrument is better
FINEST = 1e-4
ORDERS = range(
    2, 7
)  # of the differences in which noise is looked for: the motion is smoother than that
MEDIAN = 0.455  # of the square of a normal variable
UNCERTAINTY = dict.fromkeys(
    ("damping", "thrust", "restoring", "wind"), 0.05
)  # relative sd where nobody states one


def froude_time(vessel: Vessel) -> float:
    """How much longer everything lasts than on a boat of 1.2 m."""
    return float(np.sqrt(vessel.length / SMALL_BOAT))


def tolerated_force(vessel: Vessel) -> dict[str, float]:
    """Unmodelled force by axis that is nobody's fault, rms [N, N m]."""
    force = CALM * vessel.body.mass * GRAVITY
    arms = {
        "roll": ROLL_ARM * vessel.draught,
        "pitch": PITCH_ARM * vessel.length,
        "yaw": YAW_ARM * vessel.length,
    }
    by_rule = {axis: force * arms.get(axis, 1.0) for axis in vessel.dof}
    return by_rule | {str(axis): rms for axis, rms in vessel.diagnosis.ambient.items()}


def time_constant(vessel: Vessel) -> float:
    """Correlation time [s] of what the water does."""
    return CORRELATED * froude_time(vessel)


def horizon(vessel: Vessel) -> float:
    """Length [s] of a free run, to three digits."""
    return vessel.diagnosis.horizon or float(f"{FREE_RUN * froude_time(vessel):.3g}")


def rate(vessel: Vessel, lasts: float = 0.0) -> float:
    """Rows a second [Hz] that are used of recordings that last so long together [s].

    An hour tells by its many manoeuvres what a minute tells by its many rows, and the cost goes with the rows.
    """
    usual = ROWS / froude_time(vessel)
    return vessel.diagnosis.rate or usual * min(
        1.0, max(COARSEST, PLENTY / max(usual * lasts, 1.0))
    )


def uncertainty(vessel: Vessel) -> dict[str, float]:
    """Relative sd of the vessel's own coefficients, by kind: as stated, else 5 % of those that it has."""
    params = [
        p for e in vessel.effects for p in type(e).params().values() if p.axis in ("", *vessel.dof)
    ]
    there = {p.calibrates for p in params} - {""}
    stated: Mapping[str, float] = {
        str(k): sd for k, sd in vessel.diagnosis.coefficient_uncertainty.items()
    }
    return {k: sd for k, sd in UNCERTAINTY.items() if k in there} | dict(stated)


def sensed_noise(vessel: Vessel, recordings: Sequence[Recording], family: str) -> float:
    """Sd of an instrument's noise from differences of what it recorded, robust to outliers; 0 if it recorded nothing.

    Differences of high order leave little of the motion; that of the order which leaves least is the noise.
    """
    there = [s for s in STATE if s.noise == family and s.axis in vessel.dof]
    signals = [r.signals[s.column] for r in recordings for s in there if s.column in r.signals]
    signals = [y[np.isfinite(y)] for y in signals]
    found = []
    for order in ORDERS:
        squares = [
            np.diff(y, order) ** 2 / comb(2 * order, order)
            for y in signals
            if len(y) > 2 * ORDERS.stop
        ]
        if squares:
            found.append(float(np.sqrt(np.median(np.concatenate(squares)) / MEDIAN)))
    return max(min(found), FINEST * _unit(vessel, there[0].column)) if found else 0.0


def _unit(vessel: Vessel, column: str) -> float:
    """What a column is measured against: the boat's length [m], a radian, and per s for rates."""
    per_second = np.sqrt(GRAVITY / vessel.length) if column.endswith("ps") else 1.0
    return float(per_second * (1.0 if "rad" in column else vessel.length))
