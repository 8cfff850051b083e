"""What the report of a diagnosis says, section by section."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np

from boatsim.diagnosis.experiment_design.next_experiment import WORTH
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.locate.residual_structure import FACTOR
from boatsim.diagnosis.report import assumptions, figures, svg_plots
from boatsim.diagnosis.report.answer import SHAPE
from boatsim.diagnosis.report.blocks import (
    Block,
    Figures,
    Heading,
    Items,
    Section,
    Table,
    Text,
    without_empty,
)
from boatsim.diagnosis.report.findings import Findings, Missing
from boatsim.diagnosis.report.formatting import (
    UNTRIED,
    alike,
    capital,
    limit,
    listed,
    nats,
    number,
    parameter,
    percent,
    plain,
    quantity,
    readable,
    said,
    shown,
    spread,
    tried,
)
from boatsim.diagnosis.report.schema import EffectEntry, Family, StructureEntry, TermEntry
from boatsim.diagnosis.search.pruning import ALIKE

INTERVALS = 24  # flagged ones that a table shows; diagnosis.json has all
PICTURES = 6  # runs whose missing force is drawn; the strongest ones
UNSEEN_PICTURES = 3  # unseen runs that are drawn
RANKED = 8  # entries of the ranking, and of the limits, that are seen without asking for the rest
FAMILIES: dict[
    Family, tuple[str, str, str]
] = {  # key of `fit` -> what it is the error of, unit, signal of a free run
    "position_rms_m": ("position", "m", "position"),
    "heading_rms_rad": ("heading", "rad", "psi_rad"),
    "roll_rms_rad": ("roll", "rad", "phi_rad"),
}
MODELS = ("nominal", "recalibrated", "patched")
# times that an error on unseen data must get smaller for a finding to be more than a hint
HELPS = 1.1
GLOSSARY = (
    (
        "nominal, recalibrated, patched",
        "The vessel file as given; the same with its own coefficients refitted; and that with the effects found added. "
        "Gains are judged against the recalibrated vessel, because refitting alone takes up part of any misfit.",
    ),
    (
        "missing force",
        "The force or moment on the hull that the recording shows and the vessel as written has no cause for, estimated "
        "along the run. The band is two standard deviations wide on either side; flagged is where zero lies outside it "
        "and the force is more than moving water makes.",
    ),
    ("unseen data", "Recordings that were kept apart: nothing was fitted to them."),
    (
        "free run",
        "The simulated boat starts at the state of the real one and is then driven by the recorded commands alone, "
        "without ever looking at the recording again. What it misses by is the error of the model.",
    ),
    (
        "rms",
        "Root mean square: the size of a quantity that changes, over all of its samples. "
        "In a position x and y count each.",
    ),
    (
        "gain, in nats",
        "How much better an explanation predicts the recordings, as a natural logarithm, the freedom of its extra "
        "parameters paid for. 1 nat is a factor of 2.7, 3 nats 20, 4 nats 55. An effect is named from 4 nats on if, with "
        "its look-alikes, it gains more than two and the logarithm of the number of entries tried (more tried, "
        "more to gain), and more than a fortieth of what the others explain, which their laws may be off by. Entries "
        "within 3 nats of it are its look-alikes.",
    ),
    (
        "described",
        "A law written down for what no entry of the library explains: the shortest sum of products of "
        "speeds, commands, heading, place and time that the recordings call for, at most five terms. It says what goes "
        "with what, not why. A term has to gain more than two and the logarithm of the number of terms weighed.",
    ),
    (
        "how likely",
        "Of a named effect: how likely it is this one that acts, rather than one of its rivals or nothing, "
        "given the recordings and the other effects named. In the ranking: the same as if it were the only one.",
    ),
    (
        "\u00b1",
        "One standard deviation: the true value is expected within twice this in 95 of 100 cases.",
    ),
    ("surge, sway, roll, yaw", "Forward, to starboard, starboard side down, bow to starboard."),
)


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
    if not f.patched:
        errors = listed(f"{before} in {words}" for words, before, *_ in parts)
        return f"In free runs of {stretch} over unseen data the recalibrated vessel has an rms error of {errors}."
    compared = (
        f"of {after} in {words} instead of {before} ({_times(gain)})"
        for words, before, after, gain in parts
    )
    hint = (
        ""
        if max(gain for *_, gain in parts) > HELPS
        else "Take it for a hint: on unseen data it hardly helps. "
    )
    return (
        f"{hint}With this in the model, free runs of {stretch} over unseen data have an rms error {listed(compared)}; "
        "the comparison is with the same vessel after its own coefficients were refitted."
    )


def _times(gain: float) -> str:
    if 0.95 < gain < 1.05:
        return "the same"
    return (
        f"{number(gain, 2)} times smaller"
        if gain > 1.0
        else f"{number(1.0 / gain, 2)} times larger"
    )


def sections_of(f: Findings) -> list[Section]:
    """The whole report in order; sections that have nothing to say are empty."""
    return [
        Section("log", "The log", list(_log(f))),
        Section("what", "What was found", list(_what(f))),
        Section("taken", "What was tried, and what was taken for granted", list(_taken(f))),
        Section("where", "Where it shows", list(_where(f))),
        Section("ranking", "Ranking", list(_ranking(f))),
        Section("proof", "Before and after on unseen data", list(_proof(f))),
        Section("next", "What to record next", list(_next(f))),
        Section("cannot", "What the data cannot tell", list(_cannot(f))),
        Section("limits", "Upper limits of what was not found", list(_limits(f))),
        Section("coefficients", "Refitted coefficients", list(_coefficients(f))),
        Section("files", "Files", list(_files(f))),
        Section("reading", "How to read this", [Items(GLOSSARY)]),
    ]


def _prose(rows: Sequence[Sequence[str]]) -> tuple[int, ...]:
    """Columns of words, after the first."""
    wordy = {
        i
        for row in rows
        for i, cell in enumerate(row)
        if i and cell and not any(c.isdigit() for c in cell)
    }
    return tuple(sorted(wordy))


def _log(f: Findings) -> Iterator[Block]:
    """What is wrong with the recordings themselves, and the lines that put it right."""
    for e in f.answer.get("log", ()):
        of_whom = e.get("words", "left out or allowed for")
        yield Heading(
            capital(plain(e["name"])), f"{e['run']} · {of_whom} · sure to {percent(e['sure'])}"
        )
        yield Text(f"{capital(e['evidence'])}.")
        written = [("write into recording.toml", " / ".join(e["lines"]))] if e["lines"] else []
        written += [
            (f"or, if {o['words']}", " / ".join(["[columns]", *o["lines"]]))
            for o in e["alternatives"]
        ]
        if written:
            yield Items(tuple(written))
        if "remedy" in e:
            yield Text(f"{capital(e['remedy'])}.")


def _what(f: Findings) -> Iterator[Block]:
    noted = False
    for e in f.answer["effects"]:
        measured = "a measurement error, not physics" if e["kind"] == "measurement" else "physics"
        likely = f"{percent(e['probability'])} likely among its rivals"
        facts = f"{e['name']} · {measured} · {likely} · gain {nats(e['gain_nats'])} nats"
        yield Heading(capital(said(e["words"])), facts)
        if e["parameters"]:
            header = ["parameter", "value ± deviation", "meaning"]
            yield without_empty(Table("Fitted values", header, _values(f, e), prose=(2,)))
            if not noted:
                yield Text(_about_deviations(e))
            noted = True
        if e["tied_with"]:
            rivals = (
                plain(n) + (f" ({_beside(f.words[n])})" if n in f.words else "")
                for n in e["tied_with"]
            )
            yield Text(f"These recordings cannot tell it from {listed(rivals, 'or')}.")
    unknown = f.answer["unknown"]
    if not tried(f.answer):
        yield Text(f"{capital(UNTRIED)}.")
    elif unknown["flag"]:
        yield from _described(f)
        if not f.answer["described"]:
            yield Heading(
                "Something that no entry of the library explains",
                f"gain {nats(unknown['gain_nats'])} nats",
            )
        if unknown["gain_nats"] > unknown["told_from_nats"]:
            yield Text(
                f"After the best set of entries, a random force of {FACTOR:g} times the tolerated size is not "
                f"enough: the recordings call for more, by {nats(unknown['gain_nats'])} nats (said from "
                f"{nats(unknown['told_from_nats'])} on: more where entries explain much, for no law is quite "
                "nature's). Where and when it acts is shown below."
            )
        if "structure" in unknown:
            yield Text(f"{capital(_structure(unknown['structure']))}.")
    elif not f.answer["effects"]:
        yield Text(
            "No entry of the library explains the recordings clearly better than the vessel as it is. What may still "
            "be hidden in them is bounded by the upper limits below."
        )


def _described(f: Findings) -> Iterator[Block]:
    """The laws written down for what no entry explains, each as a curve over what it goes with."""
    for d in f.answer["described"]:
        gain = sum(t["gain_nats"] for t in d["terms"])
        yield Heading(capital(d["statement"]), f"described · gain {nats(gain)} nats")
        rows = [[t["of"], _coefficient(d["axis"], t), nats(t["gain_nats"])] for t in d["terms"]]
        yield Table("Terms", ["goes with", "value ± deviation", "gain [nats]"], rows)
        if d["carries_over"]:
            yield Text(
                "Free runs over unseen recordings get better by it: it is part of the patched vessel."
            )
        else:
            yield Text(
                "Unseen recordings do not bear it out, so that it is no part of the patched vessel."
            )
    if not f.answer["described"]:
        return
    yield Text(
        "No entry of the library explains this. The law is the shortest sum of products of speeds, commands, heading, "
        "place and time that the recordings call for: it says what goes with what, and not why."
    )
    if drawn := [w for w in f.described if w.curve is not None]:
        looks = {
            "patched": "the law",
            "band": "its band of 2 standard deviations",
            "recorded": "what was recorded",
        }
        yield Figures(svg_plots.legend(looks), [figures.law_figure(w) for w in drawn])
        yield Text("Curves end where the recordings end: beyond what was seen the law is a guess.")


def _coefficient(axis: str, term: TermEntry) -> str:
    """Value and deviation of a described term; shares of the thrust in %."""
    if axis == "thrust" and not term["unit"]:
        return f"{spread(100.0 * term['value'], 100.0 * term['sd'])} %"
    return quantity(term["value"], term["unit"], term["sd"])


def _taken(f: Findings) -> Iterator[Block]:
    if lines := assumptions.in_words(f.answer):
        yield Items(tuple(("", capital(f"{line}.")) for line in lines))


def _structure(s: StructureEntry) -> str:
    """What the force left over goes with."""
    often = "a million" if s["p_value"] < 1e-6 else number(1.0 / s["p_value"], 1)
    return (
        f"what is left over in {s['axis']} goes with {s['goes_with']}: a force along with it gains "
        f"{nats(s['gain_nats'])} nats. Of the {s['tried']} things tried one would do so by accident once in {often} "
        "recordings"
    )


def _beside(words: str) -> str:
    """What an entry says, in brackets."""
    return said(words) + ("" if words == said(words) else ", not physics")


def _values(f: Findings, effect: EffectEntry) -> list[list[str]]:
    rows = []
    for key, p in effect["parameters"].items():
        name, text = shown(key, p["value"], p["unit"], p["sd"])
        meaning = f.words.get(f"{effect['name']}.{key}", "")
        rows.append([name, text, "" if meaning == name else meaning])
    return rows


def _about_deviations(effect: EffectEntry) -> str:
    """What is behind the deviations that are printed."""
    turned = any(p["unit"] == "rad" for p in effect["parameters"].values())
    direction = f" ({math.degrees(SHAPE):.1f}° of a direction)" if turned else ""
    return (
        f"± is one standard deviation. Beside what the noise leaves open it holds {100 * SHAPE:g} % of the effect's "
        f"own size{direction}, because the law of an entry never has exactly nature's shape."
    )


def _where(f: Findings) -> Iterator[Block]:
    where = f.answer["where"]
    if where["region"]:
        rows = [
            [capital(readable(r["statement"])), number(r["p_value"], 1)] for r in where["region"]
        ]
        yield Table("When it acts", ["finding", "chance of seeing this by accident (p)"], rows)
    if where["axes"]:
        header = ["axis", "missing, rms", "its uncertainty, rms"]
        rows = [[axis, *alike([a["rms"], a["sd"]], a["unit"])] for axis, a in where["axes"].items()]
        share = _shares(f)
        if share:
            header = [*header, "share of the time flagged"]
            rows = [[*row, f"{100 * share.get(row[0], 0.0):.0f} %"] for row in rows]
        yield Table("Force and moment that the vessel as written has no cause for", header, rows)
        if f.answer["verdict"] == "named" and all(
            e["kind"] == "measurement" for e in f.answer["effects"]
        ):
            yield Text(
                "These forces are not real: they are what the error of measurement looks like."
            )
    if f.missing:
        yield from _missing_figures(f)
    unknown = f.answer["unknown"]
    if where["intervals"]:
        if f.answer["verdict"] == "nothing_missing":
            yield Text(
                "Stretches are flagged one by one, wherever the force leaves what the vessel file tolerates. Together "
                "they are not enough for a verdict: no entry explains them clearly better, and a cause outside the "
                f"library would gain {nats(unknown['gain_nats'])} nats (told from {nats(unknown['told_from_nats'])})."
            )
        every = where["intervals"]
        longest = sorted(every, key=lambda i: i["from_s"] - i["to_s"])[:INTERVALS]
        rows = [
            [i["run"], i["axis"], f"{i['from_s']:.1f}", f"{i['to_s']:.1f}"]
            for i in every
            if i in longest
        ]
        header = ["run", "axis", "from [s]", "to [s]"]
        most = (
            f"All {len(every)}"
            if len(every) == len(rows)
            else f"The {len(rows)} longest of {len(every)}"
        )
        title = "The one flagged interval" if len(every) == 1 else f"{most} flagged intervals"
        yield Table(title, header, rows, (1,), folded=True)


def _shares(f: Findings) -> dict[str, float]:
    """Share of the time of all runs that is flagged, by axis."""
    seconds = sum(float(m.t[-1] - m.t[0]) for m in f.missing)
    flagged: dict[str, float] = {}
    for i in f.answer["where"]["intervals"]:
        flagged[i["axis"]] = (
            flagged.get(i["axis"], 0.0) + (i["to_s"] - i["from_s"]) / seconds if seconds else 0.0
        )
    return flagged if seconds else {}


def _missing_figures(f: Findings) -> Iterator[Block]:
    intervals = f.answer["where"]["intervals"]
    flagged = {
        m.run: sum(i["to_s"] - i["from_s"] for i in intervals if i["run"] == m.run)
        for m in f.missing
    }
    strongest = sorted(f.missing, key=lambda m: -flagged[m.run])[:PICTURES]
    shown: list[Missing] = (
        [m for m in f.missing if m in strongest] if len(f.missing) > PICTURES else list(f.missing)
    )
    looks = {
        "missing": "missing force",
        "left": "what is left of it in the patched vessel",
        "band": "its band of 2 standard deviations",
        "flag": "flagged: zero lies outside the band",
    }
    if not f.patched:  # then there is no patch that could leave anything
        shown = [replace(m, left={}) for m in shown]
    if not any(m.left for m in shown):
        del looks["left"]
    yield Figures(svg_plots.legend(looks), figures.missing_figures(shown, intervals, f.missing))
    if len(shown) < len(f.missing):
        yield Text(
            f"Drawn are the {len(shown)} of {len(f.missing)} runs with the longest flagged time."
        )


def _proof(f: Findings) -> Iterator[Block]:
    fit = f.answer["fit"]
    models = MODELS if f.patched else MODELS[:2]  # a patch that adds nothing is no boat of its own
    header = [*models, "better by"] if f.patched else list(models)
    rows = [
        _compared(words, fit[key], unit)
        for key, (words, unit, _) in FAMILIES.items()
        if fit.get(key)
    ]
    if rows:
        caption = f"rms error of free runs of {fit['horizon_s']:g} s over {listed(fit['held_out'])}"
        yield Table(caption, ["error in", *header], [row[: len(header) + 1] for row in rows])
    free_runs = [
        replace(r, channels={m: c for m, c in r.channels.items() if m in ("recorded", *models)})
        for r in f.free_runs
    ]
    runs = [list(group) for _, group in groupby(free_runs, key=lambda r: r.run)]
    if len(runs) > 1:
        each = [list(group) for _, group in groupby(f.free_runs, key=lambda r: r.run)]
        yield Table(
            "The same, run by run",
            ["run", *header],
            [row[: len(header) + 1] for row in _by_run(each)],
        )
    if runs:
        looks = {m: m for m in runs[0][0].channels}
        yield Figures(
            svg_plots.legend(looks),
            [p for r in runs[:UNSEEN_PICTURES] for p in figures.free_run_figures(r)],
        )
    if len(runs) > UNSEEN_PICTURES:
        yield Text(f"Drawn are the first {UNSEEN_PICTURES} of {len(runs)} unseen runs.")
    for title, names, cells in f.extra_tables:
        yield Table(title, names, cells, _prose(cells), folded=True)


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
                errors = {
                    m: np.concatenate([figures.error_of(r, m, signal) for r in group])
                    for m in MODELS
                }
                each = 2 if signal == "position" else 1  # both coordinates of a position count
                rms = {m: math.sqrt(float(np.nanmean(e**2)) / each) for m, e in errors.items()}
                rows.append(_compared(f"{group[0].run}, {words}", rms, unit))
    return rows


def _ranking(f: Findings) -> Iterator[Block]:
    candidates = f.answer["candidates"]
    if not candidates:
        return
    status = {
        n: f"not to be told from {plain(e['name'])}"
        for e in f.answer["effects"]
        for n in e["tied_with"]
    }
    status |= {e["name"]: "named" for e in f.answer["effects"]}
    rows = [
        [
            plain(name),
            nats(c["gain_nats"]),
            percent(c["probability"]),
            status.get(name, ""),
            f.words.get(name, ""),
        ]
        for c in candidates
        for name in [c["name"]]
    ]
    most = max(max(c["gain_nats"] for c in candidates), 1e-9)
    bars = tuple(max(0.0, c["gain_nats"]) / most for c in candidates)
    caption = (
        "Each entry alone, before any is named: how much better than the recalibrated vessel it explains the runs. "
        "The gain of a named effect above is on top of the others named, all refitted, and so differs. The percentage "
        "answers: if exactly one of these entries, or nothing, were what is missing, how likely is it this one? They "
        "add up to 100 %, so that of several true causes only the strongest gets much"
    )
    header = [
        "entry",
        "gain alone [nats]",
        "how likely, if only one thing is missing",
        "verdict",
        "it would mean",
    ]
    first = max([RANKED, *(i + 1 for i, row in enumerate(rows) if row[3])])
    yield without_empty(Table(caption, header, rows[:first], (3, 4), bars[:first], aside=True))
    if rest := rows[first:]:
        one = "The other entry tried" if len(rest) == 1 else f"The other {len(rest)} entries tried"
        yield without_empty(Table(one, header, rest, (3, 4), bars[first:], folded=True, aside=True))


def _limits(f: Findings) -> Iterator[Block]:
    rows = []
    for name, values in _not_found(f).items():
        told = []
        for key, value in values.items():
            words, text = limit(key, value)
            told.append(f"{_meant(f, name, key) or words} {text}")
        if told:
            rows.append([plain(name), ", ".join(told), f.words.get(name, "")])
    if rows:
        caption = (
            "How far each can be from not acting at all, with 95 % confidence; a factor or share counts from what the "
            "vessel file has"
        )
        header, folded = (
            ["entry", "at most", "it would mean"],
            f.answer["verdict"] != "nothing_missing",
        )
        yield without_empty(Table(caption, header, rows, (1, 2), folded=folded, aside=True))


def _meant(f: Findings, name: str, key: str) -> str:
    """What a parameter of a measurement entry means, which says more than its name: "cos" of a compass."""
    words = f.words.get(name, "")
    return f.words.get(f"{name}.{key}", "") if words != said(words) else ""


def _not_found(f: Findings) -> dict[str, dict[str, float]]:
    """Upper limits without those of look-alikes: what may be there in another's place has none."""
    tied = {n for e in f.answer["effects"] for n in e["tied_with"]}
    return {n: values for n, values in f.answer["upper_limits"].items() if n not in tied}


