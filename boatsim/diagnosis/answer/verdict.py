"""The verdict of an answer in sentences: what the vessel model lacks."""

import itertools
from collections.abc import Mapping, Sequence

from boatsim.diagnosis.answer.described_terms import axis_force_words
from boatsim.diagnosis.answer.findings import setting_of
from boatsim.diagnosis.answer.formulas import doubt, is_event, is_stated, states_any
from boatsim.diagnosis.answer.refined_numbers import main_refinement
from boatsim.diagnosis.answer.schema import (
    AddedEntry,
    Answer,
    DescribedEntry,
    EffectEntry,
    ParameterEntry,
    StructureEntry,
)
from boatsim.diagnosis.checks.finding import LOG_NOT_BOAT
from boatsim.physics.groups import without_group
from boatsim.view.formatting import (
    capitalize,
    format_parameter,
    format_quantity,
    join_words,
    name_in_words,
)

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
    "No missing effect was found: {}the vessel model explains these recordings to within their "
    "noise."
)
REFITTED = "with refitted coefficients, "
WITH_NOTHING = "nothing"  # what a constant force varies with, in diagnosis.json
# end of the description of a signed parameter -> words for its negative values
OPPOSITES = {
    "positive ahead": "astern",
    "positive downward": "upward",
    "positive forward": "aft",
    "positive to starboard": "to port",
}


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


def has_refitted_coefficients(answer: Answer) -> bool:
    """Return whether the retuned vessel has other coefficients than the vessel file.

    Args:
        answer: Content of diagnosis.json.
    """
    return answer.get("recalibration", {}).get("adopted", False)


def blames_log(answer: Answer) -> bool:
    """Return whether the sentence of an answer begins with a certain fault of the whole log.

    The recordings should then be corrected before the rest of the answer is used.
    """
    return answer["sentence"].startswith(capitalize(LOG_NOT_BOAT))


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
    stated, uncertain = _formulas(answer, bool(answer["effects"]))
    statements += stated
    refined = _refined_numbers(answer)
    if not statements and refined:
        return NOTHING_MISSING.format(f"with {refined} refined, ")
    if not statements:
        return NOTHING_MISSING.format(REFITTED if has_refitted_coefficients(answer) else "")
    statements += _look_alikes(answer["effects"])
    for effect in answer["effects"]:
        if statement := tied_groups_statement(effect):
            statements.append(statement)
    statements += _balanced_effects(answer, words or {})
    statements += _confirmed_possible(answer)
    statements += uncertain
    if refined:
        one = len(answer["refined"]) == 1
        statement = f"{refined} {'was' if one else 'were'} refined"
        if main := main_refinement(answer):
            statement += f": {main}" if one else f", above all {main}"
        statements.append(statement)
    statements += _added(answer)
    return " ".join(f"{capitalize(statement)}." for statement in statements)


def _confirmed_possible(answer: Answer) -> list[str]:
    """Return the statement on effects that only held-out recordings support.

    They are stated where a force remains unexplained; none is repeated that is stated as what
    describes an unknown cause best.
    """
    if _states_stand_ins(answer) or not answer["unknown"]["flag"]:
        return []
    found = []
    for entry in answer.get("also_possible", []):
        balanced = entry.get("together_with")
        if entry.get("in_patch") and entry.get("confirmed") and not balanced:
            found.append(f"“{effect_description(entry['words'])}”")
    if not found:
        return []
    reason = "held-out recordings confirm it, but it may stand in for another cause"
    if len(found) > 1:
        reason = "held-out recordings confirm them, but they may stand in for other causes"
    return [f"the corrected vessel contains {join_words(found[:MOST_NUMBERS])}: {reason}"]


