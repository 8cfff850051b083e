"""Sentences of a diagnosis: the verdict, its validation, the assumptions, the printed summary."""

import itertools
from collections.abc import Mapping, Sequence

from boatsim.diagnosis.evaluation import MODELS
from boatsim.diagnosis.report.confirmation import effect_sentences, recalibration_sentences
from boatsim.diagnosis.report.described_terms import axis_force_words
from boatsim.diagnosis.report.experiment_section import is_optional
from boatsim.diagnosis.report.families import FAMILIES
from boatsim.diagnosis.report.findings import Findings, setting_of
from boatsim.diagnosis.report.incomplete import is_failure
from boatsim.diagnosis.report.model_names import MODEL_WORDS
from boatsim.diagnosis.report.schema import (
    Answer,
    DisturbanceLevelEntry,
    EffectEntry,
    LeftOutEntry,
    MeanEntry,
    ParameterEntry,
)
from boatsim.view.formatting import (
    capitalize,
    format_cause_probability,
    format_in_one_unit,
    format_nats,
    format_number,
    format_odds,
    format_parameter,
    format_quantity,
    join_words,
    name_in_words,
)

WAYS = {  # axis -> direction of a positive mean force, and of a negative one
    "surge": ("forward", "astern"),
    "sway": ("to starboard", "to port"),
    "heave": ("down", "up"),
    "roll": ("heeling to starboard", "heeling to port"),
    "pitch": ("bow up", "bow down"),
    "yaw": ("bow to starboard", "bow to port"),
}
COUNTS = ("no", "one", "two", "three", "four", "five", "six")
# numbers of one effect, or formulas, in the verdict; the tables of the report have all of them
MOST_NUMBERS = 3
NONE_TESTED = (
    "no candidate effect was tested: the facts of the recordings or the vessel file exclude all "
    "of them"
)
NOTHING_RANKED = (
    "no candidate effect was ranked and no coefficient was refitted, because the fits to these "
    "recordings diverge"
)
NOTHING_MISSING = (
    "No missing effect was found: the vessel model explains these recordings to within their noise."
)

NONE_MISSING_WITH_REFINED = (
    "No missing effect was found: with {} refined, the vessel model explains these recordings to "
    "within their noise."
)
NOT_IN_FILE = "not in the file"  # change of a number that the vessel file does not have


def effect_description(effect_words: str) -> str:
    """Return an effect's description without the remark that it is an error of the measurement.

    The remark is "(not physics)".
    """
    return effect_words.removesuffix(" (not physics)")


def tested_any_candidate(answer: Answer) -> bool:
    """Return whether a diagnosis tested any candidate effect."""
    return bool(answer["candidates"])


def finds_only_measurement_errors(answer: Answer) -> bool:
    """Return whether a diagnosis explains the mismatch by measurement errors alone.

    No physics is then missing in the vessel model.
    """
    for effect in answer["effects"]:
        if effect["kind"] != "measurement":
            return False
    return answer["verdict"] == "named"


def verdict_sentences(answer: Answer, words: Mapping[str, str] | None = None) -> str:
    """Return the verdict of a diagnosis in a few sentences: what the vessel model lacks.

    Args:
        answer: Content of diagnosis.json; its own sentence is not read.
        words: Meaning of parameters by "effect.parameter".

    Returns:
        Sentences on the identified effects with their first numbers, on formulas, and on what the
        recordings cannot distinguish.
    """
    if answer["unknown"].get("diverges"):
        return _cannot_follow(answer)
    if not tested_any_candidate(answer):
        return _none_tested(answer)
    statements = _effects(answer, words or {})
    statements += _formulas(answer, bool(answer["effects"]))
    refined = _refined_numbers(answer)
    if not statements and refined:
        return NONE_MISSING_WITH_REFINED.format(refined)
    if not statements:
        return NOTHING_MISSING
    statements += _look_alikes(answer["effects"])
    if refined:
        verb = "was" if len(answer["refined"]) == 1 else "were"
        statements.append(f"{refined} {verb} refined")
    return " ".join(f"{capitalize(statement)}." for statement in statements)


