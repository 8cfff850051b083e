"""A replay of tracks seen from above: one page without further files, for a frame in a notebook."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from math import floor, log10
from pathlib import Path

import numpy as np

from boatsim.physics.base import Array

TEMPLATE = Path(__file__).with_name("replay.html")
MOST_FRAMES = 300  # of a track, which keeps a replay of four boats below 50 kB
SIZE = 1000.0  # units of the drawing along the longer side of the tracks
MARGIN = 70.0  # units around the tracks, room for a boat at their ends
LEAST = 0.25  # of the longer side, the shorter side at least
HEIGHT = 360  # [px] of the drawing
BELOW = 100  # [px] for the slider and the legend
BAR = 0.25  # longest length of the scale bar, as a share of the longer side
# across and along, in units of the drawing; the boat is a mark of fixed size
HULL = ((0, -28), (10, -10), (10, 28), (-10, 28), (-10, -10))
ROUND_MARK = ((0, -10), (9, -5), (9, 5), (0, 10), (-9, 5), (-9, -5))


@dataclass(frozen=True)
class Track:
    """The motion of a boat in a replay.

    Attributes:
        name: Name of the boat.
        colour: Colour in the style sheet language of browsers.
        t: Times (N,) [s]; where a time occurs twice, a new track begins.
        x: North or forward (N,) [m]; rows with nan are not drawn.
        y: East or starboard (N,) [m].
        psi: Heading (N,) [rad]; None if it is unknown.
    """

    name: str
    colour: str
    t: Array
    x: Array
    y: Array
    psi: Array | None

    def thinned(self) -> "Track":
        """Return the track with about `MOST_FRAMES` rows, all of them with a position."""
        known = np.isfinite(self.x) & np.isfinite(self.y)
        if self.psi is not None:
            known &= np.isfinite(self.psi)
        rows = np.flatnonzero(known)
        if len(rows) > MOST_FRAMES:
            starts = 1 + np.flatnonzero(np.diff(self.t[rows]) <= 0.0)
            spread = np.round(np.linspace(0, len(rows) - 1, MOST_FRAMES)).astype(int)
            rows = rows[np.unique(np.concatenate([spread, starts - 1, starts]))]
        psi = self.psi
        if psi is not None:
            psi = psi[rows]
        return Track(self.name, self.colour, self.t[rows], self.x[rows], self.y[rows], psi)


def track_of(name: str, colour: str, t: Array, signals: Mapping[str, Array]) -> Track | None:
    """Return the track of a boat; None if its signals have no position.

    Args:
        name: Name of the boat.
        colour: Its colour.
        t: Times (N,) [s].
        signals: Columns `x_m`, `y_m` and perhaps `psi_rad`, each (N,).
    """
    if not {"x_m", "y_m"} <= signals.keys():
        return None
    track = Track(name, colour, t, signals["x_m"], signals["y_m"], signals.get("psi_rad"))
    track = track.thinned()
    if len(track.t) < 2:
        return None
    return track


def replay_frame(title: str, tracks: Sequence[Track]) -> str:
    """Return the replay of tracks as a frame of HTML, isolated from the page that contains it.

    Its script cannot reach that page, and nothing is loaded from outside.

    Args:
        title: Title of the replay.
        tracks: Thinned tracks, at least one.
    """
    page = escape(_replay_page(title, tracks), quote=True)
    return (
        f'<iframe title="{escape(title)}" sandbox="allow-scripts" srcdoc="{page}" '
        f'style="width:100%;height:{HEIGHT + BELOW}px;border:0"></iframe>'
    )


def _replay_page(title: str, tracks: Sequence[Track]) -> str:
    """The page of a replay: a drawing, from which its script reads the tracks."""
    x, y = (np.concatenate(parts) for parts in zip(*((s.x, s.y) for s in tracks), strict=True))
    left, bottom = float(y.min()), float(x.min())
    across, along = float(np.ptp(y)), float(np.ptp(x))
    extent = max(across, along) or 1.0
    metre = SIZE / extent
    width = max(across, LEAST * extent) * metre + 2 * MARGIN
    height = max(along, LEAST * extent) * metre + 2 * MARGIN
    # the tracks are in the middle of the drawing
    left -= (width / metre - across) / 2
    bottom -= (height / metre - along) / 2
    drawn, legend = [], []
    for track in tracks:
        places = np.column_stack([(track.y - left) * metre, height - (track.x - bottom) * metre])
        drawn.append(_track_path(track, places))
        if len(tracks) > 1:
            mark = f'<span class="key" style="background:{escape(track.colour)}"></span>'
            legend.append(f"<span>{mark}{escape(track.name)}</span>")
    bar = _round_length(BAR * extent)
    hull: tuple[tuple[int, int], ...] = HULL
    if any(track.psi is None for track in tracks):
        hull = ROUND_MARK
    return TEMPLATE.read_text(encoding="utf-8").format(
        title=escape(title),
        height=HEIGHT,
        view_box=f"0 0 {width:.0f} {height:.0f}",
        metre=f"{metre:.6g}",
        tracks="\n".join(drawn),
        bar=f'<path class="bar" d="M20 {height - 30:.0f}v10h{bar * metre:.1f}v-10"/>',
        bar_length=f"{bar:g} m",
        legend="".join(legend),
        hull=json.dumps(hull),
    )


def _track_path(track: Track, places: Array) -> str:
    path = ""
    last = np.inf
    for t, (across, down) in zip(track.t.tolist(), places.tolist(), strict=True):
        letter = "L" if t > last else "M"
        path += f"{letter}{across:.1f} {down:.1f}"
        last = t
    psi = ""
    if track.psi is not None:
        psi = _numbers(track.psi, 3)
    return (
        f'<path class="track" stroke="{escape(track.colour)}" d="{path}" '
        f'data-name="{escape(track.name)}" data-t="{_numbers(track.t, 2)}" data-psi="{psi}"/>'
    )


def _numbers(values: Array, decimals: int) -> str:
    """Numbers separated by blanks, without zeros at their ends."""
    return " ".join(f"{value:.{decimals}f}".rstrip("0").rstrip(".") for value in values.tolist())


def _round_length(longest: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not longer [m]."""
    power = 10.0 ** floor(log10(longest))
    length = power
    for factor in (2.0, 5.0):
        if factor * power <= longest:
            length = factor * power
    return float(f"{length:.3g}")
