"""A diagnosis in a notebook: its parameters as a table, its curves, and its summary with a replay.

The models have the names that a person reads: the vessel before, retuned and corrected. Files and
the keys of diagnosis.json keep `nominal`, `recalibrated` and `patched`.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.findings import Findings
from boatsim.diagnosis.answer.schema import Answer
from boatsim.diagnosis.free_runs import FreeRun
from boatsim.diagnosis.model_names import MODEL_WORDS
from boatsim.diagnosis.report.figures import group_by_recording, model_error, unit_for_signal
from boatsim.errors import BadInput
from boatsim.physics.base import Array
from boatsim.recordings.notebook.arrow import UNIT
from boatsim.recordings.notebook.figures import TRACK, Curve, Panel, draw_figure
from boatsim.recordings.notebook.html_table import html_facts_table, html_table
from boatsim.recordings.notebook.labels import column_in_words
from boatsim.recordings.notebook.replay import replay_frame, track_of
from boatsim.view.formatting import format_parameter, format_quantity, name_in_words

if TYPE_CHECKING:
    import pyarrow as pa
    from matplotlib.figure import Figure

# model -> name, and colours of the light report, distinguishable for colour-blind readers
SHOWN = {
    "recorded": (MODEL_WORDS["recorded"], "#9aa5ae"),
    "nominal": (MODEL_WORDS["nominal"], "#c65102"),
    "recalibrated": (MODEL_WORDS["recalibrated"], "#0067b1"),
    "patched": (MODEL_WORDS["patched"], "#00815c"),
}


def parameter_table(answer: Answer) -> "pa.Table":
    """Return the parameters of the identified effects as a table of Arrow, one row for each.

    Values are in the unit of their row. The metadata has verdict and sentence of the diagnosis.

    Args:
        answer: Content of diagnosis.json.
    """
    import pyarrow as pa  # 60 ms, comes with rerun-sdk

    rows = []
    for effect in answer["effects"]:
        for name, entry in effect["parameters"].items():
            row: dict[str, object] = {**entry, "effect": effect["name"], "parameter": name}
            row["probability"] = effect["probability"]
            row["log_bayes_factor_nats"] = effect["gain_nats"]
            row["confirmed"] = effect.get("confirmed")
            row["at_bound"] = entry.get("at_bound", False)
            rows.append(row)
    nats = {UNIT: b"nats"}
    schema = pa.schema(
        [
            ("effect", pa.string()),
            ("parameter", pa.string()),
            ("value", pa.float64()),
            ("sd", pa.float64()),
            ("unit", pa.string()),
            ("at_bound", pa.bool_()),
            ("probability", pa.float64()),
            pa.field("log_bayes_factor_nats", pa.float64(), metadata=nats),
            ("confirmed", pa.bool_()),
        ],
        metadata={"verdict": answer["verdict"], "sentence": answer["sentence"]},
    )
    return pa.Table.from_pylist(rows, schema=schema)


def diagnosis_figure(f: Findings) -> "Figure":
    """Draw the first held-out recording with its simulations: from above, and over time.

    Every stretch of a simulation starts at the recorded state and receives the recorded commands
    alone.

    Args:
        f: Findings of the diagnosis.

    Raises:
        BadInput: If no recording was held out, or matplotlib is not installed.
    """
    if not f.free_runs:
        raise BadInput("this diagnosis has no simulations of held-out recordings to plot")
    runs = group_by_recording(f.free_runs)[0]
    recorded = runs[0].channels["recorded"]
    track, panels = [], []
    if set(TRACK) <= recorded.keys():
        for model in _models(runs):
            track.append(_curve(runs, model, _joined(runs, model, "y_m"), "x_m"))
        panels.append(_distance_panel(runs))
    for signal in recorded:
        if signal not in TRACK:
            panels.append(_signal_panel(runs, signal))
    return draw_figure(f"{f.vessel}, held out: {runs[0].run}", track, panels)


def diagnosis_html(f: Findings) -> str:
    """Return the summary of a diagnosis for a notebook, with a replay of a held-out recording.

    Args:
        f: Findings of the diagnosis.
    """
    parts = [_replay(f)] if f.free_runs else []
    facts = [("verdict", name_in_words(f.answer["verdict"])), ("vessel", f.vessel)]
    facts += [("fitted", ", ".join(f.runs)), ("held out", ", ".join(f.held_out))]
    parts.append(html_facts_table(f.answer["sentence"], facts))
    rows = []
    for effect in f.answer["effects"]:
        for name, entry in effect["parameters"].items():
            words, value = format_parameter(name, entry["value"], entry["unit"], entry["sd"])
            rows.append([name_in_words(effect["name"]), words, value])
    parts.append(html_table(["identified effect", "parameter", "value"], rows))
    parts.append(html_table(["error on held-out data (rms)", *_names()], _error_rows(f.answer)))
    return "".join(parts)


def _names() -> list[str]:
    """Names of the models that a person reads."""
    return [SHOWN[model][0] for model in SHOWN if model != "recorded"]


def _error_rows(answer: Answer) -> list[list[str]]:
    """Rms errors of the models on held-out data, by family of signals."""
    rows = []
    for family, (words, unit) in FAMILIES.items():
        errors = answer["fit"].get(family)
        if errors is None:
            continue
        cells = [words]
        for model in SHOWN:
            if model in errors:
                cells.append(format_quantity(errors[model], unit))
        rows.append(cells)
    return rows


def _models(runs: Sequence[FreeRun]) -> list[str]:
    return [model for model in SHOWN if model in runs[0].channels]


def _joined(runs: Sequence[FreeRun], model: str, signal: str) -> Array:
    """A signal of consecutive free runs, with nan between them, at which curves break."""
    return _with_breaks([run.channels[model][signal] for run in runs])


def _with_breaks(parts: Sequence[Array]) -> Array:
    pieces = []
    for part in parts:
        pieces += [part, np.full(1, np.nan)]
    return np.concatenate(pieces)


def _curve(
    runs: Sequence[FreeRun], model: str, x: Array, signal: str, factor: float = 1.0
) -> Curve:
    """A signal of a model over `x`; the vessel before the diagnosis may leave the axes."""
    name, colour = SHOWN[model]
    width = 1.5
    if model == "recorded":
        width = 3.0
    y = factor * _joined(runs, model, signal)
    return Curve(name, x, y, colour, width, fitted_in=model != "nominal")


def _signal_panel(runs: Sequence[FreeRun], signal: str) -> Panel:
    unit, factor = unit_for_signal(signal, runs)
    t = _with_breaks([run.t for run in runs])
    curves = []
    for model in _models(runs):
        curves.append(_curve(runs, model, t, signal, factor))
    return Panel(f"{column_in_words(signal)} [{unit.replace('°', 'deg')}]", tuple(curves))


def _distance_panel(runs: Sequence[FreeRun]) -> Panel:
    """The distance of each simulation from the recorded position."""
    t = _with_breaks([run.t for run in runs])
    curves = []
    for model in _models(runs)[1:]:
        name, colour = SHOWN[model]
        distance = _with_breaks([model_error(run, model, "position") for run in runs])
        curves.append(Curve(name, t, distance, colour, fitted_in=model != "nominal"))
    return Panel("position error [m]", tuple(curves))


def _replay(f: Findings) -> str:
    """The replay of the first held-out recording; "" without positions."""
    runs = group_by_recording(f.free_runs)[0]
    t = np.concatenate([run.t for run in runs])
    tracks = []
    for model in _models(runs):
        name, colour = SHOWN[model]
        signals = {}
        for signal in runs[0].channels[model]:
            signals[signal] = np.concatenate([run.channels[model][signal] for run in runs])
        track = track_of(name, colour, t, signals)
        if track is not None:
            tracks.append(track)
    if not tracks:
        return ""
    return replay_frame(f"Held-out recording {runs[0].run}: recorded and simulated", tracks)