def _balanced_effects(answer: Answer, words: Mapping[str, str]) -> list[str]:
    """Return the statement on two possible effects that balance each other in simulations.

    The held-out recordings confirm both.
    """
    found = []
    for entry in answer.get("also_possible", []):
        if entry.get("together_with") and entry.get("in_patch") and entry.get("confirmed"):
            effect: EffectEntry = {
                "name": entry["name"],
                "kind": "physics",
                "probability": entry["probability"],
                "gain_nats": entry["gain_nats"],
                "words": entry["words"],
                "tied_with": [],
                "parameters": entry.get("parameters", {}),
            }
            found.append(_clause(effect, words))
    if len(found) < 2:
        return []
    return [
        f"simulations require two effects together: {_clauses(found)}; held-out recordings confirm "
        "them, but they may stand in for other causes"
    ]


def _added(answer: Answer) -> list[str]:
    """Return the statement on effects that only make simulations better."""
    found = list(map(_added_words, answer.get("added", [])))
    if not found:
        return []
    reason = "simulations get better by them, but they are not shown to be causes"
    if len(found) == 1:
        reason = "simulations get better by it, but it is not shown to be a cause"
    return [f"for predictions, the corrected vessel also contains {join_words(found)}: {reason}"]


def _added_words(entry: AddedEntry) -> str:
    """Return what an added effect does, with its group, and whether a number is at a bound.

    A value at the bound of its plausible range shows that the effect stands in for something else.
    """
    words = f"“{effect_description(entry['words'])}”"
    if any(p.get("at_bound") for p in entry["parameters"].values()):
        words = f"{words} (at the bound of its range)"
    return words


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
    if _states_stand_ins(answer):
        statements.append(_stand_ins(answer))
    elif sentence := held_out_only_statement(answer):
        statements.append(sentence)
    elif answer["unknown"]["flag"] and not states_any(answer):
        statements.append(
            f"a force is missing that no candidate effect explains{_unexplained_rms(answer)}"
        )
        if found := answer["unknown"].get("structure"):
            statements.append(f"in {found['axis']} it {structure_clause(found)}")
    physics: list[str] = []
    probable: list[str] = []
    measured: list[str] = []
    sure = setting_of(answer, "decide.sure_probability")
    for effect in answer["effects"]:
        if effect["kind"] == "measurement":
            measured.append(_clause(effect, words))
        elif probability_with_look_alikes(answer, effect) < sure:
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
        elif answer["unknown"]["flag"]:
            statements.append(f"the recordings contain {errors}: {_clauses(measured)}")
        else:
            statements.append(
                f"no missing physics was found, but the recordings contain {errors}: "
                f"{_clauses(measured)}"
            )
        statements += ratio_sentences(effects_of_kind(answer, "measurement"))
    return statements


def structure_clause(structure: StructureEntry) -> str:
    """Return what an unexplained force varies with, as the end of a clause about it.

    Args:
        structure: Entry `unknown.structure` of diagnosis.json.
    """
    if structure["goes_with"].startswith(WITH_NOTHING):
        return "is constant"
    return f"varies with {structure['goes_with']}"


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
    if states_any(answer) or not answer["unknown"].get("held_out_only"):
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


def probability_with_look_alikes(answer: Answer, effect: EffectEntry) -> float:
    """Return the probability that an effect or one of its look-alikes is a true cause.

    Args:
        answer: Content of diagnosis.json.
        effect: An identified effect.
    """
    for one in answer.get("signs", {}).get("effects", []):
        if one["name"] == effect["name"]:
            return one["probability"]
    return 1.0


def _states_stand_ins(answer: Answer) -> bool:
    """Return whether effects are stated as what describes an unknown cause best."""
    return bool(answer["unknown"].get("stand_ins")) and not states_any(answer)


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


def count_in_words(count: int, noun: str) -> str:
    """Return a count of things in words, with numbers up to six spelt out: two effects."""
    number_words = str(count)
    if count < len(COUNTS):
        number_words = COUNTS[count]
    if count == 1:
        return f"{number_words} {noun}"
    return f"{number_words} {noun}s"


