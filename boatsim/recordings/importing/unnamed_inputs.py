"""Comments of a proposed map on inputs that a log has and the vessel's file does not name."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from boatsim.files import toml_key, toml_value
from boatsim.recordings.expression import parse
from boatsim.recordings.importing.log import Log
from boatsim.recordings.importing.measured_lines import (
    SUPPLY,
    InputSignal,
    lines_of_input,
    most_probable_first,
)
from boatsim.recordings.importing.supply_currents import supply_current_inputs
from boatsim.recordings.importing.voltages import voltage_inputs
from boatsim.recordings.notes import unit_of

HEADING = (
    "# Measured on board, but not named in [measured] of the vessel. To use it, add to its "
    "vessel.toml:"
)
LARGE = 90.0  # [%] percentile of a current that is proposed as the nominal one


class NewInput(NamedTuple):
    """An input that a vessel's file may name.

    Attributes:
        column: Its column.
        about: Description of the input.
        found: Signals of the log that may be it.
        percentile: Percentile of the readings that is proposed as the nominal value [%]; None for
            a quantity without one.
    """

    column: str
    about: str
    found: Sequence[InputSignal]
    percentile: float | None = None


def supply_inputs(measured: Collection[str], log: Log) -> list[NewInput]:
    """Return the voltage and the current of a log that a vessel's file does not name.

    Args:
        measured: Measured quantities that the vessel's file names.
        log: The log.
    """
    units = {unit_of(name) for name in measured}
    new = (
        NewInput("battery_V", "voltage of the supply", voltage_inputs(log), 50.0),
        NewInput("battery_A", "current of the supply", supply_current_inputs(log), LARGE),
    )
    return [one for one in new if one.found and unit_of(one.column) not in units]


def unnamed_input_lines(new: Sequence[NewInput], log: Log) -> str:
    """Return comments that state what to add to a vessel's file and to the map.

    Args:
        new: Inputs that the log has and the vessel's file does not name; one without signals is
            made by a table of the map.
        log: The log.

    Returns:
        The lines; "" for none.
    """
    tables, lines = "", ""
    for one in new:
        if one.found:
            text = lines_of_input(one.column, one.about, one.found, SUPPLY)
            for line in text.splitlines():
                lines += f"# {line.removeprefix('# ')}\n"
        about = f"about = {toml_value(one.about)} }}"
        if one.percentile is None:
            tables += f"# {toml_key(one.column)} = {{ {about}\n"
            continue
        nominal = _percentile(one, one.percentile, log)
        tables += (
            f"# {toml_key(one.column)} = {{ neutral = {nominal:.3g}, {about}  # neutral: the "
            "nominal value\n"
        )
    if not tables:
        return ""
    text = f"\n{HEADING}\n# [measured]\n{tables}"
    if lines:
        text += f"# and use these lines here:\n{lines}"
    return text


def _percentile(one: NewInput, share: float, log: Log) -> float:
    """A percentile of the readings of the most probable signal, in the unit of the input."""
    best = most_probable_first(one.column, one.found, SUPPLY)[0]
    expression = parse(best.expression, log.signals.keys())
    values = expression.convert(log.signals[expression.signal].values)
    return float(np.nanpercentile(values, share))
