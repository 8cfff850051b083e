"""One drive of several depends on the voltage of its own supply, and the others do not.

The thrusts are made in this file, and the vessel that is sailed knows no voltage."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from answers import diagnosed, named, nothing_missing
from driven_boats import PER_ROW, driven, platform_of_three_drives, random_orders

from boatsim.diagnosis.candidates import candidate_library
from boatsim.physics.base import Array
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.table import Recording

DRIVES = ("bow", "port", "starboard")
NOMINAL = 24.0  # [V]
VOLTAGES = {f"battery_{drive}_V": {"neutral": NOMINAL} for drive in DRIVES}
CHARGES = ((1.05, 0.97), (0.92, 0.84), (0.80, 0.72))  # at begin and end of each run
HOLDS, ROWS = 30, 10  # orders of a run, rows of each


def sailed(run: int, powers: Array) -> Recording:
    """A run with voltages that fall, of which the thrusts (3,) depend with these powers."""
    rng = np.random.default_rng(run)
    orders = random_orders(rng, (8.0, 8.0, 8.0), HOLDS, ROWS)
    charge = np.linspace(*CHARGES[run], len(orders))[:, None]
    sag = 0.01 * abs(orders)  # by the own load of each drive
    volts = NOMINAL * (charge - sag)
    factors = np.repeat((volts / NOMINAL) ** powers, PER_ROW, axis=0)
    columns = {f"{drive}_N": orders[:, k] for k, drive in enumerate(DRIVES)}
    plain = driven(platform_of_three_drives(), columns, lambda x: x * factors, run)
    measured = dict(zip(VOLTAGES, volts.T, strict=True))
    return Recording(plain.name, plain.t, {**plain.signals, **measured}, plain.notes)


def answer(folder: Path, *powers: float) -> dict[str, Any]:
    """The answer for three runs; the last one, with the lowest voltages, is held out."""
    saved = platform_of_three_drives(VOLTAGES).save(folder / "platform").file
    return diagnosed([sailed(run, np.array(powers)) for run in range(3)], folder, str(saved))


@pytest.mark.slow
def test_a_drive_that_alone_depends_on_its_voltage_is_named(tmp_path: Path) -> None:
    found = answer(tmp_path, 0.0, 2.0, 0.0)
    named(found, "drive_loss_with_voltage_port_N", {"exponent": 2.0})


@pytest.mark.long
@pytest.mark.slow
def test_drives_that_depend_on_their_voltages_alike_have_one_cause(tmp_path: Path) -> None:
    named(answer(tmp_path, 2.0, 2.0, 2.0), "thrust_with_voltage", {"exponent": 2.0})


@pytest.mark.long
@pytest.mark.slow
def test_controlled_drives_have_nothing_missing(tmp_path: Path) -> None:
    nothing_missing(answer(tmp_path, 0.0, 0.0, 0.0))


def test_each_drive_is_a_candidate_with_its_own_voltage() -> None:
    requested = ("drive_loss_with_voltage",)
    library = candidate_library(platform_of_three_drives(VOLTAGES), requested)
    fed = {}
    for effect in library.entries:
        if effect.name.startswith("drive_loss_with_voltage"):
            fed[effect.on] = effect.fed_by  # type: ignore[attr-defined]
    assert fed == {(f"{drive}_N",): (f"battery_{drive}_V",) for drive in DRIVES}
    columns = ["battery_bow_V"]
    bow = candidate_library(platform_of_three_drives(VOLTAGES), requested, columns=columns)
    assert "drive_loss_with_voltage_bow_N" in bow.tested_names
    assert "no column battery_port_V" in bow.excluded["drive_loss_with_voltage_port_N"]


def test_it_is_no_candidate_without_a_voltage_or_without_several_drives() -> None:
    without = candidate_library(platform_of_three_drives())
    assert "measured quantity in V" in without.inapplicable["drive_loss_with_voltage"]
    one = candidate_library(load_vessel("mariner"))
    assert "fewer than 2" in one.inapplicable["drive_loss_with_voltage"]
