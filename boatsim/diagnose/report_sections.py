"""What the report of a diagnosis says, section by section."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np

from boatsim.diagnose import report_figures as figures
from boatsim.diagnose.findings import Findings, FreeRun, Missing
from boatsim.diagnose.report_blocks import Block, Figures, Heading, Items, Section, Table, Text, without_empty
from boatsim.diagnose.report_words import (
    alike,
    capital,
    listed,
    number,
    parameter,
    percent,
    plain,
    quantity,
    spread,
)

PICTURES = 6  # runs whose missing force is drawn; the strongest ones
UNSEEN_PICTURES = 3  # unseen runs that are drawn
FAMILIES = {  # key of `fit` -> what it is the error of, unit, signal of a free run
    "position_rms_m": ("position", "m", "position"),
    "heading_rms_rad": ("heading", "rad", "psi_rad"),
    "roll_rms_rad": ("roll", "rad", "phi_rad"),
}
MODELS = ("nominal", "recalibrated", "patched")
GLOSSARY = (
    ("nominal, recalibrated, patched",
     "The vessel file as given; the same with its own coefficients refitted; and that with the effects found added. "
     "Gains are judged against the recalibrated vessel, because refitting alone takes up part of any misfit."),
    ("missing force",
     "The force or moment on the hull that the recording shows and the vessel as written has no cause for, estimated "
     "along the run. The band is two standard deviations wide on either side; flagged is where zero lies outside it "
     "and the force is more than the vessel file tolerates."),
    ("unseen data", "Recordings that were kept apart: nothing was fitted to them."),
    ("free run",
     "The simulated boat starts at the state of the real one and is then driven by the recorded commands alone, "
     "without ever looking at the recording again. What it misses by is the error of the model."),
    ("rms", "Root mean square: the size of a quantity that changes, over all of its samples. "
        "In a position x and y count each."),
    ("gain, in nats",
     "How much better an explanation predicts the recordings, as a natural logarithm, the freedom of its extra "
     "parameters paid for. 1 nat is a factor of 2.7, 3 nats 20, 4 nats 55. An effect is named from 4 nats on; entries "
     "within 3 nats of it are its look-alikes."),
    ("probability", "Share of belief that the evidence gives an entry among its rivals and nothing at all."),
    ("\u00b1", "One standard deviation: the true value lies within twice this in 95 of 100 cases."),
    ("surge, sway, roll, yaw", "Forward, to starboard, starboard side down, bow to starboard."),
)  # fmt: skip


def proof(f: Findings) -> str:
    """What the found model gains on unseen data, in a sentence."""
    fit, parts = f.answer["fit"], []
    for key, (words, unit, _) in FAMILIES.items():
        if rms := fit.get(key):
            before, after = alike([rms["recalibrated"], rms["patched"]], unit)
            parts.append((words, before, after, rms["recalibrated"] / max(rms["patched"], 1e-300)))
    if not parts:
        return "Nothing was left to test the finding on: no data was kept unseen."
    stretch = f"{fit['horizon_s']:g} s"
    if not f.answer["effects"]:
        errors = listed(f"{before} in {words}" for words, before, *_ in parts)
        return f"In free runs of {stretch} over unseen data the recalibrated vessel has an rms error of {errors}."
    compared = (f"of {after} in {words} instead of {before} ({_times(gain)})" for words, before, after, gain in parts)
    return (
        f"With this in the model, free runs of {stretch} over unseen data have an rms error {listed(compared)}; the "
        "comparison is with the same vessel after its own coefficients were refitted."
    )


def _times(gain: float) -> str:
    if 0.95 < gain < 1.05:
        return "the same"
    return f"{number(gain, 2)} times smaller" if gain > 1.0 else f"{number(1.0 / gain, 2)} times larger"


def sections_of(f: Findings) -> list[Section]:
    """The whole report in order; sections that have nothing to say are empty."""
    return [
        Section("what", "What was left out", list(_what(f))),
        Section("where", "Where it shows", list(_where(f))),
        Section("proof", "Before and after on unseen data", list(_proof(f))),
        Section("ranking", "Ranking", list(_ranking(f))),
        Section("limits", "Upper limits", list(_limits(f))),
        Section("coefficients", "Refitted coefficients", list(_coefficients(f))),
        Section("next", "What to record next", list(_next(f))),
        Section("cannot", "What this can not tell", list(_cannot(f))),
        Section("more", "Further tables", [Table(t, h, r, _prose(r)) for t, h, r in f.extra_tables]),
        Section("files", "Files", list(_files(f))),
        Section("reading", "How to read this", [Items(GLOSSARY)]),
    ]


def _prose(rows: Sequence[Sequence[str]]) -> tuple[int, ...]:
    """Columns of words, after the first."""
    wordy = {i for row in rows for i, cell in enumerate(row) if i and cell and not any(c.isdigit() for c in cell)}
    return tuple(sorted(wordy))


def _what(f: Findings) -> Iterator[Block]:
    for e in f.answer["effects"]:
        measured = "a measurement error, not physics" if e["kind"] == "measurement" else "physics"
        facts = (
            f"{e['name']} · {measured} · probability {percent(e['probability'])} · gain {number(e['gain_nats'])} nats"
        )
        yield Heading(capital(e["words"]), facts)
        if e["parameters"]:
            header = ["parameter", "value ± deviation", "meaning"]
            yield without_empty(Table("Fitted values", header, _values(f, e), prose=(2,)))
        if e["tied_with"]:
            rivals = (plain(n) + (f" ({f.words[n]})" if n in f.words else "") for n in e["tied_with"])
            yield Text(f"Looks alike in these recordings: {listed(rivals, 'or')}.")
    unknown = f.answer["unknown"]
    if unknown["flag"]:
        yield Heading("Something that no entry of the library explains", f"gain {number(unknown['gain_nats'])} nats")
        yield Text(
            "After the best set of entries, a force of twice the tolerated size is still not enough: the recordings "
            f"call for more, by {number(unknown['gain_nats'])} nats (said from 6 on). Where it acts is shown below."
        )
    elif not f.answer["effects"]:
        yield Text(
            "No entry of the library explains the recordings clearly better than the vessel as it is. What may still "
            "be hidden in them is bounded by the upper limits below."
        )


def _values(f: Findings, effect: dict[str, Any]) -> list[list[str]]:
    rows = []
    for key, p in effect["parameters"].items():
        name, unit = parameter(key, p["unit"])
        rows.append([name, quantity(p["value"], unit, p["sd"]), f.words.get(f"{effect['name']}.{key}", "")])
    return rows


def _where(f: Findings) -> Iterator[Block]:
    where = f.answer["where"]
    if where["region"]:
        rows = [[r["statement"], number(r["p_value"], 1)] for r in where["region"]]
        yield Table("When it acts", ["finding", "chance of seeing this by accident (p)"], rows)
    if where["axes"]:
        header = ["axis", "missing, rms", "its uncertainty, rms"]
        rows = [[axis, *alike([a["rms"], a["sd"]], a["unit"])] for axis, a in where["axes"].items()]
        share = _shares(f)
        if share:
            header = [*header, "share of the time flagged"]
            rows = [[*row, f"{100 * share.get(row[0], 0.0):.0f} %"] for row in rows]
        yield Table("Force and moment that the vessel as written has no cause for", header, rows)
    if f.missing:
        yield from _missing_figures(f)
    if where["intervals"]:
        rows = [[i["run"], i["axis"], *(f"{i[k]:.1f}" for k in ("from_s", "to_s"))] for i in where["intervals"]]
        header = ["run", "axis", "from [s]", "to [s]"]
        yield Table(f"All {len(rows)} flagged intervals", header, rows, (1,), folded=True)


def _shares(f: Findings) -> dict[str, float]:
    """Share of the time of all runs that is flagged, by axis."""
    seconds = sum(float(m.t[-1] - m.t[0]) for m in f.missing)
    flagged: dict[str, float] = {}
    for i in f.answer["where"]["intervals"]:
        flagged[i["axis"]] = flagged.get(i["axis"], 0.0) + (i["to_s"] - i["from_s"]) / seconds if seconds else 0.0
    return flagged if seconds else {}


def _missing_figures(f: Findings) -> Iterator[Block]:
    intervals = f.answer["where"]["intervals"]
    flagged = {m.run: sum(i["to_s"] - i["from_s"] for i in intervals if i["run"] == m.run) for m in f.missing}
    strongest = sorted(f.missing, key=lambda m: -flagged[m.run])[:PICTURES]
    shown: list[Missing] = [m for m in f.missing if m in strongest] if len(f.missing) > PICTURES else list(f.missing)
    looks = {
        "missing": "missing force",
        "left": "what is left of it in the patched vessel",
        "band": "its band of 2 standard deviations",
        "flag": "flagged: zero lies outside the band",
    }
    if not f.answer["effects"]:  # then there is no patch that could leave anything
        shown = [replace(m, left={}) for m in shown]
    if not any(m.left for m in shown):
        del looks["left"]
    yield Figures(figures.legend(looks), figures.missing_figures(shown, intervals, f.missing))
    if len(shown) < len(f.missing):
        yield Text(f"Drawn are the {len(shown)} of {len(f.missing)} runs with the longest flagged time.")


def _proof(f: Findings) -> Iterator[Block]:
    fit = f.answer["fit"]
    rows = [_compared(words, fit[key], unit) for key, (words, unit, _) in FAMILIES.items() if fit.get(key)]
    if rows:
        caption = f"rms error of free runs of {fit['horizon_s']:g} s over {listed(fit['held_out'])}"
        yield Table(caption, ["error in", *MODELS, "better by"], rows)
    runs = [list(group) for _, group in groupby(f.free_runs, key=lambda r: r.run)]
    if len(runs) > 1:
        yield Table("The same, run by run", ["run", *MODELS, "better by"], _by_run(runs))
    if runs:
        looks = {m: m for m in runs[0][0].channels}
        yield Figures(figures.legend(looks), [p for r in runs[:UNSEEN_PICTURES] for p in figures.free_run_figures(r)])
    if len(runs) > UNSEEN_PICTURES:
        yield Text(f"Drawn are the first {UNSEEN_PICTURES} of {len(runs)} unseen runs.")


def _compared(words: str, rms: dict[str, float], unit: str) -> list[str]:
    return [
        words,
        *alike([rms[m] for m in MODELS], unit),
        f"{number(rms['recalibrated'] / max(rms['patched'], 1e-300))} ×",
    ]


def _by_run(runs: Sequence[Sequence[FreeRun]]) -> list[list[str]]:
    rows = []
    for group in runs:
        for words, unit, signal in FAMILIES.values():
            wanted = ("x_m", "y_m") if signal == "position" else (signal,)
            if all(s in group[0].channels["recorded"] for s in wanted):
                errors = {m: np.concatenate([figures.error_of(r, m, signal) for r in group]) for m in MODELS}
                each = 2 if signal == "position" else 1  # both coordinates of a position count
                rms = {m: math.sqrt(float(np.nanmean(e**2)) / each) for m, e in errors.items()}
                rows.append(_compared(f"{group[0].run}, {words}", rms, unit))
    return rows


def _ranking(f: Findings) -> Iterator[Block]:
    candidates = f.answer["candidates"]
    if not candidates:
        return
    status = {n: f"looks like {plain(e['name'])}" for e in f.answer["effects"] for n in e["tied_with"]}
    status |= {e["name"]: "named" for e in f.answer["effects"]}
    rows = [
        [plain(name), number(c["gain_nats"]), percent(c["probability"]), status.get(name, ""), f.words.get(name, "")]
        for c in candidates
        for name in [c["name"]]
    ]
    most = max(max(c["gain_nats"] for c in candidates), 1e-9)
    bars = tuple(max(0.0, c["gain_nats"]) / most for c in candidates)
    caption = (
        "Each entry alone, before any is named: how much better than the recalibrated vessel it explains the fit. "
        "The gain of a named effect above is on top of the others named, all refitted, and so differs"
    )
    header = ["entry", "gain [nats]", "probability", "verdict", "it would mean"]
    yield without_empty(Table(caption, header, rows, (3, 4), bars))


def _limits(f: Findings) -> Iterator[Block]:
    rows = []
    for name, values in f.answer["upper_limits"].items():
        for key, value in values.items():
            words, unit = parameter(key)
            rows.append([plain(name), words, quantity(value, unit)])
    if rows:
        caption = "What was not found: how far from not acting at all the recordings still allow it to be (95 %)"
        yield Table(caption, ["entry", "parameter", "off by at most"], rows, (1,))


def _coefficients(f: Findings) -> Iterator[Block]:
    if not f.coefficients:
        return
    caption = "The nominal structure with its own coefficients refitted: factor on the value in the vessel file"
    changes = {name: f"{100 * (factor - 1):+.1f} %".replace("-", "−") for name, (factor, _) in f.coefficients.items()}
    rows = [[plain(name.replace(".", ", ")), spread(*f.coefficients[name]), change] for name, change in changes.items()]
    yield Table(caption, ["coefficient", "factor ± deviation", "change"], rows)


def _next(f: Findings) -> Iterator[Block]:
    wanted = f.answer["next_experiment"]
    if not wanted:
        return
    yield Text(
        f"{capital(wanted['manoeuvre'])}. It separates {listed(map(plain, wanted['separates']))}: expected evidence "
        f"{number(wanted['expected_gain_nats'])} nats, that is {_odds(wanted['expected_gain_nats'])} for the right one."
    )
    yield Text(f"The manoeuvre is {wanted['scenario']} beside this report; boatsim run {wanted['scenario']} plays it.")


def _odds(nats: float) -> str:
    odds = math.exp(min(max(nats, 0.0), 700.0))
    return f"{float(f'{odds:.1e}'):,.0f} to 1" if odds < 1e5 else "more than 100,000 to 1"


def _cannot(f: Findings) -> Iterator[Block]:
    lines = [
        f"Whether it is {listed(map(plain, (e['name'], *e['tied_with'])), 'or')}: they explain these recordings about "
        "equally well (within a factor of 20)."
        for e in f.answer["effects"]
        if e["tied_with"]
    ]
    if not f.answer["fit"].get("held_out"):
        lines.append("Whether the finding holds on other data: nothing was kept unseen.")
    if lines or f.remarks:
        yield Items(tuple(("", line) for line in (*lines, *f.remarks)))


def _files(f: Findings) -> Iterator[Block]:
    lines = {"diagnosis.json": "all of this as data"}
    if patch := f.answer["patch"]:
        lines[patch] = f"the vessel with what was found; boatsim replay takes it as --vessel {patch}"
    lines["diagnosis.rrd"] = "recording, nominal, recalibrated and patched boat in one scene, for the rerun viewer"
    yield Items(tuple(lines.items()))