def reason_none_tested(answer: Answer) -> str:
    """Return the reason, in words, why a diagnosis tested no candidate effect.

    Args:
        answer: Content of diagnosis.json, without candidates.
    """
    if answer["unknown"].get("diverges"):
        return NOTHING_RANKED
    return NONE_TESTED


def _cannot_follow(answer: Answer) -> str:
    """Return from which time on, and along which axis, the model cannot follow each recording."""
    places = []
    for place in answer["unknown"]["diverges"][:MOST_NUMBERS]:
        size = format_quantity(place["rms"], place["unit"], digits=2)
        places.append(
            f"from t = {place['from_s']:.4g} s of {place['run']}, in {place['axis']} "
            f"({size} rms from then on)"
        )
    return (
        f"The cause is unknown {join_words(places)}: the vessel's model can no longer follow the "
        f"recording. {capitalize(NOTHING_RANKED)}."
    )


def _none_tested(answer: Answer) -> str:
    if answer["verdict"] == "unknown":
        return f"Something is missing{_unexplained_rms(answer)}, but {NONE_TESTED}."
    return f"No force beyond the assumed disturbance is missing, but {NONE_TESTED}."


def _effects(answer: Answer, words: Mapping[str, str]) -> list[str]:
    """Return statements on an unknown cause, on missing physics and on errors of measurement."""
    statements = []
    if answer["unknown"].get("stand_ins") and not answer["described"]:
        statements.append(_stand_ins(answer))
    elif sentence := held_out_only_statement(answer):
        statements.append(sentence)
    elif answer["unknown"]["flag"] and not answer["described"]:
        statements.append(
            f"a force is missing that no candidate effect explains{_unexplained_rms(answer)}"
        )
        if found := answer["unknown"].get("structure"):
            statements.append(f"in {found['axis']} it varies with {found['goes_with']}")
    physics: list[str] = []
    probable: list[str] = []
    measured: list[str] = []
    sure = setting_of(answer, "decide.sure_probability")
    for effect in answer["effects"]:
        if effect["kind"] == "measurement":
            measured.append(_clause(effect, words))
        elif _probability_with_look_alikes(answer, effect) < sure:
            probable.append(_clause(effect, words))
        else:
            physics.append(_clause(effect, words))
    addition = "in addition, " if statements else ""
    if physics or probable:
        statements.append(f"{addition}the model {_left_out(physics, probable)}")
        statements += ratio_sentences(effects_of_kind(answer, "physics"))
    if measured:
        errors = "a measurement error"
        if len(measured) > 1:
            errors = count_in_words(len(measured), "measurement error")
        if statements:
            statements.append(f"in addition, the recordings contain {errors}: {_clauses(measured)}")
        else:
            statements.append(
                f"no missing physics was found, but the recordings contain {errors}: "
                f"{_clauses(measured)}"
            )
        statements += ratio_sentences(effects_of_kind(answer, "measurement"))
    return statements


def ratio_sentences(effects: Sequence[EffectEntry]) -> list[str]:
    """Return the sentences on the main ratios of effects, in per cent.

    Args:
        effects: Identified effects.
    """
    found = []
    for effect in effects:
        for p in _main_parameters(effect).values():
            if sentence := p.get("statement"):
                if p.get("at_bound"):
                    sentence += ", the bound of its range"
                found.append(sentence)
    return found


def _main_parameters(effect: EffectEntry) -> dict[str, ParameterEntry]:
    """Return the first fitted parameters of an effect, without those that may be zero."""
    found = {}
    for key, p in effect["parameters"].items():
        if abs(p["value"]) > p["sd"] or "factor" in key:
            found[key] = p
    return dict(itertools.islice(found.items(), MOST_NUMBERS))


