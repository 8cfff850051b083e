"""Sections of the report of a diagnosis."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import repeat

import numpy as np

from boatsim.diagnosis.evaluation import MODELS
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.report import figures, svg_plots
from boatsim.diagnosis.report.blocks import (
    Block,
    Figures,
    Heading,
    Items,
    Note,
    Section,
    Table,
    Text,
    without_empty_columns,
)
from boatsim.diagnosis.report.confirmation import effect_sentences, recalibration_sentences
from boatsim.diagnosis.report.families import FAMILIES
from boatsim.diagnosis.report.findings import Findings, MissingForceCurve
from boatsim.diagnosis.report.formatting import (
    capitalize,
    evidence_strength,
    format_cause_probability,
    format_evidence,
    format_in_one_unit,
    format_nats,
    format_number,
    format_odds,
    format_parameter,
    format_probability,
    format_quantity,
    format_sentence,
    format_upper_limit,
    format_with_sd,
    join_words,
    name_and_unit,
    short_odds,
    words_of_name,
)
from boatsim.diagnosis.report.glossary import glossary
from boatsim.diagnosis.report.model_names import MODEL_WORDS, words_of_models
from boatsim.diagnosis.report.schema import (
    EffectEntry,
    IntervalEntry,
    LogEntry,
    ParameterEntry,
    StructureEntry,
    TermEntry,
)
from boatsim.diagnosis.report.sentences import (
    any_tested,
    assumption_sentences,
    effect_description,
    effects_of_kind,
    held_out_only,
    improvement_on_held_out,
    in_per_cent,
    none_tested_reason,
    only_measurement_errors,
    refined_rows,
)

STATISTICS = "Statistics behind this"  # title of a note
MOST_INTERVALS = 24  # rows of the table of flagged intervals; diagnosis.json has all of them
MOST_MISSING_FIGURES = 6  # recordings whose missing force is drawn: those flagged longest
MOST_HELD_OUT_FIGURES = 3  # held-out recordings that are drawn
MOST_VISIBLE_CANDIDATES = 8  # rows of the ranking that are not folded
FREE_RUN_SIGNALS = {"position": "position", "heading": "psi_rad", "roll": "phi_rad"}


def sections_of(f: Findings) -> list[Section]:
    """Return all sections of the report of a diagnosis, in their order.

    Args:
        f: Findings of a diagnosis.

    Returns:
        The sections; those without content have no blocks.
    """
    return [
        Section("log", "Problems of the recordings", list(_log_problems(f))),
        Section("what", "Missing physics", list(_missing_physics(f))),
        Section("refined", "Numbers refined", list(_refined(f))),
        Section("possible", "Also possible", list(_also_possible(f))),
        Section("taken", "Candidates and assumptions", list(_assumptions(f))),
        Section("where", "Where and when a force is missing", list(_missing_force(f))),
        Section("ranking", "Ranking of the candidate effects", list(_ranking(f))),
        Section("proof", "Validation on held-out recordings", list(_validation(f))),
        Section("next", "What to record next", list(_next_experiment(f))),
        Section("cannot", "What these recordings cannot show", list(_limitations(f))),
        Section("limits", "Upper limits of effects that were not found", list(_limits(f))),
        Section("coefficients", "Coefficients of the model", list(_coefficients(f))),
        Section("files", "Files", list(_files(f))),
        Section("reading", "How to read this report", [Items(glossary(f))]),
    ]


def _log_problems(f: Findings) -> Iterator[Block]:
    """Yield the problems of the recordings with their corrections, and the measurement errors."""
    for e in f.answer.get("log", ()):
        cause = e.get("words", "corrected or allowed for by the diagnosis")
        facts = f"{f.name_of(e['run'])} · {cause} · probability {format_probability(e['sure'])}"
        yield Heading(capitalize(words_of_name(e["name"])), facts)
        yield Text(f"{capitalize(e['evidence'])}.")
        if corrections := _corrections(e):
            yield Items(corrections)
        if "remedy" in e:
            yield Text(f"{capitalize(e['remedy'])}.")
    yield from _effects(f, "measurement")


def _corrections(e: LogEntry) -> tuple[tuple[str, str], ...]:
    lines = []
    if e["lines"]:
        lines.append(("Write into recording.toml", " / ".join(e["lines"])))
    for other in e["alternatives"]:
        lines.append((f"Or, if {other['words']}", " / ".join(["[columns]", *other["lines"]])))
    return tuple(lines)


def _missing_physics(f: Findings) -> Iterator[Block]:
    """Yield the effects that the model lacks, the formulas, and what remains unexplained."""
    yield from _effects(f, "physics")
    unknown = f.answer["unknown"]
    if not any_tested(f.answer):
        yield Text(f"{capitalize(none_tested_reason(f.answer))}.")
    elif unknown["flag"]:
        yield from _unexplained(f)
    elif not f.answer["effects"]:
        yield Text(
            "No candidate effect explains the recordings clearly better than the vessel model "
            "alone. The upper limits below state how strong each effect could be at most."
        )


def _effects(f: Findings, kind: str) -> Iterator[Block]:
    """Yield the identified effects of a kind; the first of all explains the deviations."""
    explained = _first_with_parameters(f)
    for effect in effects_of_kind(f.answer, kind):
        yield from _effect(f, effect, explain_deviation=effect is explained)


def _first_with_parameters(f: Findings) -> EffectEntry | None:
    """Return the first effect of the page that has fitted values, None if there is none."""
    effects = effects_of_kind(f.answer, "measurement") + effects_of_kind(f.answer, "physics")
    for effect in effects:
        if effect["parameters"]:
            return effect
    return None


def _refined(f: Findings) -> Iterator[Block]:
    """Yield the numbers of the vessel file that the recordings improve."""
    rows = refined_rows(f.answer)
    if not rows:
        return
    yield Text(
        "The vessel file calls these numbers estimates. The recordings give better values, which "
        "are in the corrected vessel. They are no faults of the boat or of the log."
    )
    header = ["number", "before", "after ± deviation", "off by"]
    yield Table("Numbers of the vessel file", header, rows)


def _also_possible(f: Findings) -> Iterator[Block]:
    """Yield the effects that may act but that these recordings do not confirm."""
    for entry in f.answer.get("also_possible", []):
        likely = format_cause_probability(entry["probability"])
        facts = f"{entry['name']} · {likely}"
        yield Heading(capitalize(effect_description(entry["words"])), facts)
        yield Text(f"{capitalize(entry['why'])}.")
        yield Note(STATISTICS, f"{capitalize(_statistics(entry['gain_nats']))}.")
        if parameters := entry.get("parameters"):
            header = ["parameter", "value ± deviation", "meaning"]
            rows = _values(f, entry["name"], parameters)
            caption = "Values as patched.toml contains them"
            yield without_empty_columns(Table(caption, header, rows, prose=(2,)))


def _effect(f: Findings, e: EffectEntry, explain_deviation: bool) -> Iterator[Block]:
    kind = "measurement error" if e["kind"] == "measurement" else "physics"
    likely = format_cause_probability(e["probability"])
    yield Heading(capitalize(effect_description(e["words"])), f"{e['name']} · {kind} · {likely}")
    if ratios := in_per_cent([e]):
        yield Text(" ".join(f"{capitalize(ratio)}." for ratio in ratios))
    if e["parameters"]:
        header = ["parameter", "value ± deviation", "meaning"]
        rows = _values(f, e["name"], e["parameters"])
        yield without_empty_columns(Table("Fitted values", header, rows, prose=(2,)))
    if sentences := _held_out_sentences(f, e):
        yield Text(" ".join(sentences))
    statistics = f"{capitalize(_statistics(e['gain_nats']))}."
    if explain_deviation:
        statistics += f" {_about_deviations(f, e)}"
    yield Note(STATISTICS, statistics)
    if e["tied_with"]:
        rivals = []
        for name in e["tied_with"]:
            rivals.append(words_of_name(name))
            if name in f.words:
                rivals[-1] += f" ({_meaning(f.words[name])})"
        yield Text(f"These recordings cannot distinguish it from {join_words(rivals, 'or')}.")


def _held_out_sentences(f: Findings, effect: EffectEntry) -> list[str]:
    """Return what an effect does on held-out data, unless the top of the page has its numbers."""
    top = improvement_on_held_out(f)
    for family, pair in effect.get("alone", {}).items():
        before, after = format_in_one_unit([pair["without"], pair["with"]], FAMILIES[family][1])
        if f"{after} in {FAMILIES[family][0]} instead of {before}" not in top:
            return effect_sentences(effect)
    if effect.get("confirmed", True):
        return []
    return effect_sentences(effect)


def _statistics(gain_nats: float) -> str:
    """Return evidence in words, as odds and in nats."""
    return f"{format_evidence(gain_nats)}: a log Bayes factor of {format_nats(gain_nats)} nats"


def _values(f: Findings, effect: str, parameters: Mapping[str, ParameterEntry]) -> list[list[str]]:
    """Return name, value and meaning of each fitted parameter of an effect."""
    rows = []
    for key, p in parameters.items():
        name, text = format_parameter(key, p["value"], p["unit"], p["sd"])
        meaning = f.words.get(f"{effect}.{key}", "")
        if meaning == name:
            meaning = ""
        rows.append([name, text, meaning])
    return rows


def _meaning(words: str) -> str:
    """Return the description of an effect for use in brackets."""
    if words == effect_description(words):
        return words
    return f"{effect_description(words)}, not physics"


def _about_deviations(f: Findings, effect: EffectEntry) -> str:
    """Return what the printed standard deviations include."""
    law_error = f.setting("answer.law_error")
    direction = ""
    for p in effect["parameters"].values():
        if p["unit"] == "rad":
            direction = f" ({math.degrees(law_error):.1f}° of a direction)"
    return (
        "± is one standard deviation. In addition to the uncertainty from noise it includes "
        f"{100 * law_error:g} % of the effect's own size{direction}, because the law of a "
        "candidate is never exactly that of nature."
    )


def _unexplained(f: Findings) -> Iterator[Block]:
    """Yield the formulas for what no candidate explains, and the evidence for an unknown cause."""
    unknown, factor = f.answer["unknown"], f.setting("locate.disturbance_factor")
    yield from _formulas(f)
    if not f.answer["described"]:
        facts = format_evidence(unknown["gain_nats"])
        yield Heading("A force that no candidate effect explains", facts)
    if unknown["gain_nats"] > unknown["told_from_nats"]:
        yield Text(
            "Even with all identified effects, the recordings require an additional random force "
            f"of more than {factor:g} times the assumed disturbance level: "
            f"{format_evidence(unknown['gain_nats'])}. The section on the missing force shows "
            "where and when the force acts."
        )
    elif sentence := held_out_only(f.answer):
        yield Text(f"{capitalize(sentence)}.")
    yield Note(
        STATISTICS,
        f"The additional force has an evidence of {format_nats(unknown['gain_nats'])} nats. Such a "
        f"force is reported from {format_nats(unknown['told_from_nats'])} nats on. This threshold "
        "increases with the evidence that the identified effects explain, because their laws are "
        "never exact.",
    )
    if "structure" in unknown:
        yield Text(_structure(unknown["structure"]))


def _structure(s: StructureEntry) -> str:
    """Return what the unexplained force varies with."""
    often = "a million"
    if s["p_value"] >= 1e-6:
        often = format_number(1.0 / s["p_value"], 1)
    return (
        f"The unexplained force in {s['axis']} varies with {s['goes_with']}. One of the "
        f"{s['tried']} quantities tested would appear to do so by chance once in {often} "
        "recordings."
    )


def _formulas(f: Findings) -> Iterator[Block]:
    """Yield each formula with its terms, and its curve over the quantity that it varies with."""
    for law in f.answer["described"]:
        gain, rows = 0.0, []
        for term in law["terms"]:
            gain += term["gain_nats"]
            value = _coefficient(law["axis"], term)
            rows.append([term["of"], value, short_odds(term["gain_nats"])])
        yield Heading(capitalize(law["statement"]), f"formula · {format_evidence(gain)}")
        header = ["varies with", "value ± deviation", "odds of chance"]
        yield Table("Terms", header, rows)
        if law["carries_over"]:
            yield Text(
                "It reduces the errors of free runs over held-out recordings. Therefore it is part "
                "of the corrected vessel."
            )
        else:
            yield Text(
                "Held-out recordings do not confirm it. Therefore it is no part of the corrected "
                "vessel."
            )
    if not f.answer["described"]:
        return
    yield Text(
        "No candidate effect explains this force. The formula is the shortest sum of products of "
        "speeds, commands, heading, position and time that explains it. It states what the force "
        "varies with; it does not state the cause."
    )
    drawn = [figures.term_figure(w) for w in f.described if w.curve is not None]
    if drawn:
        looks = {
            "patched": "formula",
            "band": "band of 2 standard deviations",
            "recorded": "recorded",
        }
        yield Figures(svg_plots.legend(looks), drawn)
        yield Text("The formula is valid only within the recorded range of these quantities.")


def _coefficient(axis: str, term: TermEntry) -> str:
    """Return value and deviation of a term of a formula; a share of the thrust in %."""
    if axis == "thrust" and not term["unit"]:
        return f"{format_with_sd(100.0 * term['value'], 100.0 * term['sd'])} %"
    return format_quantity(term["value"], term["unit"], term["sd"])


def _assumptions(f: Findings) -> Iterator[Block]:
    lines = []
    for line in assumption_sentences(f.answer):
        lines.append(f"{capitalize(line)}.")
    yield from _bullets(lines)


def _bullets(lines: Sequence[str]) -> Iterator[Block]:
    if lines:
        yield Items(tuple(zip(repeat(""), lines)))


def _missing_force(f: Findings) -> Iterator[Block]:
    """Yield the conditions, the sizes, the curves and the intervals of the missing force."""
    where, verdict = f.answer["where"], f.answer["verdict"]
    if where["region"]:
        rows = []
        for region in where["region"]:
            statement = capitalize(format_sentence(region["statement"]))
            rows.append([statement, format_number(region["p_value"], 1)])
        header = ["condition", "probability of chance (p-value)"]
        yield Table("When the force is missing", header, rows)
    if where["axes"]:
        yield _strengths(f)
        if only_measurement_errors(f.answer):
            yield Text("These forces are not real: they are the result of the measurement error.")
    if f.missing:
        yield from _missing_figures(f)
    if not where["intervals"]:
        return
    if verdict == "nothing_missing":
        unknown = f.answer["unknown"]
        yield Text(
            "An interval is flagged wherever the missing force exceeds the assumed disturbance "
            "level. Together the intervals are not enough for a finding: no candidate effect "
            "explains them clearly better than the vessel model alone, and the evidence for a "
            "cause outside the candidates is not sufficient."
        )
        yield Note(
            STATISTICS,
            f"A cause outside the candidates gains {format_nats(unknown['gain_nats'])} of the "
            f"{format_nats(unknown['told_from_nats'])} nats required.",
        )
    yield _interval_table(where["intervals"])


def _strengths(f: Findings) -> Table:
    """Return the table of the missing force of each axis."""
    header, share = ["axis", "missing, rms", "standard deviation, rms"], _flagged_shares(f)
    if share:
        header.append("share of the time flagged")
    rows = []
    for axis, strength in f.answer["where"]["axes"].items():
        row = [axis, *format_in_one_unit([strength["rms"], strength["sd"]], strength["unit"])]
        if share:
            row.append(f"{100 * share.get(axis, 0.0):.0f} %")
        rows.append(row)
    return Table("Force and moment that the retuned vessel does not explain", header, rows)


def _interval_table(intervals: Sequence[IntervalEntry]) -> Table:
    """Return the folded table of the longest flagged intervals, in the order of the answer."""
    longest = sorted(intervals, key=lambda i: i["from_s"] - i["to_s"])[:MOST_INTERVALS]
    rows = []
    for i in intervals:
        if i in longest:
            rows.append([i["run"], i["axis"], f"{i['from_s']:.1f}", f"{i['to_s']:.1f}"])
    title = f"The {len(rows)} longest of {len(intervals)} flagged intervals"
    if len(intervals) == 1:
        title = "The flagged interval"
    elif len(intervals) == len(rows):
        title = f"All {len(rows)} flagged intervals"
    header = ["recording", "axis", "from [s]", "to [s]"]
    return Table(title, header, rows, (1,), folded=True)


def _flagged_shares(f: Findings) -> dict[str, float]:
    """Return the share of the time of all recordings that is flagged, by axis."""
    seconds = sum(float(m.t[-1] - m.t[0]) for m in f.missing)
    flagged: dict[str, float] = {}
    if not seconds:
        return flagged
    for i in f.answer["where"]["intervals"]:
        flagged[i["axis"]] = flagged.get(i["axis"], 0.0) + (i["to_s"] - i["from_s"]) / seconds
    return flagged


def _missing_figures(f: Findings) -> Iterator[Block]:
    """Yield the missing force over time of the recordings that are flagged longest."""
    intervals = f.answer["where"]["intervals"]
    flagged = {m.run: 0.0 for m in f.missing}
    for interval in intervals:
        if interval["run"] in flagged:
            flagged[interval["run"]] += interval["to_s"] - interval["from_s"]
    order = sorted(range(len(f.missing)), key=lambda i: -flagged[f.missing[i].run])
    drawn: list[MissingForceCurve] = []
    for i in sorted(order[:MOST_MISSING_FIGURES]):
        drawn.append(f.missing[i])
        if not f.has_added_effects:  # the corrected vessel is the retuned one
            drawn[-1] = replace(f.missing[i], left={})
    looks = {
        "missing": "missing force",
        "left": "missing force of the corrected vessel",
        "band": "band of 2 standard deviations",
        "flag": "flagged: the band does not contain zero",
    }
    if not any(m.left for m in drawn):
        del looks["left"]
    yield Figures(svg_plots.legend(looks), figures.missing_figures(drawn, intervals, f.missing))
    if len(drawn) < len(f.missing):
        yield Text(
            f"The figures show the {len(drawn)} of {len(f.missing)} recordings that are flagged "
            "longest."
        )


def _validation(f: Findings) -> Iterator[Block]:
    """Yield the errors of free runs over held-out recordings, and their figures."""
    fit = f.answer["fit"]
    models: tuple[str, ...] = MODELS[:2]
    header = words_of_models(models)
    if f.has_added_effects:
        models, header = MODELS, [*words_of_models(MODELS), "error reduced by factor"]
    rows = []
    for key, (words, unit) in FAMILIES.items():
        if rms := fit.get(key):
            rows.append(_error_row(words, rms, unit)[: len(header) + 1])
    if rows:
        caption = (
            f"rms error of free runs of {fit['horizon_s']:g} s over {join_words(fit['held_out'])}"
        )
        yield Table(caption, ["error in", *header], rows)
    if sentences := recalibration_sentences(f):
        yield Text(" ".join(sentences))
    by_run = figures.group_by_recording(f.free_runs)
    if len(by_run) > 1:
        rows = []
        for runs in by_run:
            for row in _errors_of_run(runs):
                rows.append(row[: len(header) + 1])
        yield Table("Each recording by itself", ["recording", *header], rows, folded=True)
    drawn = []
    for runs in by_run[:MOST_HELD_OUT_FIGURES]:
        drawn += figures.free_run_figures(_select_models(runs, models))
    if by_run:
        names = _select_models(by_run[0], models)[0].channels
        yield Figures(svg_plots.legend({name: MODEL_WORDS[name] for name in names}), drawn)
    if len(by_run) > MOST_HELD_OUT_FIGURES:
        yield Text(
            f"The figures show the first {MOST_HELD_OUT_FIGURES} of {len(by_run)} held-out "
            "recordings."
        )
    for title, names_of_columns, cells in f.extra_tables:
        yield Table(title, names_of_columns, cells, _text_columns(cells), folded=True)


def _select_models(runs: Sequence[FreeRun], models: Sequence[str]) -> list[FreeRun]:
    """Return free runs with the channels of the recording and of these models."""
    kept = []
    for run in runs:
        channels = {m: c for m, c in run.channels.items() if m in ("recorded", *models)}
        kept.append(replace(run, channels=channels))
    return kept


def _text_columns(rows: Sequence[Sequence[str]]) -> tuple[int, ...]:
    """Return the columns, after the first, that have any cell of words without a digit."""
    columns = set()
    for row in rows:
        for i, cell in enumerate(row[1:], 1):
            if cell and not any(map(str.isdigit, cell)):
                columns.add(i)
    return tuple(sorted(columns))


def _error_row(words: str, rms: dict[str, float], unit: str) -> list[str]:
    """Return a row of the rms errors of the three models and the improvement by the last."""
    errors = format_in_one_unit([rms["nominal"], rms["recalibrated"], rms["patched"]], unit)
    factor = format_number(rms["recalibrated"] / max(rms["patched"], 1e-300))
    return [words, *errors, factor]


def _errors_of_run(runs: Sequence[FreeRun]) -> list[list[str]]:
    """Return the rms errors of the free runs over one recording, a row for each signal."""
    rows = []
    for words, unit in FAMILIES.values():
        signal = FREE_RUN_SIGNALS[words]
        needed = {"x_m", "y_m"} if signal == "position" else {signal}
        if not needed <= runs[0].channels["recorded"].keys():
            continue
        rms = {}
        for model in MODELS:
            errors = np.concatenate([figures.model_error(r, model, signal) for r in runs])
            # the rms of a position is that of its coordinates, of which there are two
            rms[model] = math.sqrt(float(np.nanmean(errors**2)) / len(needed))
        rows.append(_error_row(f"{runs[0].run}, {words}", rms, unit))
    return rows


def _ranking(f: Findings) -> Iterator[Block]:
    """Yield the evidence for each candidate effect alone: the best ones as odds, all on request."""
    candidates = f.answer["candidates"]
    if not candidates:
        return
    status, visible = _status(f), MOST_VISIBLE_CANDIDATES
    rows, gains = [], []
    for i, c in enumerate(candidates, 1):
        name, gain = c["name"], c["gain_nats"]
        gains.append(gain)
        if name in status:
            visible = max(visible, i)
        verdict, meaning = status.get(name, ""), f.words.get(name, "")
        rows.append([words_of_name(name), short_odds(gain), verdict, meaning])
    bars = tuple((np.maximum(gains, 0.0) / max(*gains, 1e-9)).tolist())
    caption = (
        "Each candidate effect tested alone, the best ones first. The odds are those that the "
        "better fit is chance. For an identified effect they differ from the value above, which is "
        "computed in the presence of all other identified effects."
    )
    header = ["candidate", "odds of chance", "verdict", "meaning"]
    yield without_empty_columns(
        Table(caption, header, rows[:visible], (2, 3), bars[:visible], aside=True)
    )
    yield from _evidence_of_all(f)


def _evidence_of_all(f: Findings) -> Iterator[Block]:
    """Yield the evidence for all candidate effects in nats, on request."""
    candidates, rows = f.answer["candidates"], []
    for c in candidates:
        probability = format_probability(c["probability"])
        meaning = f.words.get(c["name"], "")
        rows.append([words_of_name(c["name"]), format_nats(c["gain_nats"]), probability, meaning])
    title = f"Statistics of all {len(rows)} candidates"
    if len(rows) == 1:
        title = "Statistics of the candidate"
    header = [
        "candidate",
        "evidence [nats]",
        "probability, if only one effect is missing",
        "meaning",
    ]
    yield without_empty_columns(Table(title, header, rows, (3,), folded=True, aside=True))
    yield Note(
        "How to read these statistics",
        "The evidence compares the retuned vessel with and without the candidate. The probability "
        "assumes that exactly one of these candidates is missing, or none. The probabilities add "
        "up to 100 %, so that only the strongest of several missing effects has a high "
        "probability. It is not the probability that an effect is a true cause.",
    )


def _status(f: Findings) -> dict[str, str]:
    """Return the verdict on identified effects and their look-alikes, by name."""
    status = {}
    for possible in f.answer.get("also_possible", []):
        status[possible["name"]] = "also possible"
    for refined in f.answer.get("refined", []):
        status[refined["name"]] = "number refined"
    for e in f.answer["effects"]:
        for rival in e["tied_with"]:
            status[rival] = f"look-alike of {words_of_name(e['name'])}"
    for e in f.answer["effects"]:
        status[e["name"]] = "identified"
    return status


def _limits(f: Findings) -> Iterator[Block]:
    """Yield the largest strength that each effect may have that was not found."""
    rows = []
    for name, values in _not_found(f).items():
        limits = []
        for key, value in f.answer.get("lower_limits", {}).get(name, {}).items():
            words, text = format_upper_limit(key, value)
            limits.append(f"{words} at least {text}")
        for key, value in values.items():
            words, text = format_upper_limit(key, value)
            limits.append(f"{_measurement_meaning(f, name, key) or words} {text}")
        if limits:
            rows.append([words_of_name(name), ", ".join(limits), f.words.get(name, "")])
    if not rows:
        return
    caption = (
        "With 95 % confidence each effect is weaker than this, if nothing else is missing. The "
        "limit of a factor or fraction is its distance from the value in the vessel file."
    )
    if f.answer["unknown"]["flag"]:
        caption += " Here something else is missing, in which any of these effects may hide."
    header, folded = ["candidate", "at most", "meaning"], f.answer["verdict"] != "nothing_missing"
    yield without_empty_columns(Table(caption, header, rows, (1, 2), folded=folded, aside=True))


def _measurement_meaning(f: Findings, name: str, key: str) -> str:
    """Return the meaning of a parameter of a measurement error, which is clearer than its name."""
    words = f.words.get(name, "")
    if words == effect_description(words):
        return ""
    return f.words.get(f"{name}.{key}", "")


def _not_found(f: Findings) -> dict[str, dict[str, float]]:
    """Return the upper limits without those of look-alikes, which may be the true cause."""
    limits = dict(f.answer["upper_limits"])
    for e in f.answer["effects"]:
        for rival in e["tied_with"]:
            limits.pop(rival, None)
    return limits


def _coefficients(f: Findings) -> Iterator[Block]:
    """Yield the factors on the coefficients of the vessel file, on request."""
    rows, corrected = [], f.corrected_coefficients if f.has_added_effects else {}
    refined = {entry["name"] for entry in f.answer.get("refined", ())}
    for name, value in f.coefficients.items():
        if name in refined:  # in the table of refined numbers
            continue
        row = [words_of_name(name.replace(".", ", ")), _factor(*value)]
        if corrected:
            row.append(_factor(*corrected[name]) if name in corrected else "")
        rows.append(row)
    if not rows:
        return
    caption = "Factors on the coefficients of the vessel file, and the change"
    header = ["coefficient", "retuned"]
    if corrected:
        header.append("corrected")
    yield Table(caption, header, rows, folded=True)
    if corrected:
        yield Text(
            "The retuned vessel has none of the effects and formulas above, so that its "
            "coefficients make up for them as far as they can. Those of the corrected vessel were "
            "fitted together with the effects; patched.toml contains them."
        )


def _factor(factor: float, sd: float) -> str:
    """Return a factor with its deviation, and the change in per cent."""
    change = f"{100 * (factor - 1):+.1f} %".replace("-", "−")
    return f"{format_with_sd(factor, sd)} ({change})"


def _next_experiment(f: Findings) -> Iterator[Block]:
    """Yield the manoeuvre that would add most evidence, and how to perform it."""
    wanted = f.answer["next_experiment"]
    if not wanted:
        if f.answer["effects"]:
            odds = math.exp(f.setting("plan.min_gain"))
            yield Text(
                "Nothing more is needed for this question: none of the manoeuvres considered is "
                "expected to change the odds between an identified effect and its rivals by more "
                f"than a factor of {odds:.1f}."
            )
        return
    scenario = wanted["scenario"]
    rivals = []
    for name in wanted["separates"]:
        rivals.append("no effect at all" if name == "nothing" else words_of_name(name))
    commands = "the initial state that it specifies"
    if f.steps:
        commands = "the commands below"
    gain = wanted["expected_gain_nats"]
    yield Items(
        (
            ("Manoeuvre", f"{capitalize(format_sentence(wanted['manoeuvre']))}."),
            ("Distinguishes", f"{capitalize(join_words(rivals, 'or'))}."),
            (
                "Expected evidence",
                f"{capitalize(evidence_strength(gain))}, for the true cause against its closest "
                f"rival ({format_odds(gain)}).",
            ),
            (
                "How to perform it",
                f"The file {scenario} lies next to this report; boatsim run {scenario} simulates "
                f"it with the vessel as specified. Give the real boat {commands}, record it, and "
                "diagnose all recordings together.",
            ),
        )
    )
    if sentence := _not_in_doubt(f, wanted["separates"]):
        yield Text(sentence)
    yield Note(STATISTICS, f"The expected log Bayes factor is {format_nats(gain)} nats.")
    if f.steps:
        yield _commands(f)


def _not_in_doubt(f: Findings, separated: Sequence[str]) -> str:
    """Return why the next experiment tests none of the identified effects; "" if it does."""
    named = [effect["name"] for effect in f.answer["effects"]]
    if not named or set(named) & set(separated):
        return ""
    return (
        f"It is no test of {join_words(map(words_of_name, named))}, about which these recordings "
        "leave less doubt. It decides what remains open."
    )


def _commands(f: Findings) -> Table:
    """Return the folded table of the commands of the next experiment; its last row is the end."""
    header = ["from"]
    units: dict[str, str] = {}
    for _, levels in f.steps:
        for name in levels:
            if name not in units:
                words, units[name] = name_and_unit(name)
                header.append(words)
    rows = []
    for t, levels in f.steps:
        row = [f"{t:g} s"]
        for name, unit in units.items():
            text = ""
            if name in levels:
                _, text = format_parameter(name, levels[name], unit)
            row.append(text)
        if not levels:
            row[1] = "end"
        rows.append(row)
    return Table("Commands of the next experiment", header, rows, folded=True)


def _limitations(f: Findings) -> Iterator[Block]:
    """Yield what the recordings cannot show."""
    lines = []
    close = f.setting("select.alike")
    for e in f.answer["effects"]:
        if e["tied_with"]:
            causes = join_words(map(words_of_name, (e["name"], *e["tied_with"])), "or")
            lines.append(
                f"Whether the cause is {causes}: they explain these recordings about equally well "
                f"(one at most {math.exp(close):.0f} times as probable as another)."
            )
    if not f.answer["fit"].get("held_out"):
        lines.append("Whether the finding holds on other data: no recording was held out.")
    unlimited = []
    lower = f.answer.get("lower_limits", {})
    for name, limits in _not_found(f).items():
        if not limits and name not in lower:
            unlimited.append(words_of_name(name))
    if unlimited:
        lines.append(
            f"How strong {join_words(unlimited, 'or')} could be at most: "
            "no limit could be computed."
        )
    lines += map(format_sentence, f.remarks)
    yield from _bullets(lines)


def _files(f: Findings) -> Iterator[Block]:
    lines = {"diagnosis.json": "All results as data."}
    if patch := f.answer["patch"]:
        lines[patch] = (
            "The corrected vessel, with retuned coefficients and the identified effects. boatsim "
            f"run, replay and diagnose read it with --vessel {patch}."
        )
    if wanted := f.answer["next_experiment"]:
        lines[wanted["scenario"]] = "The manoeuvre to record next, as a scenario for boatsim run."
    lines["diagnosis.rrd"] = (
        "The recording and the vessel before (nominal), retuned (recalibrated) and corrected "
        "(patched), in one scene of the rerun viewer."
    )
    yield Items(tuple(lines.items()))
