"""Sections of a report on effects: identified, possible, and forces that none explains."""

import math
from collections.abc import Iterator, Mapping

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.formulas import doubt, is_event, is_stated, states_any
from boatsim.diagnosis.answer.refined_numbers import refined_number_rows
from boatsim.diagnosis.answer.schema import (
    DescribedEntry,
    EffectEntry,
    ParameterEntry,
    StructureEntry,
    TermEntry,
)
from boatsim.diagnosis.answer.verdict import (
    effect_description,
    effects_of_kind,
    held_out_only_statement,
    probability_with_look_alikes,
    ratio_sentences,
    structure_clause,
    tied_groups_statement,
)
from boatsim.diagnosis.report import figures
from boatsim.diagnosis.report.confirmation import effect_sentences
from boatsim.diagnosis.report.sentences import held_out_improvement_sentence
from boatsim.view import svg_plots
from boatsim.view.formatting import (
    capitalize,
    format_cause_probability,
    format_evidence,
    format_in_one_unit,
    format_nats,
    format_number,
    format_parameter,
    format_probability,
    format_quantity,
    format_with_sd,
    join_words,
    name_in_words,
    short_odds,
)
from boatsim.view.page_blocks import (
    STATISTICS,
    Block,
    Figures,
    Heading,
    Note,
    Table,
    Text,
    without_empty_columns,
)


def identified_effect_sections(f: Findings, kind: str) -> Iterator[Block]:
    """Yield the sections on the identified effects of a kind; the most important comes first.

    Args:
        f: Findings of a diagnosis.
        kind: "physics" or "measurement".
    """
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


def refined_numbers_section(f: Findings) -> Iterator[Block]:
    """Yield the numbers of the vessel file that the recordings improve.

    Args:
        f: Findings of a diagnosis.
    """
    rows = refined_number_rows(f.answer)
    if not rows:
        return
    yield Text(
        "The vessel file calls these numbers estimates. The recordings give better values, which "
        "are in the corrected vessel. They are no faults of the boat or of the log."
    )
    header = ["number", "before", "after ± deviation", "off by"]
    yield Table("Numbers of the vessel file", header, rows)


def possible_effects_section(f: Findings) -> Iterator[Block]:
    """Yield the effects that may act but that these recordings do not confirm.

    Args:
        f: Findings of a diagnosis.
    """
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


def added_effects_section(f: Findings) -> Iterator[Block]:
    """Yield the effects that the corrected vessel has for better simulations alone.

    Args:
        f: Findings of a diagnosis.
    """
    entries = f.answer.get("added", [])
    if entries:
        yield Text(
            "The corrected vessel has these effects because simulations of fitted and held-out "
            "recordings get better by them. They may stand in for other causes."
        )
    for entry in entries:
        yield Heading(capitalize(effect_description(entry["words"])), entry["name"])
        header = ["parameter", "value ± deviation", "meaning"]
        rows = _values(f, entry["name"], entry["parameters"])
        caption = "Values as patched.toml contains them"
        yield without_empty_columns(Table(caption, header, rows, prose=(2,)))


def _effect(f: Findings, e: EffectEntry, explain_deviation: bool) -> Iterator[Block]:
    kind = "measurement error" if e["kind"] == "measurement" else "physics"
    likely = format_cause_probability(e["probability"])
    if e["tied_with"]:
        together = format_probability(probability_with_look_alikes(f.answer, e))
        likely += f", {together} together with its look-alikes"
    yield Heading(capitalize(effect_description(e["words"])), f"{e['name']} · {kind} · {likely}")
    if ratios := ratio_sentences([e]):
        sentences = [f"{capitalize(ratio)}." for ratio in ratios]
        if explain_deviation and "±" in sentences[0]:
            sentences.append("(± is one standard deviation, in percentage points.)")
        yield Text(" ".join(sentences))
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
            rivals.append(name_in_words(name))
            if name in f.words:
                rivals[-1] += f" ({_meaning(f.words[name])})"
        yield Text(f"These recordings cannot distinguish it from {join_words(rivals, 'or')}.")
    if statement := tied_groups_statement(e):
        yield Text(f"{capitalize(statement)}.")


def _held_out_sentences(f: Findings, effect: EffectEntry) -> list[str]:
    """Return what an effect does on held-out data, unless the top of the page has its numbers."""
    top = held_out_improvement_sentence(f)
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


def unexplained_force_section(f: Findings) -> Iterator[Block]:
    """Yield the formulas for what no candidate explains, and the evidence for an unknown cause.

    Args:
        f: Findings of a diagnosis.
    """
    unknown, factor = f.answer["unknown"], f.setting("locate.disturbance_factor")
    yield from _formulas(f)
    if not states_any(f.answer):
        facts = format_evidence(unknown["gain_nats"])
        yield Heading("A force that no candidate effect explains", facts)
    if unknown["gain_nats"] > unknown["told_from_nats"]:
        yield Text(
            "Even with all identified effects, the recordings require an additional random force "
            f"of more than {factor:g} times the assumed disturbance level: "
            f"{format_evidence(unknown['gain_nats'])}. The section on the missing force shows "
            "where and when the force acts."
        )
    elif sentence := held_out_only_statement(f.answer):
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
        f"The unexplained force in {s['axis']} {structure_clause(s)}. By chance, any of "
        f"the {s['tried']} quantities tested would show this in one of {often} diagnoses."
    )


def _confirmation(f: Findings, formula: DescribedEntry) -> str:
    """Return whether a formula is part of the corrected vessel, and why."""
    if is_event(formula):
        return "It acts in one recording only. Therefore it is no part of the corrected vessel."
    if not formula["carries_over"]:
        reason = capitalize(doubt(formula, bool(f.answer["fit"].get("held_out"))))
        return f"{reason}. Therefore it is no part of the corrected vessel."
    part = (
        "It reduces the errors of free runs over held-out recordings. Therefore it is part of the "
        "corrected vessel."
    )
    if is_stated(f.answer, formula):
        return part
    return f"{part} But {doubt(formula, any_held_out=True)}."


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
        yield Text(_confirmation(f, law))
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
