"""Draw the paths of a diagnosis as an animated SVG picture, for a README.

    python tools/animate_diagnosis.py out/demo docs/diagnosis.svg

It reads report.html (the frames of its replay) and diagnosis.json in the folder of a diagnosis. The
picture shows the recorded path and the free runs of the retuned and the corrected vessel over a
held-out recording in a loop of six seconds. Without animation it shows the last frame. The same
diagnosis gives the same bytes.
"""

import json
import re
import sys
import textwrap
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from boatsim.view.formatting import format_in_one_unit

SECONDS = 6.0  # length of the loop
MOVING = 0.72  # share of the loop in which the boats move; then the last frame stands
FRAMES = 48  # of the motion; between them it is linear
WIDTH, HEIGHT = 880, 400  # [px]
PLOT = 460  # [px] width of the plot; the text stands to the right
MARGIN = 26  # [px] around the plot
LINE = 23  # [px] between two lines of text
LETTERS = 44  # in a line of text
LOOKS = ("recorded", "recalibrated", "patched")  # models in drawing order, as in diagnosis.json
SCALES = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)  # [m]

STYLE = """
svg { color-scheme: light dark; font: 15px system-ui, -apple-system, "Segoe UI", sans-serif; }
.page { fill: #fff; stroke: #dfe3e6; } text { fill: #16202a; } .soft { fill: #55626e; }
.head { font-weight: 650; font-size: 17px; } .key { font-weight: 600; }
.bar { stroke: #55626e; stroke-width: 2; fill: none; }
.path { fill: none; stroke-width: 2.5; stroke-linejoin: round; }
.hull { stroke-width: 2; fill-opacity: .2; }
.mask { fill: none; stroke: #fff; stroke-width: 14; }
.recorded { stroke: #9aa5ae; } .path.recorded { stroke-width: 7; stroke-linecap: round; }
.recalibrated { stroke: #0067b1; } .path.recalibrated { stroke-dasharray: 8 4; }
.patched { stroke: #00815c; } .hull.recorded { fill: #9aa5ae; }
.hull.recalibrated { fill: #0067b1; } .hull.patched { fill: #00815c; }
@media (prefers-color-scheme: dark) {
.page { fill: #181f26; stroke: #2e3841; } text { fill: #e8ecef; } .soft { fill: #a3b0bb; }
.bar { stroke: #a3b0bb; } .recorded { stroke: #7b8893; } .hull.recorded { fill: #7b8893; }
.recalibrated { stroke: #62b5f2; } .hull.recalibrated { fill: #62b5f2; }
.patched { stroke: #35c79a; } .hull.patched { fill: #35c79a; }
}
@media (prefers-reduced-motion: reduce) { * { animation: none !important; } }
"""


class Track(NamedTuple):
    """Motion of one boat on the picture: positions (N, 2) [px] and rotation (N,) [deg]."""

    look: str
    name: str
    places: np.ndarray
    turned: np.ndarray


def animated_picture(folder: Path) -> str:
    """Return the animated SVG picture of the diagnosis in a folder.

    Args:
        folder: Output folder of `boatsim diagnose` or `boatsim demo`.

    Raises:
        SystemExit: The report has no replay of paths seen from above.
    """
    page = (folder / "report.html").read_text(encoding="utf-8")
    answer = json.loads((folder / "diagnosis.json").read_text(encoding="utf-8"))
    film = _film(page, folder)
    tracks, scale, outline = _tracks(film)
    shapes = [_scale_bar(scale)]
    keyframes = []
    for track in tracks:
        shapes.append(_path(track))
        keyframes.append(_path_keyframes(track))
    hull = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in outline) + "Z"
    for track in tracks:
        shapes.append(_hull(track, hull))
        keyframes.append(_hull_keyframes(track))
    label = escape(f"Paths on held-out data. {answer['sentence']}")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="{label}">\n'
        f"<style>{STYLE}{''.join(keyframes)}</style>\n"
        f'<rect class="page" x=".5" y=".5" width="{WIDTH - 1}" height="{HEIGHT - 1}" rx="8"/>\n'
        + "\n".join([*shapes, *_text(answer, tracks, page)])
        + "\n</svg>\n"
    )


def _film(page: str, folder: Path) -> Mapping[str, Any]:
    """Return the frames of the replay on a report's page."""
    found = re.search(r'<script type="application/json">(.*?)</script>', page, re.DOTALL)
    film = json.loads(found[1]) if found else {}
    if not film.get("plan"):
        sys.exit(f"{folder / 'report.html'}: no replay of paths seen from above")
    return film


def _tracks(film: Mapping[str, Any]) -> tuple[list[Track], float, np.ndarray]:
    """Return the tracks of the first free run, the scale [px/m] and the outline of a boat [px]."""
    t = np.array(film["t"], float)
    again = np.flatnonzero(np.diff(t) == 0.0)
    end = len(t) if not len(again) else int(again[0]) + 1
    rows = np.unique(np.linspace(0, end - 1, FRAMES).astype(int))
    outline = np.array(film["outline"])
    boats = {boat["look"]: boat for boat in film["boats"]}
    places = []
    for look in LOOKS:
        boat = boats[look]
        places.append(np.column_stack([_filled(t, boat["x"])[rows], -_filled(t, boat["y"])[rows]]))
    reach = float(np.abs(outline).max())
    low = np.min([p.min(axis=0) for p in places], axis=0) - reach
    high = np.max([p.max(axis=0) for p in places], axis=0) + reach
    room = np.array([PLOT, HEIGHT]) - 2 * MARGIN
    scale = float(np.min(room / (high - low)))
    shift = MARGIN + (room - scale * (high - low)) / 2 - scale * low
    tracks = []
    for look, place in zip(LOOKS, places, strict=True):
        turned = np.degrees(np.unwrap(_filled(t, boats[look]["turned"])[rows]))
        tracks.append(Track(look, boats[look]["name"], shift + scale * place, turned))
    return tracks, scale, scale * outline


