"""Draw the diagnosis of the tutorial `docs/pendulum.md` for the README.

    python -m tools.draw_pendulum docs/pendulum.svg

It converts the published logs in `tests/data/pendulum`, diagnoses two of them and draws free runs
over the longest stretch of the third. The same diagnosis gives the same bytes.
"""

import sys
import tempfile
import textwrap
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.pipeline import diagnose
from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.mapping import read_map
from boatsim.recordings.importing.several_logs import open_logs
from boatsim.recordings.table import write_csv
from boatsim.view.formatting import format_in_one_unit
from boatsim.view.svg_plots import round_ticks
from tools.animate_diagnosis import LETTERS, LINE, LOOKS, PLOT, STYLE, WIDTH

LOGS = Path(__file__).parents[1] / "tests" / "data" / "pendulum"
FITTED, HELD_OUT = ("ddp", "ilqr"), "pd_fail"
HORIZON = 1.0  # [s] length of a free run
MAP = """\
vessel = "pendulum"

[columns]
phi_rad = "position"
p_radps = "velocity"
torque_Nm = "torque"
"""  # as `boatsim import --propose` writes it
HEIGHT = 330  # [px]
LEFT, TOP, BOTTOM = 52, 26, 44  # [px] around the plot
NAMES = {"recorded": "recorded", "recalibrated": "retuned", "patched": "corrected"}


def diagnosed(folder: Path) -> tuple[Mapping[str, Any], list[FreeRun]]:
    """Return the answer of the diagnosis and the free runs of the longest held-out stretch.

    Args:
        folder: Where the recordings are written.
    """
    map_file = folder / "map.toml"
    map_file.write_text(MAP, encoding="utf-8")
    for name in (*FITTED, HELD_OUT):
        log = open_logs([LOGS / f"{name}.csv"])
        write_csv(convert_log(log, read_map(map_file), str(map_file), {}), folder / f"{name}.csv")
    fitted = [folder / f"{name}.csv" for name in FITTED]
    held_out = [folder / f"{HELD_OUT}.csv"]
    found = diagnose(fitted, held_out, "pendulum", horizon=HORIZON).findings
    stretches: dict[str, list[FreeRun]] = {}
    for run in found.free_runs:
        stretches.setdefault(run.run, []).append(run)
    return found.answer, max(stretches.values(), key=len)


def picture(answer: Mapping[str, Any], runs: Sequence[FreeRun]) -> str:
    """Return the SVG picture of free runs, with their errors and what was found.

    Args:
        answer: Content of diagnosis.json.
        runs: Free runs one after another.
    """
    begin, end = runs[0].t[0], runs[-1].t[-1]
    every = np.concatenate(
        [np.degrees(c["phi_rad"]) for run in runs for c in run.channels.values()]
    )
    low, high = float(np.nanmin(every)), float(np.nanmax(every))

    def across(t: Any) -> Any:
        return LEFT + (t - begin) / (end - begin) * (PLOT - LEFT)

    def down(angle: Any) -> Any:
        return TOP + (high - angle) / (high - low) * (HEIGHT - TOP - BOTTOM)

    shapes = []
    for angle in round_ticks(low, high, 5):
        y = down(angle)
        shapes.append(f'<path class="grid" d="M{LEFT} {y:.1f}H{PLOT}"/>')
        shapes.append(
            f'<text class="soft" text-anchor="end" x="{LEFT - 7}" y="{y + 5:.1f}">{angle:g}°</text>'
        )
    for t in round_ticks(float(begin), float(end), 6):
        shapes.append(
            f'<text class="soft" text-anchor="middle" x="{across(t):.1f}" '
            f'y="{HEIGHT - BOTTOM + 22}">{t:g} s</text>'
        )
    for look in LOOKS:
        d = ""
        for run in runs:
            points = zip(
                across(run.t), down(np.degrees(run.channels[look]["phi_rad"])), strict=True
            )
            d += "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points if np.isfinite(y))
        shapes.append(f'<path class="path {look}" d="{d}"/>')
    for run in runs:
        x, y = across(run.t[0]), down(np.degrees(run.channels["patched"]["phi_rad"][0]))
        shapes.append(f'<circle class="start" cx="{x:.1f}" cy="{y:.1f}" r="4"/>')
    label = escape(f"Roll on held-out data. {answer['sentence']}")
    style = STYLE + ".grid { stroke: #8886; } .start { fill: #55626e; stroke: none; }"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="{label}">\n'
        f"<style>{style}</style>\n"
        f'<rect class="page" x=".5" y=".5" width="{WIDTH - 1}" height="{HEIGHT - 1}" rx="8"/>\n'
        + "\n".join([*shapes, *_text(answer)])
        + "\n</svg>\n"
    )


def _text(answer: Mapping[str, Any]) -> list[str]:
    """The legend with the errors of the answer, and what was found."""
    rms = answer["fit"]["roll_rms_rad"]
    degrees = [float(np.degrees(value)) for value in rms.values()]
    errors = dict(zip(rms, format_in_one_unit(degrees, "°"), strict=True))
    x, y = PLOT + 26, 38
    lines = [f'<text class="head" x="{x}" y="{y}">A real log, held out: a pendulum</text>']
    for look in LOOKS:
        y += LINE + 1
        words = NAMES[look]
        if look in errors:
            words += f": {errors[look]} roll error"
        lines.append(
            f'<path class="path {look}" d="M{x} {y - 5}h34"/>'
            f'<text class="key" x="{x + 44}" y="{y}">{escape(words)}</text>'
        )
    y += LINE - 2
    lines.append(
        f'<text class="soft" x="{x}" y="{y}">Free runs of {HORIZON:g} s begin at the dots.</text>'
    )
    y += 8
    for line in textwrap.wrap(answer["sentence"], LETTERS + 6):
        y += LINE - 4
        lines.append(f'<text x="{x}" y="{y}" font-size="14">{escape(line)}</text>')
    return lines


def main() -> None:
    """Write the picture to the file that the command line names."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        answer, runs = diagnosed(Path(folder))
    Path(sys.argv[1]).write_text(picture(answer, runs), encoding="utf-8")


if __name__ == "__main__":
    main()
