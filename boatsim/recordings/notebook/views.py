"""Views of one recording: its metadata for Arrow, its figure, and its summary with the replay."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from boatsim.physics.base import Array
from boatsim.recordings.notebook.figures import TRACK, Curve, draw_figure, signal_panels
from boatsim.recordings.notebook.html_table import html_facts_table
from boatsim.recordings.notebook.replay import replay_frame, track_of
from boatsim.recordings.notes import Notes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOUR = "#1f77b4"  # of a single track
MOST_NAMES = 15  # of columns that a summary lists


def table_metadata(name: str, notes: Notes) -> dict[str, str]:
    """Return the texts that describe a recording as a table: its name, vessel and load conditions.

    Args:
        name: Name of the recording.
        notes: Its notes.
    """
    found = {"name": name}
    if notes.vessel:
        found["vessel"] = str(notes.vessel)
    if notes.load:
        found["load"] = ", ".join(notes.load)
    return found


def recording_figure(
    name: str, t: Array, signals: Mapping[str, Array], selected: Sequence[str]
) -> "Figure":
    """Draw the track of a recording seen from above, and selected signals over time.

    Args:
        name: Name of the recording.
        t: Times (N,) [s].
        signals: Name with the unit as suffix -> values (N,).
        selected: Names of the signals to draw over time.

    Raises:
        BadInput: If there is nothing to draw, or matplotlib is not installed.
    """
    track = []
    if set(TRACK) <= signals.keys():
        x, y = signals["x_m"], signals["y_m"]
        known = np.isfinite(x) & np.isfinite(y)
        track.append(Curve("", y[known], x[known]))
    over_time = {}
    for signal in selected:
        known = np.isfinite(signals[signal])
        if known.any():
            over_time[signal] = np.where(known, signals[signal], np.nan)
    return draw_figure(name, track, signal_panels(t, over_time))


def recording_html(name: str, t: Array, signals: Mapping[str, Array], notes: Notes) -> str:
    """Return the summary of a recording for a notebook, with a replay if it has positions.

    Args:
        name: Name of the recording.
        t: Times (N,) [s].
        signals: Name with the unit as suffix -> values (N,).
        notes: Its notes.
    """
    facts = []
    if notes.vessel:
        facts.append(("vessel", " ".join([str(notes.vessel), *notes.load])))
    span = "no rows"
    if len(t):
        span = f"{len(t)} rows from {t[0]:.6g} to {t[-1]:.6g} s"
    facts += [("rows", span), ("columns", _listed(["t_s", *signals]))]
    table = html_facts_table(f"Recording {name}", facts)
    track = track_of(name, COLOUR, t, signals)
    if track is None:
        return table
    return replay_frame(f"Replay of {name}", [track]) + table


def _listed(names: Sequence[str]) -> str:
    """The first names, and the number of the others."""
    text = ", ".join(names[:MOST_NAMES])
    if len(names) > MOST_NAMES:
        text += f" and {len(names) - MOST_NAMES} more"
    return text