def _filled(t: np.ndarray, values: Sequence[float | None]) -> np.ndarray:
    """Return values (N,) with what was not recorded interpolated over the times (N,)."""
    found = np.array(values, float)
    seen = np.isfinite(found)
    return np.interp(t, t[seen], found[seen])


def _path(track: Track) -> str:
    """Return the whole path of a boat; a mask uncovers it as the boat moves."""
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in track.places)
    look = track.look
    return (
        f'<mask id="{look}-mask" maskUnits="userSpaceOnUse" x="0" y="0" width="{WIDTH}" '
        f'height="{HEIGHT}"><path class="mask" id="{look}-cover" pathLength="1" '
        f'stroke-dasharray="1 1.1" d="{d}"/></mask>\n'
        f'<path class="path {look}" mask="url(#{look}-mask)" d="{d}"/>'
    )


def _path_keyframes(track: Track) -> str:
    """Return the keyframes that uncover a path in step with its boat."""
    steps = np.hypot(*np.diff(track.places, axis=0).T)
    done = np.concatenate([[0.0], np.cumsum(steps)]) / max(float(steps.sum()), 1e-9)
    frames = [f"stroke-dashoffset:{1.0 - share:.4f}" for share in done]
    return _keyframes(f"{track.look}-cover", frames)


def _hull(track: Track, outline: str) -> str:
    """Return a boat where it is in the last frame."""
    x, y = track.places[-1]
    return (
        f'<g id="{track.look}-boat" transform="translate({x:.1f} {y:.1f}) '
        f'rotate({track.turned[-1]:.1f})"><path class="hull {track.look}" d="{outline}"/></g>'
    )


def _hull_keyframes(track: Track) -> str:
    """Return the keyframes of the motion of a boat."""
    frames = []
    for (x, y), turned in zip(track.places, track.turned, strict=True):
        frames.append(f"transform:translate({x:.1f}px,{y:.1f}px) rotate({turned:.1f}deg)")
    return _keyframes(f"{track.look}-boat", frames)


def _keyframes(element: str, frames: Sequence[str]) -> str:
    """Return the style that plays the frames of an element, and then holds the last one."""
    shares = 100.0 * MOVING * np.linspace(0.0, 1.0, len(frames))
    lines = [f"{share:.2f}%{{{frame}}}" for share, frame in zip(shares, frames, strict=True)]
    lines.append(f"100%{{{frames[-1]}}}")
    return (
        f"@keyframes {element} {{ {' '.join(lines)} }}\n"
        f"#{element} {{ animation: {element} {SECONDS:g}s linear infinite; }}\n"
    )


def _scale_bar(scale: float) -> str:
    """Return a scale bar of a round length, at the lower left of the plot."""
    length = max([size for size in SCALES if size * scale < PLOT / 4], default=SCALES[0])
    x, y = MARGIN, HEIGHT - MARGIN
    return (
        f'<path class="bar" d="M{x} {y - 4}v8m0 -4h{length * scale:.1f}m0 -4v8"/>'
        f'<text class="soft" x="{x + 4}" y="{y - 9}">{length:g} m</text>'
    )


def _text(answer: Mapping[str, Any], tracks: Sequence[Track], page: str) -> list[str]:
    """Return the legend with the errors of the answer, and what was found."""
    fit = answer["fit"]
    rms = fit["position_rms_m"]
    errors = dict(zip(rms, format_in_one_unit(list(rms.values()), "m"), strict=True))
    x, y = PLOT + MARGIN, 44
    lines = [f'<text class="head" x="{x}" y="{y}">Simulation on held-out data</text>']
    for track in tracks:
        y += LINE + 3
        words = track.name
        if track.look in errors:
            words += f": {errors[track.look]} position error"
        lines.append(
            f'<path class="path {track.look}" d="M{x} {y - 5}h34"/>'
            f'<text class="key" x="{x + 44}" y="{y}">{escape(words)}</text>'
        )
    notes = [
        "retuned: the numbers of the model refitted",
        "corrected: with the effect that it lacked as well",
        f"errors: rms of free runs of {fit['horizon_s']:g} s, {len(fit['held_out'])} recordings",
    ]
    notes += re.findall(r"Boats are drawn[^<]*", page)[:1]
    for note in notes:
        y += LINE - 2
        lines.append(f'<text class="soft" x="{x}" y="{y}">{escape(note)}</text>')
    y += LINE
    for line in textwrap.wrap(answer["sentence"], LETTERS):
        y += LINE
        lines.append(f'<text x="{x}" y="{y}">{escape(line)}</text>')
    return lines


def main() -> None:
    """Write the picture of the folder that the command line names."""
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, picture = map(Path, sys.argv[1:])
    picture.write_text(animated_picture(folder), encoding="utf-8")


if __name__ == "__main__":
    main()
