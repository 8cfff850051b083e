"""Tables of a robustness benchmark as text, for the terminal and the page."""

from collections.abc import Sequence
from math import degrees, isinf, isnan

import numpy as np

from boatsim.recordings.notes import unit_of
from boatsim.sweeps.robustness.benchmark import Robustness
from boatsim.sweeps.robustness.disturbances import DISTURBANCES
from boatsim.sweeps.robustness.manoeuvre import TrackedSignal
from boatsim.sweeps.robustness.survival import Ladder, LadderPoint
from boatsim.sweeps.text_tables import TextTable
from boatsim.view.formatting import name_in_words


def result_tables(found: Robustness) -> list[TextTable]:
    """Return the table of the largest values survived, and that of the errors.

    Args:
        found: Result of a benchmark.
    """
    return [limits_table(found), errors_table(found)]


def limits_table(found: Robustness) -> TextTable:
    """Return the largest value of each disturbance that 95 % of the boats survive.

    Each row has the value with its share of survivors in per cent, and the next value with its
    share. The intervals are Wilson's for 95 %.

    Args:
        found: Result of a benchmark.
    """
    head = ["disturbance", "controller", "largest", "survivors", "next", "survivors"]
    rows = []
    for disturbance in found.disturbances:
        for controller in found.controllers:
            ladder = found.ladder(controller, disturbance)
            words = name_in_words(disturbance)
            if ladder.unit:
                words = f"{words} [{ladder.unit}]"
            rows.append([words, controller, *_limit_cells(ladder)])
    title = (
        f"Largest value that 95 % of {len(found.boats)} boats of {found.vessel.name} survive "
        f"(seed {found.boats.seed})"
    )
    return TextTable("limits", title, head, rows, 2)


def errors_table(found: Robustness) -> TextTable:
    """Return the errors without disturbance and at the largest value that all controllers survive.

    Args:
        found: Result of a benchmark.
    """
    head = ["disturbance", "value", "signal"]
    for name in found.controllers:
        head += [f"{name} median", "95 %"]
    if len(found.controllers) == 2:
        first, second = found.controllers
        head.append(f"mean of {second} - {first}")
    rows = []
    ladders = [found.ladder(name, found.disturbances[0]) for name in found.controllers]
    rows += _error_rows(found, "none", [ladder.points[0] for ladder in ladders], "")
    for disturbance in found.disturbances:
        ladders = [found.ladder(name, disturbance) for name in found.controllers]
        common = min(len(ladder.survived_points) for ladder in ladders)
        if common > 1:
            points = [ladder.points[common - 1] for ladder in ladders]
            rows += _error_rows(found, disturbance, points, ladders[0].unit)
    title = "Rms error at the largest value that all controllers survive"
    return TextTable("errors", title, head, rows, 3)


def surface_table(found: Robustness, disturbance: str) -> TextTable:
    """Return survivors and errors at every value of a disturbance.

    Args:
        found: Result of a benchmark.
        disturbance: Name of the disturbance.
    """
    head = ["controller", "value", "survivors", "95 % interval"]
    for signal in found.signals:
        words = signal_in_words(signal)
        head += [f"{words}: median", "95 %", "largest"]
    rows = []
    for controller in found.controllers:
        ladder = found.ladder(controller, disturbance)
        for point in ladder.points:
            low, high = point.interval
            row = [controller, f"{point.value:g} {ladder.unit}".rstrip(), _per_cent(point.share)]
            row.append(f"{_per_cent(low)} to {_per_cent(high)}")
            for number, signal in enumerate(found.signals):
                quantiles = point.error_quantiles(number)
                row += [format_error(value, signal) for value in quantiles]
            rows.append(row)
    return TextTable(disturbance, disturbance_in_words(disturbance), head, rows, 1)


