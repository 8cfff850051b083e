"""What a measure is: it turns the log of a run into named numbers that norms.json holds beside the paper's."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from boatsim.errors import BoatsimError
from boatsim.physics.base import Array, Checked
from boatsim.recordings.table import Recording

KINDS = {
    "inf": "largest",
    "max": "largest",
    "largest": "largest",
    "rms": "rms",
    "mean": "mean",
    "l1": "time integral",
    "l2": "root of integrated squares",
    "integral": "time integral",
}  # ending of a norm's name -> what it is


class TooShort(BoatsimError):
    """A log ends before there is what a measure asks of it: that of a run that was interrupted, say."""


@dataclass(frozen=True)
class Measure(Checked):
    """Base of measures: `measure = { use = "arrival", x = 20.0 }` in a scenario makes one and asks it for its values.

    Numbers that people read are in degrees, their unit says so.
    """

    words: ClassVar[str] = ""  # one line for `boatsim list`
    units: ClassVar[Mapping[str, str]] = {}  # norm -> its unit

    def unit(self, norm: str) -> str:
        """Unit of one of its norms; a measure of any signal goes by that signal's."""
        return type(self).units[norm]

    def kind(self, norm: str) -> str:
        """Which value of a signal a norm is: largest, rms, mean, a sum or an integral; "" for what is none of these."""
        return KINDS.get(norm.rpartition("_")[2], "")

    def why(self, norm: str, log: Recording) -> str:
        """Why a run never got as far as a norm asks, in a few words with the figure it got to; "" if unknown."""
        return ""

    def values(self, log: Recording) -> dict[str, float]:
        """Norms of a run; one that the run never got as far as is left out. Raises TooShort if none can be told."""
        raise NotImplementedError


def seen(
    log: Recording, since: float = -inf, until: float = inf, least: int = 1
) -> NDArray[np.bool_]:
    """Which rows (N,) lie between two times [s]. Raises TooShort if they are fewer than `least`."""
    found = (log.t >= since - 1e-9) & (log.t <= until + 1e-9)
    if (count := int(np.count_nonzero(found))) < least:
        raise TooShort(f"{log.name}: {count} rows where at least {least} are needed")
    return np.asarray(found)


def never(x: Array, level: float, unit: str = "") -> str:
    """Why a signal (N,) passed no level: how near it came."""
    x = x[np.isfinite(x)]
    if not len(x):
        return "nothing was recorded of it then"
    near, which = (x.max(), "largest") if x.max() < level else (x.min(), "smallest")
    return f"never got to {level:.4g} {unit}".rstrip() + f": {which} {near:.4g}"


def crossing(t: Array, above: Array) -> float | None:
    """First time [s] at which a signal (N,) is not negative, interpolated between its rows; None if it never is."""
    at = int(np.argmax(above >= 0.0))
    if above[at] < 0.0:
        return None
    if at == 0:
        return float(t[0])
    share = above[at - 1] / (above[at - 1] - above[at])
    return float(t[at - 1] + share * (t[at] - t[at - 1]))


def travelled(log: Recording) -> Array:
    """(N,) integral of the surge speed [m] since the first row, trapezoid rule."""
    u = log["u_mps"]
    return np.concatenate(([0.0], np.cumsum(0.5 * (u[1:] + u[:-1]) * np.diff(log.t))))


def at(log: Recording, time: float, name: str) -> float:
    """Value of a column at a time [s], between the rows."""
    return float(np.interp(time, log.t, log[name]))


def track(log: Recording) -> Array:
    """Distance (N,) travelled up to each row [m]."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(log["x_m"]), np.diff(log["y_m"])))])
