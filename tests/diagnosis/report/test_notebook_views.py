"""A diagnosis in a notebook: its parameters as a table, and recorded and simulated curves by the
names that a person reads."""

from dataclasses import replace

import numpy as np
import pyarrow as pa
import pytest

from boatsim.api import Diagnosis
from boatsim.diagnosis.report.notebook_views import (
    diagnosis_figure,
    diagnosis_html,
    parameter_table,
)
from boatsim.errors import BadInput
from tests.diagnosis.report.test_page import nothing, planar, rolling

NAMES = ["recorded", "before", "retuned", "corrected"]


class Result:
    """The part of the pipeline's result that views use."""

    def __init__(self, findings):
        self.findings = findings


def test_every_parameter_of_an_identified_effect_is_a_row_with_its_unit():
    f = planar()
    table = pa.table(Diagnosis(Result(f)))
    rows = table.to_pylist()
    expected = []
    for effect in f.answer["effects"]:
        for name, entry in effect["parameters"].items():
            expected.append((effect["name"], name, entry["value"], entry["sd"], entry["unit"]))
    assert expected
    keys = ("effect", "parameter", "value", "sd", "unit")
    assert [tuple(row[key] for key in keys) for row in rows] == expected
    assert table.schema.metadata[b"verdict"] == f.answer["verdict"].encode()


def test_a_diagnosis_that_identified_nothing_is_an_empty_table_with_the_same_columns():
    table = parameter_table(nothing().answer)
    assert table.num_rows == 0 and table.schema.equals(parameter_table(planar().answer).schema)


def test_the_figure_compares_the_recording_with_the_vessel_before_retuned_and_corrected():
    f = planar()
    track, *panels = diagnosis_figure(f).axes
    assert [line.get_label() for line in track.lines] == NAMES
    run = f.free_runs[0]
    corrected = track.lines[-1]
    rows = slice(0, len(run.t))
    np.testing.assert_array_equal(corrected.get_xdata()[rows], run.channels["patched"]["y_m"])
    np.testing.assert_array_equal(corrected.get_ydata()[rows], run.channels["patched"]["x_m"])
    (heading,) = [axes for axes in panels if axes.get_ylabel() == "heading psi [deg]"]
    recorded = heading.lines[0].get_ydata()[rows]
    np.testing.assert_allclose(recorded, np.degrees(run.channels["recorded"]["psi_rad"]))


def test_consecutive_simulations_are_not_connected():
    f = planar()
    runs = [run for run in f.free_runs if run.run == f.free_runs[0].run]
    assert len(runs) > 1
    track = diagnosis_figure(f).axes[0]
    assert np.isnan(track.lines[-1].get_xdata()).sum() == len(runs)


def test_a_boat_that_only_rolls_is_drawn_over_time_and_has_no_replay():
    axes = diagnosis_figure(rolling()).axes
    assert [a.get_ylabel() for a in axes] == ["roll phi [deg]"]
    assert "<iframe" not in diagnosis_html(rolling())


def test_a_notebook_shows_the_sentence_the_replay_and_the_errors_by_name():
    f = planar()
    shown = diagnosis_html(f)
    assert shown.count("<iframe") == 1
    for name in NAMES[1:]:
        assert f">{name}</th>" in shown
    for key in ("nominal", "recalibrated", "patched"):
        assert key not in shown


def test_the_sentence_of_a_diagnosis_can_not_become_markup():
    f = planar()
    f = replace(f, answer={**f.answer, "sentence": "<img src=x onerror=alert(1)>"})
    assert "<img" not in diagnosis_html(f)


def test_without_held_out_simulations_there_is_a_summary_and_no_figure():
    f = replace(planar(), free_runs=())
    assert "<iframe" not in diagnosis_html(f)
    with pytest.raises(BadInput, match="no simulations of held-out recordings"):
        diagnosis_figure(f)