def held_out_only_statement(answer: Answer) -> str:
    """Return the statement that the cause is unknown only because of the held-out recordings.

    They require a force that no candidate effect explains. Returns "" if that is not the reason.

    Args:
        answer: Content of diagnosis.json.
    """
    if answer["described"] or not answer["unknown"].get("held_out_only"):
        return ""
    return (
        "the cause is unknown only because of the held-out recordings: the model explains the "
        "fitted recordings, but the held-out ones require a force that no candidate effect explains"
    )


def _left_out(sure: Sequence[str], probable: Sequence[str]) -> str:
    """Return which effects the model leaves out, and which it probably leaves out."""
    if not sure:
        effects = count_in_words(len(probable), "effect")
        return f"probably leaves out {effects}: {_clauses(probable)}"
    statement = f"leaves out {count_in_words(len(sure), 'effect')}: {_clauses(sure)}"
    if probable:
        more = COUNTS[len(probable)] if len(probable) < len(COUNTS) else str(len(probable))
        statement += f"; and probably {more} more: {_clauses(probable)}"
    return statement


def _probability_with_look_alikes(answer: Answer, effect: EffectEntry) -> float:
    """Return the probability that an effect or one of its look-alikes is a true cause."""
    for one in answer.get("signs", {}).get("effects", []):
        if one["name"] == effect["name"]:
            return one["probability"]
    return 1.0


def _stand_ins(answer: Answer) -> str:
    """Return the statement that an effect which explains the recordings is no likely cause."""
    names, effects = answer["unknown"]["stand_ins"], []
    for entry in answer.get("also_possible", []):
        if entry["name"] in names:
            effects.append(f"“{effect_description(entry['words'])}”, but {entry['why']}")
    return (
        f"something is missing whose cause is unknown: best described by {'; or by '.join(effects)}"
    )


def _refined_numbers(answer: Answer) -> str:
    """Return the count of refined numbers in words, "" if there are none."""
    refined = answer.get("refined", [])
    if not refined:
        return ""
    return f"{count_in_words(len(refined), 'number')} of the rough model"


def refined_number_rows(answer: Answer) -> list[list[str]]:
    """Return the rows of the report's table of refined numbers of the vessel file.

    A refined number is an estimate of the vessel file to which the recordings give a better value.

    Args:
        answer: Content of diagnosis.json.

    Returns:
        For each number: its words, its value before and after, and the relative change.
    """
    rows = []
    for entry in answer.get("refined", []):
        largest = max(abs(entry["before"]), abs(entry["after"]))
        before = format_quantity(entry["before"], entry["unit"], largest=largest)
        if entry["before"] == 0.0:
            before = "0"
        after = format_quantity(entry["after"], entry["unit"], entry["sd"], largest=largest)
        off = NOT_IN_FILE
        if entry["off"] is not None:
            off = f"{100.0 * entry['off']:+.0f} %".replace("-", "−")
        rows.append([entry["number"], before, after, off])
    return rows


def count_in_words(count: int, noun: str) -> str:
    """Return a count of things in words, with numbers up to six spelt out: two effects."""
    number_words = str(count)
    if count < len(COUNTS):
        number_words = COUNTS[count]
    if count == 1:
        return f"{number_words} {noun}"
    return f"{number_words} {noun}s"


def _formulas(answer: Answer, effects_precede: bool) -> list[str]:
    """Return statements on the formulas: those that generalize first, further events as a count."""
    general, events = [], []
    for law in answer["described"]:
        if law["carries_over"]:
            general.append(f"the model lacks {law['statement']}")
        else:
            events.append(law["statement"])
    if not (general or effects_precede):
        return [f"the model lacks {event}" for event in events[:MOST_NUMBERS]]
    statements = general[:MOST_NUMBERS]
    if len(events) == 1:
        statements.append(f"one event of a single run remains: {events[0]}")
    elif events:
        statements.append(f"{len(events)} events of single runs remain, the first is {events[0]}")
    if statements and effects_precede:
        statements[0] = f"in addition, {statements[0]}"
    return statements


