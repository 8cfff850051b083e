"""Entries and reasons of an answer about what held-out recordings show of each effect."""

from collections.abc import Mapping

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.schema import AloneEntry, Family
from boatsim.diagnosis.open_set.confirmation import Errors
from boatsim.diagnosis.open_set.decision import Judgement
from boatsim.view.formatting import format_in_one_unit, join_words


def effect_error_entry(errors: Mapping[str, Errors]) -> dict[Family, AloneEntry]:
    """Return errors on held-out recordings without and with an effect, as in diagnosis.json.

    The errors are those of simulations with the recorded commands alone.

    Args:
        errors: Rms errors by family of signals (position, heading, roll or heave).
    """
    found: dict[Family, AloneEntry] = {}
    for family in FAMILIES:
        if family in errors:
            pair = errors[family]
            found[family] = {"without": pair.without, "with": pair.with_effect}
    return found


def reason_unconfirmed(judged: Judgement) -> str:
    """Return the reason, in words, why held-out recordings do not confirm an effect.

    Args:
        judged: Statistics and probability of the effect.
    """
    reason = "held-out recordings, which could show it, are explained as well without it"
    changes = join_words(error_changes(effect_error_entry(judged.alone)))
    if changes:
        reason += f": there adding it {changes}"
    return reason


def error_changes(alone: Mapping[Family, AloneEntry]) -> list[str]:
    """Return phrases such as: reduces the position error from 0.52 m to 0.31 m."""
    reduced, increased, same = list[str](), list[str](), list[str]()
    for family, (words, unit) in FAMILIES.items():
        if family not in alone:
            continue
        pair = alone[family]
        before, after = format_in_one_unit([pair["without"], pair["with"]], unit)
        if before == after:
            same.append(f"the {words} error ({after})")
        elif pair["with"] < pair["without"]:
            reduced.append(f"the {words} error from {before} to {after}")
        else:
            increased.append(f"the {words} error from {before} to {after}")
    found = []
    for verb, phrases in (
        ("reduces", reduced),
        ("increases", increased),
        ("does not change", same),
    ):
        if phrases:
            found.append(f"{verb} {join_words(phrases)}")
    return found
