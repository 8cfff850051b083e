"""Which formulas an answer states: those that held-out recordings confirm, and single events."""

from boatsim.diagnosis.answer.findings import setting_of
from boatsim.diagnosis.answer.schema import Answer, DescribedEntry


def is_event(formula: DescribedEntry) -> bool:
    """Return whether a formula describes an event of one recording, which no other can confirm."""
    return any("run" in term for term in formula["terms"])


def is_determined(formula: DescribedEntry, least: float) -> bool:
    """Return whether the recordings determine all coefficients of a formula.

    Args:
        formula: A formula of diagnosis.json.
        least: Smallest distance of a determined coefficient from zero [standard deviations].
    """
    return all(abs(term["value"]) >= least * term["sd"] for term in formula["terms"])


def is_stated(answer: Answer, formula: DescribedEntry) -> bool:
    """Return whether the verdict states a formula in words.

    Args:
        answer: Content of diagnosis.json.
        formula: One of its formulas.
    """
    if is_event(formula):
        return True
    least = setting_of(answer, "answer.formula_sds")
    return formula["carries_over"] and is_determined(formula, least)


def states_any(answer: Answer) -> bool:
    """Return whether the verdict states any formula in words."""
    return any(is_stated(answer, formula) for formula in answer["described"])


def doubt(formula: DescribedEntry, any_held_out: bool, *, several: bool = False) -> str:
    """Return the reason, as a clause, why the verdict does not state a formula.

    Args:
        formula: A formula of diagnosis.json that is not stated.
        any_held_out: Whether any recording was held out.
        several: Whether the clause is about several formulas.
    """
    if formula["carries_over"]:
        return f"these recordings do not determine {'their' if several else 'its'} coefficients"
    pronoun = "them" if several else "it"
    if not any_held_out:
        return f"no recording was held out that could confirm {pronoun}"
    return f"held-out recordings do not confirm {pronoun}"
