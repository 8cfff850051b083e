"""Corrections that checks offer are written into the tables of their run, whatever their headers."""

import tomllib

import pytest

from validation.real.corrections import tables_of_run

CLOCK, GAIN, LATE = 'clock = "motion"', 'u_mps = "u_mps * 1.02"', "psi_rad = 0.5"


@pytest.mark.parametrize("run", ["run_1", "run 1"])
@pytest.mark.parametrize("of_run", [False, True])
def test_lines_for_all_runs_or_for_one_are_written_for_this_one(run: str, of_run: bool) -> None:
    key = run if " " not in run else f'"{run}"'
    inner = f"runs.{key}." if of_run else ""
    own = [f"[runs.{key}]"] if of_run else []
    lines = [*own, CLOCK, f"[{inner}columns]", GAIN, f"[{inner}latency]", LATE]
    tables = tomllib.loads("\n".join(tables_of_run(run, lines)))
    corrected = {"u_mps": "u_mps * 1.02"}
    assert tables["runs"][run] == {
        "clock": "motion",
        "columns": corrected,
        "latency": {"psi_rad": 0.5},
    }
