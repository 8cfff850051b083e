"""Section of a report on where and when a force is missing."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.answer.findings import Findings, MissingForceCurve
from boatsim.diagnosis.answer.schema import (
    IntervalEntry,
)
from boatsim.diagnosis.answer.verdict import (
    finds_only_measurement_errors,
    has_refitted_coefficients,
)
from boatsim.diagnosis.report import figures
from boatsim.view import svg_plots
from boatsim.view.formatting import (
    capitalize,
    format_in_one_unit,
    format_nats,
    format_number,
    format_sentence,
)
from boatsim.view.page_blocks import (
    STATISTICS,
    Block,
    Figures,
    Note,
    Table,
    Text,
)

MOST_INTERVALS = 24  # rows of the table of flagged intervals; diagnosis.json has all of them
MOST_MISSING_FIGURES = 6  # recordings whose missing force is drawn: those flagged longest


def missing_force_section(f: Findings) -> Iterator[Block]:
    """Yield the conditions, the sizes, the curves and the intervals of the missing force.

    Args:
        f: Findings of a diagnosis.
    """
    where, verdict = f.answer["where"], f.answer["verdict"]
    if where["region"]:
        rows = []
        for region in where["region"]:
            statement = capitalize(format_sentence(region["statement"]))
            rows.append([statement, format_number(region["p_value"], 1)])
        header = ["condition", "probability of chance (p-value)"]
        yield Table("When the force is missing", header, rows)
    if where["axes"]:
        yield _strengths(f)
        if finds_only_measurement_errors(f.answer):
            yield Text("These forces are not real: they are the result of the measurement error.")
    if f.missing:
        yield from _missing_figures(f)
    if not where["intervals"]:
        return
    if verdict == "nothing_missing":
        unknown = f.answer["unknown"]
        yield Text(
            "An interval is flagged wherever the missing force exceeds the assumed disturbance "
            f"level. {_why_nothing_is_missing(f)}"
        )
        yield Note(
            STATISTICS,
            f"A cause outside the candidates gains {format_nats(unknown['gain_nats'])} of the "
            f"{format_nats(unknown['told_from_nats'])} nats required.",
        )
    yield _interval_table(where["intervals"])


def _why_nothing_is_missing(f: Findings) -> str:
    """Return why the flagged intervals are no finding."""
    if has_refitted_coefficients(f.answer):
        return (
            "The coefficients of the vessel file cause these forces: with refitted ones, what is "
            "left is no more than a disturbance of the assumed kind."
        )
    return (
        "Together the intervals are not enough for a finding: no candidate effect explains them "
        "clearly better than the vessel model alone, and the evidence for a cause outside the "
        "candidates is not sufficient."
    )


def _left_over_words(f: Findings) -> str:
    """Return the words for the force that the final vessel still lacks.

    They are "" if the final vessel is the one of the vessel file, or if its force is not known.
    """
    if not any(m.left for m in f.missing):
        return ""
    if f.has_added_effects:
        return "left with the corrected vessel"
    if has_refitted_coefficients(f.answer):
        return "left with refitted coefficients"
    return ""


def _left_over_rms(f: Findings, axis: str) -> float:
    """Return the rms over all recordings of the force [N, N m] that is left, along one axis."""
    parts = [m.left[axis] for m in f.missing if m.left]
    return float(np.sqrt(np.mean(np.square(np.concatenate(parts)))))


def _strengths(f: Findings) -> Table:
    """Return the table of the missing force of each axis."""
    header, share = ["axis", "missing, rms", "standard deviation, rms"], _flagged_shares(f)
    left = _left_over_words(f)
    if left:
        header.append(f"{left}, rms")
    if share:
        header.append("share of the time flagged")
    rows = []
    for axis, strength in f.answer["where"]["axes"].items():
        sizes = [strength["rms"], strength["sd"]]
        if left:
            sizes.append(_left_over_rms(f, axis))
        row = [axis, *format_in_one_unit(sizes, strength["unit"])]
        if share:
            row.append(f"{100 * share.get(axis, 0.0):.0f} %")
        rows.append(row)
    return Table("Force and moment that the vessel as written lacks", header, rows)


def _interval_table(intervals: Sequence[IntervalEntry]) -> Table:
    """Return the folded table of the longest flagged intervals, in the order of the answer."""
    longest = sorted(intervals, key=lambda i: i["from_s"] - i["to_s"])[:MOST_INTERVALS]
    rows = []
    for i in intervals:
        if i in longest:
            rows.append([i["run"], i["axis"], f"{i['from_s']:.1f}", f"{i['to_s']:.1f}"])
    title = f"The {len(rows)} longest of {len(intervals)} flagged intervals"
    if len(intervals) == 1:
        title = "The flagged interval"
    elif len(intervals) == len(rows):
        title = f"All {len(rows)} flagged intervals"
    header = ["recording", "axis", "from [s]", "to [s]"]
    return Table(title, header, rows, (1,), folded=True)


def _flagged_shares(f: Findings) -> dict[str, float]:
    """Return the share of the time of all recordings that is flagged, by axis."""
    seconds = sum(float(m.t[-1] - m.t[0]) for m in f.missing)
    flagged: dict[str, float] = {}
    if not seconds:
        return flagged
    for i in f.answer["where"]["intervals"]:
        flagged[i["axis"]] = flagged.get(i["axis"], 0.0) + (i["to_s"] - i["from_s"]) / seconds
    return flagged


def _missing_figures(f: Findings) -> Iterator[Block]:
    """Yield the missing force over time of the recordings that are flagged longest."""
    intervals, left = f.answer["where"]["intervals"], _left_over_words(f)
    flagged = {m.run: 0.0 for m in f.missing}
    for interval in intervals:
        if interval["run"] in flagged:
            flagged[interval["run"]] += interval["to_s"] - interval["from_s"]
    order = sorted(range(len(f.missing)), key=lambda i: -flagged[f.missing[i].run])
    drawn: list[MissingForceCurve] = []
    for i in sorted(order[:MOST_MISSING_FIGURES]):
        drawn.append(f.missing[i])
        if not left:
            drawn[-1] = replace(f.missing[i], left={})
    looks = {
        "missing": "force that the vessel as written lacks",
        "left": left,
        "band": "band of 2 standard deviations",
        "flag": "flagged: the band does not contain zero",
    }
    if not any(m.left for m in drawn):
        del looks["left"]
    yield Figures(
        svg_plots.legend(looks), figures.missing_force_figures(drawn, intervals, f.missing)
    )
    if len(drawn) < len(f.missing):
        yield Text(
            f"The figures show the {len(drawn)} of {len(f.missing)} recordings that are flagged "
            "longest."
        )
