"""Tables of a tuned controller: its gains, and the errors of drawn boats before and after."""

from math import degrees

from boatsim.recordings.notes import unit_of
from boatsim.sweeps.robustness.tuning import ConditionResult, Design, Tuning
from boatsim.sweeps.text_tables import TextTable


def tuning_tables(found: Tuning) -> list[TextTable]:
    """Return the table of the gains, and that of the errors.

    Args:
        found: Result of the search.
    """
    return [gains_table(found), errors_table(found)]


def gains_table(found: Tuning) -> TextTable:
    """Return each gain before and after, with its range.

    Args:
        found: Result of the search.
    """
    params, rows = type(found.controller).params(), []
    for gain in found.ranges:
        unit = params[gain.name].unit
        words = f"{gain.name} [{unit}]" if unit else gain.name
        values = [found.start.gains[gain.name], found.best.gains[gain.name]]
        numbers = [f"{value:.4g}" for value in (*values, gain.low, gain.high)]
        rows.append([words, *numbers])
    title = f"Gains, best of {found.designs} designs on {found.boats} boats of {found.vessel.name}"
    return TextTable("gains", title, ["gain", "before", "tuned", "from", "to"], rows, 1)


def errors_table(found: Tuning) -> TextTable:
    """Return errors and survivors before and after on boats that the search has not seen.

    The error is the rms value that 95 % of the boats do not exceed. A design that does not meet the
    L1-norm condition has none.

    Args:
        found: Result of the search.
    """
    head = ["disturbance"]
    for signal in found.signals:
        head += [f"{signal.goal} [{_shown_unit(signal.column)}]", "tuned"]
    head += ["survivors", "tuned"]
    rows = []
    for number, result in enumerate(found.best.results):
        before = _result(found.start, number)
        row = [result.condition.words]
        for place, signal in enumerate(found.signals):
            for one in (before, result):
                row.append(_error(one, place, signal.column))
        row += [_survivors(before), _survivors(result)]
        rows.append(row)
    title = (
        f"Rms errors that 95 % of {found.boats} other boats do not exceed, before and tuned "
        f"(seed {found.seed})"
    )
    return TextTable("errors", title, head, rows, 1)


def _result(design: Design, number: int) -> ConditionResult | None:
    return design.results[number] if design.results else None


def _error(result: ConditionResult | None, place: int, column: str) -> str:
    if result is None:
        return "-"
    value = float(result.errors[place])
    return f"{degrees(value) if unit_of(column).startswith('rad') else value:.3g}"


def _survivors(result: ConditionResult | None) -> str:
    return "-" if result is None else f"{100.0 * result.survivors:.0f} %"


def _shown_unit(column: str) -> str:
    """Unit of a column, with degrees in place of radians."""
    return unit_of(column).replace("rad", "deg")