def _coefficients(f: Findings) -> Iterator[Block]:
    if not f.coefficients:
        return
    caption = "The nominal structure with its own coefficients refitted: factor on the value in the vessel file"
    changes = {
        name: f"{100 * (factor - 1):+.1f} %".replace("-", "−")
        for name, (factor, _) in f.coefficients.items()
    }
    rows = [
        [plain(name.replace(".", ", ")), spread(*f.coefficients[name]), change]
        for name, change in changes.items()
    ]
    yield Table(caption, ["coefficient", "factor ± deviation", "change"], rows)


def _next(f: Findings) -> Iterator[Block]:
    wanted = f.answer["next_experiment"]
    if not wanted:
        if f.answer["effects"]:
            yield Text(
                f"No manoeuvre tried is expected to bring more than {WORTH:g} nat of evidence on what is named and "
                "what could be taken for it."
            )
        return
    gain, scenario = wanted["expected_gain_nats"], wanted["scenario"]
    apart = ["nothing at all" if n == "nothing" else plain(n) for n in wanted["separates"]]
    given = "the commands below" if f.steps else "the start it states"
    yield Items(
        (
            ("Manoeuvre", f"{capital(readable(wanted['manoeuvre']))}."),
            ("Tells apart", f"{capital(listed(apart, 'or'))}."),
            (
                "Expected evidence",
                f"{nats(gain)} nats: {_odds(gain)} for the right one, against the hardest rival.",
            ),
            (
                "How to run it",
                f"boatsim run {scenario} plays it on the vessel as written (it lies beside this report). "
                f"Give the real boat {given}, record it, and diagnose all runs together.",
            ),
        )
    )
    yield from _commands(f)