def _formulas(answer: Answer, effects_precede: bool) -> tuple[list[str], list[str]]:
    """Return statements on the formulas: those that are stated, and those that are uncertain.

    Of the stated ones, those that generalize are first, single events follow as a count. The
    uncertain ones are mentioned without their terms.
    """
    general, events, others = list[str](), list[str](), list[DescribedEntry]()
    for law in answer["described"]:
        if not is_stated(answer, law):
            others.append(law)
        elif is_event(law):
            events.append(law["statement"])
        else:
            general.append(f"the model lacks {law['statement']}")
    if general or effects_precede:
        statements = general[:MOST_NUMBERS]
        if len(events) == 1:
            statements.append(f"one further force remains: {events[0]}")
        elif events:
            statements.append(f"{len(events)} further forces remain, the first is {events[0]}")
    else:
        statements = [f"the model lacks {event}" for event in events[:MOST_NUMBERS]]
    if statements and effects_precede:
        statements[0] = f"in addition, {statements[0]}"
    return statements, _uncertain_formulas(answer, others)


def _uncertain_formulas(answer: Answer, formulas: Sequence[DescribedEntry]) -> list[str]:
    """Return statements on formulas that are not certain: what they describe, and the doubt."""
    any_held_out = bool(answer.get("fit", {}).get("held_out"))
    found = []
    for confirmed in (False, True):
        alike = [formula for formula in formulas if formula["carries_over"] == confirmed]
        if not alike:
            continue
        several = len(alike) > 1
        subject = "formulas describe" if several else "a formula describes"
        forces = dict.fromkeys(axis_force_words(formula["axis"]) for formula in alike)
        reason = doubt(alike[0], any_held_out, several=several)
        found.append(f"{subject} {join_words(list(forces))} in the fitted recordings, but {reason}")
    return found


def _look_alikes(effects: Sequence[EffectEntry]) -> list[str]:
    ties = []
    for effect in effects:
        if effect["tied_with"]:
            rivals = join_words(map(name_in_words, effect["tied_with"]), "or")
            ties.append(f"{name_in_words(effect['name'])} from {rivals}")
    if not ties:
        return []
    return [f"these recordings cannot distinguish {join_words(ties)}"]


def tied_groups_statement(effect: EffectEntry) -> str:
    """Return the statement that an effect may act in another group of recordings instead.

    Recordings of two groups alone show how these differ, and hardly which of them agrees with the
    vessel file. Returns "" if the recordings show the group.

    Args:
        effect: An identified effect.
    """
    if not effect.get("tied_groups"):
        return ""
    name = name_in_words(without_group(effect["name"]))
    groups = join_words((effect["group"], *effect["tied_groups"]), "or")
    return (
        f"these recordings do not show whether {name} is of group {groups}, only that these groups "
        "differ"
    )


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
        meaning = words.get(f"{effect['name']}.{key}", "")
        value, way = _size_and_direction(p["value"], meaning)
        name, text = format_parameter(key, value, p["unit"], p["sd"])
        text += way
        if effect["kind"] == "measurement":  # "error heading north" is clearer than "cos"
            name = meaning or name
        if p.get("at_bound"):
            text += ", the bound of its range"
        numbers.append(f"{name} {text}")
    return ", ".join(numbers)


def _size_and_direction(value: float, meaning: str) -> tuple[float, str]:
    """Return a signed value as its size, with words for its direction if its meaning has them."""
    for ending, opposite in OPPOSITES.items():
        if meaning.endswith(ending):
            way = ending.removeprefix("positive ") if value > 0.0 else opposite
            return abs(value), f" {way}"
    return value, ""


def effects_of_kind(answer: Answer, kind: str) -> list[EffectEntry]:
    """Return the identified effects that are missing physics, or those that are measurement errors.

    Args:
        answer: Content of diagnosis.json.
        kind: "physics" or "measurement".
    """
    return [effect for effect in answer["effects"] if effect["kind"] == kind]
