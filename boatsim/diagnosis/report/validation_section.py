"""Section of a report on the errors of free runs over held-out recordings."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS, MODELS, model_names_in_words
from boatsim.diagnosis.report import figures
from boatsim.diagnosis.report.confirmation import recalibration_sentences
from boatsim.view import svg_plots
from boatsim.view.formatting import (
    format_in_one_unit,
    format_number,
    join_words,
)
from boatsim.view.page_blocks import (
    Block,
    Figures,
    Table,
    Text,
)

MOST_HELD_OUT_FIGURES = 3  # held-out recordings that are drawn
FREE_RUN_SIGNALS = {
    "position": "position",
    "heading": "psi_rad",
    "roll": "phi_rad",
    "heave": "z_m",
}


def validation_section(f: Findings) -> Iterator[Block]:
    """Yield the errors of free runs over held-out recordings, and their figures.

    Args:
        f: Findings of a diagnosis.
    """
    fit = f.answer["fit"]
    models: tuple[str, ...] = MODELS[:2]
    header = model_names_in_words(models)
    if f.has_added_effects:
        models, header = MODELS, [*model_names_in_words(MODELS), "error reduced by factor"]
    rows = []
    for key, (words, unit) in FAMILIES.items():
        if rms := fit.get(key):
            rows.append(_error_row(words, rms, unit)[: len(header) + 1])
    if rows:
        caption = (
            f"rms error of free runs of {fit['horizon_s']:g} s over {join_words(fit['held_out'])}"
        )
        yield Table(caption, ["error in", *header], rows)
    if sentences := recalibration_sentences(f):
        yield Text(" ".join(sentences))
    by_run = figures.group_by_recording(f.free_runs)
    if len(by_run) > 1:
        rows = []
        for runs in by_run:
            for row in _errors_of_run(runs):
                rows.append(row[: len(header) + 1])
        yield Table("Each recording by itself", ["recording", *header], rows, folded=True)
    drawn = []
    for runs in by_run[:MOST_HELD_OUT_FIGURES]:
        drawn += figures.free_run_figures(_select_models(runs, models))
    if by_run:
        names = _select_models(by_run[0], models)[0].channels
        yield Figures(svg_plots.legend({name: MODEL_WORDS[name] for name in names}), drawn)
    if len(by_run) > MOST_HELD_OUT_FIGURES:
        yield Text(
            f"The figures show the first {MOST_HELD_OUT_FIGURES} of {len(by_run)} held-out "
            "recordings."
        )
    for title, names_of_columns, cells in f.extra_tables:
        yield Table(title, names_of_columns, cells, _text_columns(cells), folded=True)


def _select_models(runs: Sequence[FreeRun], models: Sequence[str]) -> list[FreeRun]:
    """Return free runs with the channels of the recording and of these models."""
    kept = []
    for run in runs:
        channels = {m: c for m, c in run.channels.items() if m in ("recorded", *models)}
        kept.append(replace(run, channels=channels))
    return kept


def _text_columns(rows: Sequence[Sequence[str]]) -> tuple[int, ...]:
    """Return the columns, after the first, that have any cell of words without a digit."""
    columns = set()
    for row in rows:
        for i, cell in enumerate(row[1:], 1):
            if cell and not any(map(str.isdigit, cell)):
                columns.add(i)
    return tuple(sorted(columns))


def _error_row(words: str, rms: dict[str, float], unit: str) -> list[str]:
    """Return a row of the rms errors of the three models and the improvement by the last."""
    errors = format_in_one_unit([rms["nominal"], rms["recalibrated"], rms["patched"]], unit)
    factor = format_number(rms["recalibrated"] / max(rms["patched"], 1e-300))
    return [words, *errors, factor]


def _errors_of_run(runs: Sequence[FreeRun]) -> list[list[str]]:
    """Return the rms errors of the free runs over one recording, a row for each signal."""
    rows = []
    for words, unit in FAMILIES.values():
        signal = FREE_RUN_SIGNALS[words]
        needed = {"x_m", "y_m"} if signal == "position" else {signal}
        if not needed <= runs[0].channels["recorded"].keys():
            continue
        rms = {}
        for model in MODELS:
            errors = np.concatenate([figures.model_error(r, model, signal) for r in runs])
            # the rms of a position is that of its coordinates, of which there are two
            rms[model] = math.sqrt(float(np.nanmean(errors**2)) / len(needed))
        rows.append(_error_row(f"{runs[0].run}, {words}", rms, unit))
    return rows