def _commands(f: Findings) -> Iterator[Block]:
    """When the next experiment commands what; the last row is its end."""
    if not f.steps:
        return
    names = {name: parameter(name) for _, level in f.steps for name in level}
    header = ["from", *(words for words, _ in names.values())]
    rows = []
    for t, level in f.steps:
        cells = (
            shown(n, level[n], unit)[1] if n in level else "" for n, (_, unit) in names.items()
        )
        rows.append([f"{t:g} s", *(cells if level else ["end", *[""] * (len(names) - 1)])])
    yield Table("Commands of the next experiment", header, rows, folded=True)


def _odds(nats: float) -> str:
    odds = math.exp(min(max(nats, 0.0), 700.0))
    return f"{float(f'{odds:.1e}'):,.0f} to 1" if odds < 1e5 else "more than 100,000 to 1"


def _cannot(f: Findings) -> Iterator[Block]:
    lines = [
        f"Whether it is {listed(map(plain, (e['name'], *e['tied_with'])), 'or')}: they explain these recordings about "
        f"equally well (within {ALIKE:g} nats, a factor of {math.exp(ALIKE):.0f})."
        for e in f.answer["effects"]
        if e["tied_with"]
    ]
    if not f.answer["fit"].get("held_out"):
        lines.append("Whether the finding holds on other data: nothing was kept unseen.")
    if silent := [plain(n) for n, values in _not_found(f).items() if not values]:
        lines.append(
            f"How strong {listed(silent, 'or')} could be at most: no limit could be worked out."
        )
    if lines or f.remarks:
        yield Items(tuple(("", line) for line in (*lines, *map(readable, f.remarks))))


def _files(f: Findings) -> Iterator[Block]:
    lines = {"diagnosis.json": "all of this as data"}
    if patch := f.answer["patch"]:
        lines[patch] = (
            f"the vessel with what was found; boatsim replay takes it as --vessel {patch}"
        )
    if wanted := f.answer["next_experiment"]:
        lines[wanted["scenario"]] = "the manoeuvre to record next; boatsim run plays it"
    lines["diagnosis.rrd"] = (
        "recording, nominal, recalibrated and patched boat in one scene, for the rerun viewer"
    )
    yield Items(tuple(lines.items()))
