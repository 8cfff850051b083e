"""The same tanker with its anemometer: `python -m validation.real.esso_osaka_wind`, after `...esso_osaka_pond`.

The second mode of that benchmark: the recorded true wind is an input like the rudder, its force by the regression that
lies beside the recordings, so that what is left when the wind is known can be asked. Fitted and judged as there.
"""

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.filter import shared_noise
from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import FreeRun, errors, free_runs
from boatsim.recordings.table import Recording
from validation.real.common import OUT, RECORDINGS, report, runs_of, table
from validation.real.esso_osaka_pond import (
    FITTED,
    HORIZON,
    JUDGED,
    KEPT,
    MODELS,
    TITLE,
    UNITS,
    diagnosed,
    opened,
    print_named,
)
from validation.real.esso_osaka_vessel import NAME, written

CALLED = f"{NAME}_wind"
# [s] of readings taken together: the vessel's rate, in less a hull of 3 m does nothing
STEADY = 0.5


def with_wind(name: str, recording: Recording) -> Recording:
    """A run with its anemometer's columns, the mean of each `STEADY` seconds; the direction without jumps of a turn."""
    d = np.genfromtxt(RECORDINGS / NAME / "wind" / f"{name}.csv", delimiter=",", names=True)
    good = np.isfinite(d["true_speed_mps"]) & np.isfinite(d["true_direction_rad"])
    read = {
        "wind_mps": d["true_speed_mps"][good],
        "wind_from_rad": np.unwrap(d["true_direction_rad"][good]),
    }
    part = np.floor(recording.t / STEADY + 1e-6).astype(int)
    laid = {n: np.interp(recording.t, d["t_s"][good], x) for n, x in read.items()}
    rows = np.maximum(np.bincount(part), 1)
    means = {n: (np.bincount(part, x) / rows)[part] for n, x in laid.items()}
    return replace(recording, signals=recording.signals | means)


def print_against(
    known: Sequence[FreeRun], concealed: Mapping[str, Mapping[str, Mapping[str, float]]]
) -> None:
    """Errors of the three models with the wind as an input, beside those of the first mode where they are kept."""
    rows = []
    for kind in (*JUDGED, ""):
        some = [s for s in known if s.run.startswith(kind)]
        off, before = errors(some), concealed.get(kind, {})
        for family, (what, factor) in UNITS.items():
            now = [off[family][m] * factor for m in MODELS]
            then = [before[family][m] * factor if before else np.nan for m in MODELS]
            cells = [f"{x:.3f}" for pair in zip(then, now, strict=True) for x in pair]
            rows.append(
                [
                    f"{kind or 'all'}, {what}",
                    str(len(some)),
                    *cells,
                    f"{now[2] / now[0]:.2f}",
                    f"{now[2] / then[2]:.2f}",
                ]
            )
    models = [
        f"{m}{end}" for m in ("captive", "recalibrated", "patched") for end in ("", " + wind")
    ]
    table(
        TITLE, ["rms", "free runs", *models, "patched / captive, + wind", "+ wind / without"], rows
    )
    if not concealed:
        print(f"(nothing to lay beside it: validation.real.esso_osaka_pond writes {KEPT})")


def main() -> None:
    """Diagnose with the wind known, judge."""
    begin = time.perf_counter()
    vessel = written(OUT / CALLED / "vessel" / NAME, wind_known=True)
    recordings, boat = opened(runs_of(NAME), str(vessel), with_wind)
    found = diagnosed(recordings, boat)
    report(found, CALLED)
    print_named(found)
    stated = shared_noise(boat, [r for one in recordings.values() for r in one.stretches])
    fitted = [r for n, one in recordings.items() if n.startswith(FITTED) for r in one.stretches]
    judged = [one.whole for n, one in recordings.items() if n.startswith(JUDGED)]
    problem = found.problem.on([found.map_recording(r, stated) for r in fitted])
    fits = {"nominal": found.ranking.nominal}
    fits |= {
        n: converge(problem, getattr(found.ranking, at))
        for n, at in zip(MODELS[1:], ("recalibrated", "best"), strict=True)
    }
    for f, x in zip(fits["recalibrated"].free, fits["recalibrated"].theta, strict=True):
        if f.effect == "measured_wind":
            print(f"  how the hull takes the measured wind: {f.name} x {x:.2f}")
    tracks = [found.map_recording(r, stated) for r in judged]
    concealed = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.is_file() else {}
    print_against(free_runs(problem, fits, tracks, HORIZON), concealed)
    print(f"\n{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
