"""Section of a report on what to record next."""

import math
from collections.abc import Iterator, Sequence

from boatsim.diagnosis.answer.findings import Findings
from boatsim.view.formatting import (
    capitalize,
    evidence_strength,
    format_nats,
    format_odds,
    format_parameter,
    format_sentence,
    join_words,
    name_and_unit,
    name_in_words,
)
from boatsim.view.page_blocks import (
    STATISTICS,
    Block,
    Items,
    Note,
    Table,
    Text,
)


def next_experiment_section(f: Findings) -> Iterator[Block]:
    """Yield the manoeuvre that would add most evidence, and how to perform it.

    Args:
        f: Findings of a diagnosis.
    """
    wanted = f.answer["next_experiment"]
    if not wanted:
        if f.answer["effects"]:
            odds = math.exp(f.setting("plan.min_gain"))
            start = "These recordings decide the question"
            if _is_open(f):
                start = "No further recording of this kind settles what is still open"
            yield Text(
                f"{start}: none of the manoeuvres considered is expected to change the odds "
                f"between an identified effect and its rivals by more than a factor of {odds:.1f}."
            )
            yield from _about_unknown_cause(f)
        return
    if is_optional(f):
        yield Text(
            "This is optional: the recordings already support the answer above with the "
            "probability stated there. The manoeuvre would test it against its closest rival."
        )
    scenario = wanted["scenario"]
    rivals = []
    for name in wanted["separates"]:
        rivals.append("no effect at all" if name == "nothing" else name_in_words(name))
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
    yield from _about_unknown_cause(f)
    yield Note(STATISTICS, f"The expected log Bayes factor is {format_nats(gain)} nats.")
    if f.steps:
        yield _commands(f)


def is_optional(f: Findings) -> bool:
    """Return whether the next experiment would only confirm an answer that is sure without it.

    An answer is sure if each identified effect is stated without the word probably, has no
    look-alike, and no other effect and no force remain in doubt. The experiment must test it.

    Args:
        f: Findings of a diagnosis.
    """
    wanted, effects = f.answer["next_experiment"], f.answer["effects"]
    if not wanted or f.answer["verdict"] != "named" or f.answer.get("also_possible"):
        return False
    if not {effect["name"] for effect in effects} & set(wanted["separates"]):
        return False
    return not _is_open(f)


def _is_open(f: Findings) -> bool:
    """Return whether an effect has a look-alike, is not sure, or only possible."""
    sure = f.setting("decide.sure_probability")
    if f.answer.get("also_possible"):
        return True
    return any(e["tied_with"] or e["probability"] < sure for e in f.answer["effects"])


def _about_unknown_cause(f: Findings) -> Iterator[Block]:
    """Yield how to find a cause that no candidate effect describes."""
    if f.answer["unknown"]["flag"]:
        yield Text(
            "No manoeuvre tells what the unknown cause is. To find it, repeat a recording in which "
            "the force is missing with one thing changed at a time, such as the battery, the "
            "loading, the trim or the place."
        )


def _not_in_doubt(f: Findings, separated: Sequence[str]) -> str:
    """Return why the next experiment tests none of the identified effects; "" if it does."""
    named = [effect["name"] for effect in f.answer["effects"]]
    if not named or set(named) & set(separated):
        return ""
    return (
        f"It is no test of {join_words(map(name_in_words, named))}, about which these recordings "
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