def _look_alikes(effects: Sequence[EffectEntry]) -> list[str]:
    ties = []
    for effect in effects:
        if effect["tied_with"]:
            rivals = join_words(map(name_in_words, effect["tied_with"]), "or")
            ties.append(f"{name_in_words(effect['name'])} from {rivals}")
    if not ties:
        return []
    return [f"these recordings cannot distinguish {join_words(ties)}"]


def _unexplained_rms(answer: Answer) -> str:
    """Return the rms force that remains unexplained, by axis, in brackets."""
    axes = answer["unknown"].get("rest") or answer["where"]["axes"]
    sizes = []
    for axis, strength in axes.items():
        size = format_quantity(strength["rms"], strength["unit"], digits=2)
        sizes.append(f"{size} rms in {axis}")
    if not sizes:
        return ""
    return f" ({join_words(sizes)})"


def _clause(effect: EffectEntry, words: Mapping[str, str]) -> str:
    numbers = format_fitted_values(effect, words)
    if not numbers:
        return effect_description(effect["words"])
    return f"{effect_description(effect['words'])} ({numbers})"


def _clauses(clauses: Sequence[str]) -> str:
    """Return clauses, which have commas of their own, as a list: A, B, and C."""
    *head, tail = clauses
    if not head:
        return tail
    return f"{', '.join(head)}, and {tail}"


def format_fitted_values(effect: EffectEntry, words: Mapping[str, str]) -> str:
    """Return the main fitted parameter values of an effect as text, without those that may be zero.

    Ratios about which the effect has a sentence of its own are omitted.

    Args:
        effect: An identified effect.
        words: Meaning of parameters by "effect.parameter".

    Returns:
        Text such as: astern factor 0.694 ± 0.012.
    """
    numbers = []
    for key, p in _main_parameters(effect).items():
        if p.get("statement"):
            continue
        name, text = format_parameter(key, p["value"], p["unit"], p["sd"])
        if effect["kind"] == "measurement":  # "error heading north" is clearer than "cos"
            name = words.get(f"{effect['name']}.{key}", name)
        if p.get("at_bound"):
            text += ", the bound of its range"
        numbers.append(f"{name} {text}")
    return ", ".join(numbers)


def held_out_improvement_sentence(f: Findings) -> str:
    """Return a sentence on how much the corrected vessel reduces errors on held-out recordings.

    The errors are those of simulations with the recorded commands alone.
    """
    fit = f.answer["fit"]
    errors, compared, gains = [], [], []
    for key, (words, unit) in FAMILIES.items():
        if rms := fit.get(key):
            before, after = format_in_one_unit([rms["recalibrated"], rms["patched"]], unit)
            gain = rms["recalibrated"] / max(rms["patched"], 1e-300)
            errors.append(f"{before} in {words}")
            compared.append(f"{after} in {words} instead of {before} ({_improvement_factor(gain)})")
            gains.append(gain)
    if not errors and f.answer["unknown"].get("diverges"):
        return "The result could not be validated: free runs of the vessel diverge."
    if not errors:
        return "The result could not be validated: no recording was held out."
    held_out, count = "the held-out recordings", len(fit.get("held_out", ()))
    if count > 1:
        held_out = "both held-out recordings" if count == 2 else f"all {count} held-out recordings"
    runs = (
        f"In free runs (simulations of {fit['horizon_s']:g} s with the recorded commands alone) "
        f"over {held_out}"
    )
    if not f.has_added_effects:
        return f"{runs}, the retuned vessel has an rms error of {join_words(errors)}."
    caution = ""
    if max(gains) <= f.setting("answer.least_improvement"):
        caution = "Treat this result as a hint: it hardly reduces the errors on held-out data. "
    return (
        f"{caution}{runs}, the corrected vessel has an rms error of {join_words(compared)}. The "
        "comparison is with the retuned vessel, whose own coefficients were refitted."
    )


