"""Shows what a model gains on data it has not seen, beside the nominal and the recalibrated boat."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import MappedRecording
from boatsim.diagnosis.fit import gauss_newton
from boatsim.diagnosis.free_runs import errors, free_runs
from boatsim.diagnosis.problem import Fit, Problem
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.recordings.table import Recording

MODELS = ("nominal", "recalibrated", "patched")
THIRDS = ("first", "middle", "last")


def split(
    recordings: Sequence[Recording], hold_out: Sequence[Recording]
) -> tuple[list[Recording], list[Recording], str]:
    """Return the recordings to fit, the held-out recordings, and words that state what is held out.

    Without a hold-out the last run is kept, or the middle third of a single run: the tail of a decay would be nearly
    linear and test nothing.
    """
    if hold_out:
        return (
            list(recordings),
            list(hold_out),
            ", ".join(r.name for r in hold_out),
        )
    if len(recordings) > 1:
        last_run = recordings[-1]
        return (
            list(recordings[:-1]),
            [last_run],
            f"{last_run.name}, the last recording, because no other was chosen",
        )
    whole = recordings[0]
    a, b = (float(whole.t[0] + f * (whole.t[-1] - whole.t[0])) for f in (1 / 3, 2 / 3))
    step = float(np.median(np.diff(whole.t)))
    edges = [float(whole.t[0]), a, b, float(whole.t[-1])]
    parts = [whole.between(edges[i] + (0.5 * step if i else 0.0), edges[i + 1]) for i in range(3)]
    first, middle, last = (
        replace(p, name=_third(whole.name, n)) for p, n in zip(parts, THIRDS, strict=True)
    )
    note = f"{a:.1f} to {b:.1f} s, the middle third of the only recording"
    return [first, last], [middle], note


def _third(name: str, which: str) -> str:
    return f"{name} ({which} third)"


def in_time(tracks: Sequence[MappedRecording]) -> list[MappedRecording]:
    """Recordings as they were given, the parts of a single one in the order of time."""
    whole = tracks[0].name.removesuffix(_third("", THIRDS[0]))
    one = {t.name for t in tracks} == {_third(whole, n) for n in THIRDS}
    return sorted(tracks, key=lambda t: float(t.times[0])) if one else list(tracks)


def fits_of(problem: Problem, ranking: Ranking) -> dict[str, Fit]:
    """The three boats that are compared."""
    return {
        "nominal": ranking.nominal,
        "recalibrated": ranking.recalibrated,
        "patched": ranking.best,
    }


def by_part(
    problem: Problem, fits: Mapping[str, Fit], tracks: Sequence[MappedRecording], horizon: float
) -> list[tuple[MappedRecording, str, dict[str, float]]]:
    """(part, family, rms by model) of every part; "alone" is the nominal structure refitted to that part only."""
    out = []
    for track in tracks:
        own = Problem([track], problem.ambient, problem.uncertainty, config=problem.config)
        alone = {"alone": gauss_newton(own, fits["recalibrated"], 6, 0.1)}
        for family, found in errors(
            free_runs(problem, {**fits, **alone}, [track], horizon)
        ).items():
            out.append((track, family, found))
    return out


def table_of(
    parts: Sequence[tuple[MappedRecording, str, dict[str, float]]],
    fitted: Sequence[MappedRecording],
    horizon: float,
) -> tuple[str, list[str], list[list[str]]]:
    """Free-run errors of every part of the data, fitted and unseen: (title, header, rows)."""
    rows = []
    for track, family, found in parts:
        what, unit, scale = _readable(family)
        cells = [f"{found[m] * scale:.3g}" for m in (*MODELS, "alone")]
        seen = "fitted" if any(t is track for t in fitted) else "unseen"
        rows.append(
            [
                track.name,
                seen,
                f"{what} [{unit}]",
                *cells,
                f"{found['patched'] / found['recalibrated']:.2f}",
            ]
        )
    header = [
        "part",
        "data",
        "rms error of",
        *MODELS,
        "nominal refitted to this part alone",
        "patched / recalibrated",
    ]
    return f"Free runs of {horizon:g} s, part by part", header, rows


def remarks(
    parts: Sequence[tuple[MappedRecording, str, dict[str, float]]],
    fitted: Sequence[MappedRecording],
    held_out: Mapping[str, Mapping[str, float]],
    ranking: Ranking,
) -> list[str]:
    """What the data can not tell: parts without the effect, no gain on unseen data, force that stays unexplained."""
    out = []
    if ranking.adds:
        for family, found in held_out.items():
            if found["patched"] > found["recalibrated"]:
                what, unit, scale = _readable(family)
                out.append(
                    f"On unseen data what was added does not help in {what}: {found['patched'] * scale:.3g} {unit}, "
                    f"the recalibrated boat {found['recalibrated'] * scale:.3g} {unit}."
                )
    beside = ranking.description.left_over if ranking.description else ranking.left_over
    if beside > ranking.told_from and ranking.description:
        out.append(
            "A force larger than the tolerated one stays unexplained beside the law that was written down "
            f"({beside:.0f} nats beyond {DEFAULT.locate.disturbance_factor:g} times the ambient force)."
        )
    elif beside > ranking.told_from:
        why = (
            "none of the entries tried accounts for it"
            if ranking.first
            else "nothing was tried to account for it"
        )
        out.append(
            "A force larger than the tolerated one stays unexplained after all this "
            f"({beside:.0f} nats beyond {DEFAULT.locate.disturbance_factor:g} times the ambient force): "
            f"{why}."
        )
    for track in fitted:
        own = [(family, found) for part, family, found in parts if part is track]
        if own and all(f["patched"] >= 0.95 * min(f["alone"], f["recalibrated"]) for _, f in own):
            told = []
            for family, found in own:
                what, unit, scale = _readable(family)
                errors = (f"{found[m] * scale:.2g} {unit}" for m in ("alone", "patched"))
                told.append("the {} to {} (patched boat: {})".format(what, *errors))
            out.append(
                f"{track.name}: the nominal structure, refitted to this part alone, already gives "
                f"{' and '.join(told)}. This part alone does not show what is missing."
            )
    return out


def _readable(family: str) -> tuple[str, str, float]:
    """Words, unit and factor to it, of a family of signals."""
    if family == "position_rms_m":
        return "position", "m", 1.0
    return family.split("_")[0], "deg", float(np.degrees(1.0))