def notes(found: Robustness) -> list[str]:
    """Return the criterion of survival, and what was not judged or does not apply.

    Args:
        found: Result of a benchmark.
    """
    judged = []
    lines = []
    for signal, bar in zip(found.signals, found.bars.tolist(), strict=True):
        words = signal_in_words(signal)
        if isinf(bar):
            lines.append(
                f"{words} is not judged: no controller keeps it within "
                f"{format_error(signal.bar, signal)} on half of the boats without disturbance"
            )
        else:
            judged.append(f"{words} {format_error(bar, signal)}")
    lines.insert(
        0,
        "a boat survives if the rms error of the settled motion is at most 10 % of the set point: "
        f"{', '.join(judged)}",
    )
    for name, reason in found.unavailable.items():
        lines.append(f"{name_in_words(name)} does not apply: {reason}")
    return lines


def disturbance_in_words(name: str) -> str:
    """Return a disturbance with what its value means.

    Args:
        name: Name of the disturbance.
    """
    for one in DISTURBANCES:
        if one.name == name:
            unit = f" [{one.unit}]" if one.unit else ""
            return f"{name_in_words(name)}: {one.words}{unit}"
    return name_in_words(name)


def signal_in_words(signal: TrackedSignal) -> str:
    """Return a signal with the unit in which errors are printed, "yaw [deg/s]"."""
    unit = unit_of(signal.column).replace("rad", "deg")
    return f"{signal.goal.rpartition('_')[0]} [{unit}]"


def error_in_print(value: float, signal: TrackedSignal) -> float:
    """Return an error in the unit in which it is printed: angles are in degrees."""
    if "rad" in unit_of(signal.column):
        return degrees(value)
    return value


def format_error(value: float, signal: TrackedSignal) -> str:
    """Return an error as text in the printed unit."""
    if isinf(value):
        return "diverged"
    return f"{error_in_print(value, signal):.3g}"


def _limit_cells(ladder: Ladder) -> list[str]:
    """Largest value survived and the first one not survived, each with its survivors."""
    cells = ["none", ""]
    if not isnan(ladder.largest_survived):
        point = ladder.survived_points[-1]
        value = f"{point.value:g}"
        if ladder.first_failed is None:
            value = f"{point.value:g} or more"
        cells = [value, _survivors(point)]
    failed = ladder.first_failed
    if failed is None:
        return [*cells, "", ""]
    return [*cells, f"{failed.value:g}", _survivors(failed)]


def _survivors(point: LadderPoint) -> str:
    low, high = point.interval
    return f"{_per_cent(point.share)} ({100.0 * low:.0f} to {100.0 * high:.0f})"


def _per_cent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _error_rows(
    found: Robustness, disturbance: str, points: Sequence[LadderPoint], unit: str
) -> list[list[str]]:
    """Median and 95 % quantile of the errors of each controller, a row for each judged signal."""
    rows = []
    for number, signal in enumerate(found.signals):
        if isinf(found.bars[number]):
            continue
        value = ""
        if disturbance != "none":
            value = f"{points[0].value:g} {unit}".rstrip()
        row = [name_in_words(disturbance), value, signal_in_words(signal)]
        for point in points:
            median, high, _ = point.error_quantiles(number)
            row += [format_error(median, signal), format_error(high, signal)]
        if len(points) == 2:
            row.append(_difference(points, number, signal))
        rows.append(row)
    return rows


def _difference(points: Sequence[LadderPoint], number: int, signal: TrackedSignal) -> str:
    """Mean difference of the errors on the same boats that both survive, with its 95 % interval."""
    both = points[0].survived & points[1].survived
    difference = points[1].errors[both, number] - points[0].errors[both, number]
    if len(difference) < 2:
        return ""
    mean = error_in_print(float(np.mean(difference)), signal)
    scatter = 1.96 * float(np.std(difference, ddof=1)) / len(difference) ** 0.5
    return f"{mean:+.2g} ± {error_in_print(scatter, signal):.1g}"
