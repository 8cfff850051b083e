"""The Esso Osaka with a known wind: `python -m validation.real.esso_osaka_wind`.

Run `validation.real.esso_osaka_pond` first. This is the second mode of that benchmark: the measured
true wind is an input like the rudder, and its force follows from the regression in vessel.json. It
shows what is missing when the wind is known. Fit and judgement are the same.
"""

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from boatsim.diagnosis.fit import converge
from boatsim.diagnosis.free_runs import FreeRun, free_runs, rms_errors
from boatsim.recordings.table import Recording
from validation.real.common import (
    MODELS,
    OUT,
    RECORDINGS,
    format_fixed,
    print_table,
    print_verdict,
    runs_of,
    scale_errors,
    write_report,
)
from validation.real.esso_osaka_pond import (
    ERRORS_FILE,
    FITTED,
    HORIZON,
    JUDGED,
    TITLE,
    UNITS,
    diagnose,
    mapper_of,
    open_runs,
    runs_of_kind,
)
from validation.real.esso_osaka_vessel import NAME, write_vessel

WIND_NAME = f"{NAME}_wind"
# [s] over which the wind is averaged: the period of the vessel's rate, shorter than any response
# of a hull of 3 m
AVERAGE = 0.5


def with_wind(name: str, recording: Recording) -> Recording:
    """Return a run with the columns of its anemometer.

    The wind is averaged over `AVERAGE` seconds, and its direction is unwrapped.
    """
    d = np.genfromtxt(RECORDINGS / NAME / "wind" / f"{name}.csv", delimiter=",", names=True)
    good = np.isfinite(d["true_speed_mps"]) & np.isfinite(d["true_direction_rad"])
    readings = {
        "wind_mps": d["true_speed_mps"][good],
        "wind_from_rad": np.unwrap(d["true_direction_rad"][good]),
    }
    part = np.floor(recording.t / AVERAGE + 1e-6).astype(int)
    rows = np.maximum(np.bincount(part), 1)
    means = {}
    for signal, x in readings.items():
        at_rows = np.interp(recording.t, d["t_s"][good], x)
        means[signal] = (np.bincount(part, at_rows) / rows)[part]
    return replace(recording, signals=recording.signals | means)


def print_comparison(
    known: Sequence[FreeRun], concealed: Mapping[str, Mapping[str, Mapping[str, float]]]
) -> None:
    """Print the errors of the three models with and without the measured wind.

    Args:
        known: Free runs with the wind as an input.
        concealed: Errors of the first mode by kind of run, signals and model; may be empty.
    """
    rows = []
    for kind in (*JUDGED, ""):
        some = runs_of_kind(known, kind)
        off, before = rms_errors(some), concealed.get(kind)
        for family, (what, factor) in UNITS.items():
            now = scale_errors(off[family], factor)
            then = [np.nan] * len(MODELS)
            if before:
                then = scale_errors(before[family], factor)
            cells = format_fixed(3, *chain.from_iterable(zip(then, now, strict=True)))
            ratios = format_fixed(2, now[2] / now[0], now[2] / then[2])
            rows.append([f"{kind or 'all'}, {what}", str(len(some)), *cells, *ratios])
    header = ["rms", "free runs"]
    for model in ("captive", "retuned", "corrected"):
        header += [model, f"{model} + wind"]
    header += ["corrected / captive, + wind", "+ wind / without"]
    print_table(TITLE, header, rows)
    if not concealed:
        print(f"(no comparison: validation.real.esso_osaka_pond writes {ERRORS_FILE})")


def main() -> None:
    """Diagnose with the known wind, then judge."""
    begin = time.perf_counter()
    file = write_vessel(OUT / WIND_NAME / "vessel" / NAME, wind_known=True)
    runs, vessel = open_runs(runs_of(NAME), str(file), with_wind)
    diagnosis = diagnose(runs, vessel)
    write_report(diagnosis, WIND_NAME)
    print_verdict(diagnosis)
    mapper = mapper_of(diagnosis, runs)
    fitted, judged = [], []
    for name, run in runs.items():
        if name.startswith(FITTED):
            fitted += mapper(run.stretches)
        if name.startswith(JUDGED):
            judged += mapper([run.whole])
    problem = diagnosis.problem.with_recordings(fitted)
    recalibrated = converge(problem, diagnosis.ranking.recalibrated)
    fits = {
        "nominal": diagnosis.ranking.nominal,
        "recalibrated": recalibrated,
        "patched": converge(problem, diagnosis.ranking.best),
    }
    for f, x in zip(recalibrated.free, recalibrated.theta, strict=True):
        if f.effect == "measured_wind":
            print(f"  response of the hull to the measured wind: {f.name} x {x:.2f}")
    concealed = {}
    if ERRORS_FILE.is_file():
        concealed = json.loads(ERRORS_FILE.read_text(encoding="utf-8"))
    print_comparison(free_runs(problem, fits, judged, HORIZON), concealed)
    print(f"\n{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