def _improvement_factor(gain: float) -> str:
    if 0.95 < gain < 1.05:
        return "unchanged"
    if gain > 1.0:
        return f"{format_number(gain, 2)} times smaller"
    return f"{format_number(1.0 / gain, 2)} times larger"


def mean_force_paragraph(answer: Answer, patched: bool) -> list[str]:
    """Return what a report says of the constant force that the corrected model does not explain.

    Args:
        answer: Content of diagnosis.json.
        patched: Whether the corrected vessel has effects that the retuned one lacks.

    Returns:
        A list of one paragraph with size, direction and share of full thrust; an empty list
        without a force.
    """
    found = answer.get("mean_left") or {}
    if not found:
        return []
    vessel = "corrected" if patched else "retuned"
    forces = join_words(itertools.starmap(_mean_with_sd, found.items()))
    return [
        f"A mean force remains in the {vessel} vessel: {forces}, averaged over all recordings. No "
        "effect of the model produces it. A controller without integral action keeps a steady "
        "offset because of it."
    ]


def _mean_with_sd(axis: str, mean: MeanEntry) -> str:
    positive, negative = WAYS[axis]
    way = positive if mean["mean"] > 0.0 else negative
    size = format_quantity(abs(mean["mean"]), mean["unit"], mean["sd"])
    return f"{size} {way} in {axis}{_of_thrust(mean)}"


def _of_thrust(entry: MeanEntry | DisturbanceLevelEntry) -> str:
    share = entry.get("share_of_full_thrust")
    if share is None:
        return ""
    return f" ({format_number(100.0 * share, 2)} % of full thrust)"


def assumption_sentences(answer: Answer) -> list[str]:
    """Return lines on the candidate effects tested and excluded, and on assumptions made.

    They are part of the report of a diagnosis.

    Args:
        answer: Content of diagnosis.json.

    Returns:
        One line per statement; an empty list if the answer has no rules.
    """
    if "rules" not in answer:
        return []
    tested = f"{len(answer['tried'])} candidate effects tested"
    if excluded := answer["left_out"]:
        tested += f", {len(excluded)} excluded: {_exclusions(excluded)}"
    levels = []
    for axis, level in answer["rules"]["ambient"].items():
        size = format_quantity(level["rms"], level["unit"], digits=2)
        levels.append(f"{axis} {size}{_of_thrust(level)}")
    lines = [tested]
    for statement in answer.get("skipped", []):
        if is_failure(statement):
            lines.append(statement)
        else:
            lines.append(f"the search's budget was spent: {statement}")
    lines.append(f"assumed disturbance level (rms): {', '.join(levels)}")
    for rule, reason in answer["rules"]["overridden"].items():
        lines.append(f"{rule} is specified by the vessel file: {reason}")
    return lines


def _exclusions(excluded: Sequence[LeftOutEntry]) -> str:
    """Return the excluded effects, grouped by their reason: A and B (no wind); C (no rudder)."""
    by_reason: dict[str, list[str]] = {}
    for entry in excluded:
        by_reason.setdefault(entry["reason"], []).append(name_in_words(entry["name"]))
    return "; ".join(f"{join_words(names)} ({reason})" for reason, names in by_reason.items())


