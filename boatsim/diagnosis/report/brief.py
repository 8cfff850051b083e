"""The result of a diagnosis in a few lines for a reader who has never seen one."""

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.model_names import MODELS, model_names_in_words
from boatsim.view.formatting import (
    format_in_one_unit,
    format_number,
    format_odds,
    format_probability,
    join_words,
    name_in_words,
)

DEVIATION = "  (± is one standard deviation; after a percentage, in percentage points)"
EXPLANATION = (
    "(before: the model as given; retuned: its own numbers refitted; corrected: with the effect)"
)


def summary_lines(f: Findings) -> list[str]:
    """Return a diagnosis in a few lines: what is missing, how sure, errors on held-out recordings.

    Args:
        f: Findings of a diagnosis.
    """
    lines = [f.answer["sentence"]]
    if "±" in lines[0]:
        lines.append(DEVIATION)
    effects = f.answer["effects"]
    for effect in effects:
        probability, cause = format_probability(effect["probability"]), "this effect"
        if len(effects) > 1:
            cause = name_in_words(effect["name"])
        lines.append(
            f"How sure: something is missing ({format_odds(effect['gain_nats'])}); {probability} "
            f"that it is {cause}, and not another one that imitates it."
        )
    if errors := _error_lines(f):
        held_out = join_words(f.answer["fit"]["held_out"])
        lines.append(f"Errors of the simulation on held-out recordings ({held_out}):")
        lines += errors
        lines.append(f"  {EXPLANATION}")
    return lines


def _error_lines(f: Findings) -> list[str]:
    """Return the errors of position, heading, roll and heave, as far as they were recorded."""
    lines = []
    for family, (words, unit) in FAMILIES.items():
        rms = f.answer["fit"].get(family)
        if not rms:
            continue
        errors = format_in_one_unit([rms[model] for model in MODELS], unit)
        pairs = zip(errors, model_names_in_words(MODELS), strict=True)
        text = ", ".join(f"{error} {model}" for error, model in pairs)
        gain = rms["recalibrated"] / max(rms["patched"], 1e-300)
        lines.append(f"  {words}: {text}: {format_number(gain, 2)} times smaller than retuned")
    return lines
