"""Table and remarks on the errors of the vessel before, retuned and corrected."""

from typing import NamedTuple

import numpy as np

from boatsim.diagnosis.evaluation import Evaluation, PartErrors
from boatsim.diagnosis.model_names import ALONE, MODELS, model_names_in_words
from boatsim.diagnosis.problem import Problem
from boatsim.diagnosis.search.ranking import Ranking
from boatsim.view.formatting import format_odds

Table = tuple[str, list[str], list[list[str]]]  # title, header, rows


class _Unit(NamedTuple):
    """How the rms of a family of signals is written."""

    signal: str
    unit: str
    scale: float  # of the value in SI units

    def text(self, rms: float, digits: int = 3) -> str:
        return f"{rms * self.scale:.{digits}g}"


def error_table(evaluation: Evaluation) -> Table | None:
    """Return the report's table of simulation errors before and after the diagnosis.

    It compares the vessel model before, retuned and corrected over every fitted recording; those of
    the held-out ones have a table of their own. None is returned if there are no errors.

    Args:
        evaluation: Free runs of the models.
    """
    rows = []
    for part in evaluation.parts:
        if not part.fitted:
            continue
        unit = _unit_of(part.family)
        ratio = part.rms["patched"] / part.rms["recalibrated"]
        errors = [unit.text(part.rms[model]) for model in (*MODELS, ALONE)]
        label = f"{unit.signal} [{unit.unit}]"
        rows.append([part.name, label, *errors, f"{ratio:.2f}"])
    if not rows:
        return None
    header = [
        "fitted recording",
        "rms error of",
        *model_names_in_words(MODELS),
        "retuned to this part alone",
        "corrected / retuned",
    ]
    return f"Free runs of {evaluation.horizon:g} s over the fitted recordings", header, rows


def limitation_sentences(
    problem: Problem, ranking: Ranking, evaluation: Evaluation
) -> tuple[str, ...]:
    """Return sentences of the report on limits of a diagnosis.

    They concern errors that the patched vessel does not reduce, force that remains unexplained, and
    recordings that the nominal vessel model explains as well.

    Args:
        problem: The estimation problem: recordings, vessel model, candidate effects and priors.
        ranking: Result of the selection of effects, with the formula, if one was found.
        evaluation: Free runs of the models.
    """
    return (
        *_no_gain(ranking, evaluation),
        *_unexplained(problem, ranking),
        *_uninformative(evaluation),
    )


def _no_gain(ranking: Ranking, evaluation: Evaluation) -> list[str]:
    """Return a sentence for each error on held-out data that the patch does not reduce."""
    found: list[str] = []
    if not ranking.adds_effects:
        return found
    for family, rms in evaluation.errors.items():
        if rms["patched"] > rms["recalibrated"]:
            unit = _unit_of(family)
            found.append(
                f"The correction does not reduce the error of {unit.signal} on held-out data: "
                f"{unit.text(rms['patched'])} {unit.unit}, the retuned vessel "
                f"{unit.text(rms['recalibrated'])} {unit.unit}."
            )
    return found


def _unexplained(problem: Problem, ranking: Ranking) -> list[str]:
    """Return a sentence on the force beyond the assumed disturbance that remains."""
    described, remaining = ranking.description, ranking.left_over
    if described:
        remaining = described.left_over
    if not remaining > ranking.told_from:
        return []
    if described:
        why = "the formula does not account for all of it"
    elif ranking.first:
        why = "none of the candidate effects accounts for it"
    else:
        why = "no candidate effect was tested"
    factor = problem.config.locate.disturbance_factor
    return [
        "A force beyond the assumed disturbance level remains unexplained "
        f"({format_odds(remaining)}): it is more than {factor:g} times that level, and {why}."
    ]


def _uninformative(evaluation: Evaluation) -> list[str]:
    """Return a sentence for each fitted part of the data that does not show what is missing."""
    found = []
    for name in evaluation.uninformative:
        own = [part for part in evaluation.parts if part.name == name]
        errors = " and ".join(map(_compared, own))
        found.append(
            f"{name}: the model before, retuned to this part alone, already has an error of "
            f"{errors}. This part alone does not show what is missing."
        )
    return found


def _compared(part: PartErrors) -> str:
    """Return the errors of the model retuned to a part alone, and of the corrected vessel."""
    unit = _unit_of(part.family)
    alone, patched = unit.text(part.rms[ALONE], 2), unit.text(part.rms["patched"], 2)
    return f"{alone} {unit.unit} in {unit.signal} (corrected vessel: {patched} {unit.unit})"


def _unit_of(family: str) -> _Unit:
    if family == "position_rms_m":
        return _Unit("position", "m", 1.0)
    return _Unit(family.split("_")[0], "deg", float(np.degrees(1.0)))