def console_lines(f: Findings) -> list[str]:
    """Return the lines of a diagnosis's summary that `boatsim diagnose` prints on the console.

    Args:
        f: Findings of a diagnosis.

    Returns:
        Verdict, evidence and values of each effect (errors of the recordings first), refined
        numbers, effects that are also possible, assumptions, errors on held-out recordings, a
        remaining mean force, and the next experiment.
    """
    answer = f.answer
    lines = [answer["sentence"]]
    measured, physics = effects_of_kind(answer, "measurement"), effects_of_kind(answer, "physics")
    lines += _effect_lines("Errors of the recordings", measured, with_nats=True)
    lines += _effect_lines("Missing physics", physics, with_nats=not measured)
    for law in answer["described"]:
        for term in law["terms"]:
            varies = f"{axis_force_words(law['axis'])} that varies with {term['of']}"
            lines.append(f"  formula: {varies}: {format_odds(term['gain_nats'])}")
            lines.append(f"    {term['value']:.4g} ± {term['sd']:.2g} {term['unit']}".rstrip())
    lines += [*_refined_lines(answer), *_possible_lines(answer)]
    for line in assumption_sentences(answer):
        lines.append(f"  {line}")
    lines += [*_validation(f), *mean_force_paragraph(answer, f.has_added_effects)]
    if wanted := answer["next_experiment"]:
        rivals, expected = join_words(wanted["separates"], "or"), wanted["expected_gain_nats"]
        needed = "optional next experiment" if is_optional(f) else "next experiment"
        lines.append(f"{needed}: {wanted['manoeuvre']}")
        lines.append(f"  it distinguishes {rivals}; expected: {format_odds(expected)}")
    return lines


def effects_of_kind(answer: Answer, kind: str) -> list[EffectEntry]:
    """Return the identified effects that are missing physics, or those that are measurement errors.

    Args:
        answer: Content of diagnosis.json.
        kind: "physics" or "measurement".
    """
    return [effect for effect in answer["effects"] if effect["kind"] == kind]


def _effect_lines(title: str, effects: Sequence[EffectEntry], with_nats: bool) -> list[str]:
    """Return evidence and values of effects under a title; no lines without an effect.

    The evidence of the first effect is also in nats if that is wanted.
    """
    if not effects:
        return []
    lines = [f"{title}:"]
    for effect in effects:
        likely = format_cause_probability(effect["probability"])
        nats = ""
        if with_nats and effect is effects[0]:
            nats = f" ({format_nats(effect['gain_nats'])} nats; report.html explains the unit)"
        lines.append(f"  {effect['name']}: {likely}; {format_odds(effect['gain_nats'])}{nats}")
        for key, p in effect["parameters"].items():
            lines.append(f"    {key} = {p['value']:.4g} ± {p['sd']:.2g}")
        for sentence in effect_sentences(effect):
            lines.append(f"    {sentence}")
    return lines


def _refined_lines(answer: Answer) -> list[str]:
    """Return the table of refined numbers, with aligned columns."""
    rows = refined_number_rows(answer)
    if not rows:
        return []
    table = [["number", "before", "after", "off by"], *rows]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = ["Numbers refined:"]
    for row in table:
        lines.append(f"  {'  '.join(map(str.ljust, row, widths))}".rstrip())
    return lines


def _possible_lines(answer: Answer) -> list[str]:
    """Return the effects that may act but are not confirmed, with the reason."""
    possible = answer.get("also_possible", [])
    if not possible:
        return []
    lines = ["Also possible:"]
    for entry in possible:
        likely = format_cause_probability(entry["probability"])
        lines.append(f"  {entry['name']}: {likely}; {entry['why']}")
        for key, p in entry.get("parameters", {}).items():
            lines.append(f"    {key} = {p['value']:.4g} ± {p['sd']:.2g}")
    return lines


def _validation(f: Findings) -> list[str]:
    """Return the printed errors of free runs on the held-out recordings."""
    fit = f.answer["fit"]
    lines = [
        f"held out: {f.held_out_note}",
        f"rms error of free runs of {fit['horizon_s']:g} s on the held-out data:",
    ]
    for key, (words, unit) in FAMILIES.items():
        if rms := fit.get(key):
            scale = 1.0
            if unit == "rad":
                unit, scale = "deg", 57.29578
            cells = ", ".join(f"{MODEL_WORDS[m]} {rms[m] * scale:.4g}" for m in MODELS)
            lines.append(f"  {words} [{unit}]: {cells}")
    for sentence in recalibration_sentences(f):
        lines.append(f"  {sentence}")
    return lines
