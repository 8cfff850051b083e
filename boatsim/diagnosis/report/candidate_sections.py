"""Sections of a report on the candidate effects: their ranking, and upper limits."""

import math
from collections.abc import Iterator

import numpy as np

from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.verdict import effect_description
from boatsim.view.formatting import (
    NO_ODDS,
    format_nats,
    format_probability,
    format_upper_limit,
    name_in_words,
    short_odds,
)
from boatsim.view.page_blocks import (
    Block,
    Note,
    Table,
    without_empty_columns,
)

MOST_VISIBLE_CANDIDATES = 8  # rows of the ranking that are not folded


def candidate_ranking_section(f: Findings) -> Iterator[Block]:
    """Yield the evidence for each candidate effect alone: the best ones as odds, all on request.

    Args:
        f: Findings of a diagnosis.
    """
    candidates = f.answer["candidates"]
    if not candidates:
        return
    status, visible = _status(f), MOST_VISIBLE_CANDIDATES
    rows, gains = [], []
    for i, c in enumerate(candidates, 1):
        name, gain = c["name"], c["gain_nats"]
        odds = short_odds(gain)
        gains.append(0.0 if odds == NO_ODDS else gain)
        if name in status:
            visible = max(visible, i)
        verdict = status.get(name) or _reason_against(f, name, gain)
        rows.append([name_in_words(name), odds, verdict, f.words.get(name, "")])
    bars = tuple((np.maximum(gains, 0.0) / max(*gains, 1e-9)).tolist())
    caption = (
        "Each candidate effect tested alone, the best ones first. The odds are those that the "
        "better fit is chance; the bars compare the evidence, which is listed below. Small odds "
        "alone do not make a candidate a cause, because several can imitate the same error. For an "
        "identified effect they differ from the value above, which is computed in the presence of "
        "all other identified effects."
    )
    header = ["candidate", "odds of chance", "verdict", "meaning"]
    yield without_empty_columns(
        Table(caption, header, rows[:visible], (2, 3), bars[:visible], aside=True)
    )
    yield from _evidence_of_all(f)


def _evidence_of_all(f: Findings) -> Iterator[Block]:
    """Yield the evidence for all candidate effects in nats, on request."""
    candidates, rows = f.answer["candidates"], list[list[str]]()
    failed = f.setting("select.screening_failure")
    for c in candidates:
        probability, evidence = format_probability(c["probability"]), format_nats(c["gain_nats"])
        if c["gain_nats"] < -failed:
            evidence = f"below {format_nats(-failed)}"
        meaning = f.words.get(c["name"], "")
        rows.append([name_in_words(c["name"]), evidence, probability, meaning])
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
        "The evidence compares the retuned vessel with and without the candidate. It is that of "
        "a quick fit, except for the best candidates. Below "
        f"{format_nats(-failed)} nats it is only known that the candidate explains too little for "
        "its parameters, or that the quick fit failed. The probability "
        "assumes that exactly one of these candidates is missing, or none. The probabilities add "
        "up to 100 %, so that only the strongest of several missing effects has a high "
        "probability. It is not the probability that an effect is a true cause.",
    )


def _reason_against(f: Findings, name: str, gain: float) -> str:
    """Return why a candidate that gains evidence alone is not identified; "" if it gains none."""
    required = f.setting("select.least_gain")
    if "rules" in f.answer:
        required = f.answer["rules"]["effect_gain_nats"]
    if short_odds(gain) == NO_ODDS or f.answer.get("skipped"):
        return ""
    if gain < required:
        return "too little evidence"
    effects = [name_in_words(e["name"]) for e in f.answer["effects"]]
    if not effects or f.further_gains.get(name, math.inf) >= required:
        return ""
    if len(effects) == 1:
        return f"{effects[0]} explains the recordings better"
    return "the identified effects explain the recordings better"


def _status(f: Findings) -> dict[str, str]:
    """Return the verdict on identified effects and their look-alikes, by name."""
    status = {}
    for possible in f.answer.get("also_possible", []):
        status[possible["name"]] = "also possible"
    for refined in f.answer.get("refined", []):
        status[refined["name"]] = "number refined"
    for e in f.answer["effects"]:
        for rival in e["tied_with"]:
            status[rival] = f"look-alike of {name_in_words(e['name'])}"
    for e in f.answer["effects"]:
        status[e["name"]] = "identified"
    return status


def upper_limits_section(f: Findings) -> Iterator[Block]:
    """Yield the largest strength that each effect may have that was not found.

    Args:
        f: Findings of a diagnosis.
    """
    rows = []
    for name, values in limits_of_effects_not_found(f).items():
        limits = []
        for key, value in f.answer.get("lower_limits", {}).get(name, {}).items():
            words, text = format_upper_limit(key, value)
            limits.append(f"{words} at least {text}")
        for key, value in values.items():
            words, text = format_upper_limit(key, value)
            if name in f.own_effects:
                text += " more or less than in the vessel file"
            limits.append(f"{_measurement_meaning(f, name, key) or words} {text}")
        if limits:
            rows.append([name_in_words(name), ", ".join(limits), f.words.get(name, "")])
    if not rows:
        return
    caption = (
        "With 95 % confidence each effect is weaker than this, if nothing else is missing. The "
        "limit of a factor or fraction, and of an effect that the vessel has already, is its "
        "distance from the value in the vessel file."
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


def limits_of_effects_not_found(f: Findings) -> dict[str, dict[str, float]]:
    """Return the upper limits without those of look-alikes, which may be the true cause.

    Args:
        f: Findings of a diagnosis.
    """
    limits = dict(f.answer["upper_limits"])
    for e in f.answer["effects"]:
        for rival in e["tied_with"]:
            limits.pop(rival, None)
    return limits
