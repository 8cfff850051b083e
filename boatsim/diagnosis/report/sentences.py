"""Sentences of a report: the validation, the assumptions, and the summary on the console."""

import itertools
from collections.abc import Sequence

from boatsim.diagnosis.answer.described_terms import axis_force_words
from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.incomplete import is_failure
from boatsim.diagnosis.answer.refined_numbers import refined_number_rows
from boatsim.diagnosis.answer.schema import (
    Answer,
    DisturbanceLevelEntry,
    EffectEntry,
    LeftOutEntry,
    MeanEntry,
)
from boatsim.diagnosis.answer.verdict import effects_of_kind
from boatsim.diagnosis.model_names import MODEL_WORDS, MODELS
from boatsim.diagnosis.report.confirmation import effect_sentences, recalibration_sentences
from boatsim.diagnosis.report.experiment_section import is_optional
from boatsim.view.formatting import (
    format_cause_probability,
    format_in_one_unit,
    format_nats,
    format_number,
    format_odds,
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
            factor = _improvement_factor(gain, f.setting("answer.unchanged_share"))
            compared.append(f"{after} in {words} instead of {before} ({factor})")
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
    compared_with = "retuned vessel, whose own coefficients were refitted"
    if f.answer.get("recalibration", {}).get("adopted") is False:
        compared_with = "vessel as written, because refitted coefficients alone make it worse"
    return (
        f"{caution}{runs}, the corrected vessel has an rms error of {join_words(compared)}. The "
        f"comparison is with the {compared_with}."
    )


def _improvement_factor(gain: float, unchanged: float) -> str:
    if 1.0 - unchanged < gain < 1.0 + unchanged:
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
    groups = []
    for reason, names in by_reason.items():
        stated = "stated: " if " = " in reason else ""  # a fact
        groups.append(f"{join_words(names)} ({stated}{reason})")
    return "; ".join(groups)


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
