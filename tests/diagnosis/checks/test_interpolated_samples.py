"""Values between the samples of slow sensors are found by their straight lines."""

from dataclasses import replace

import numpy as np
import pytest
from turning_ship import winding_ship

from boatsim.diagnosis.checks.data_cleaning import cleaning_findings
from boatsim.diagnosis.checks.interpolated_samples import drop_interpolated_samples
from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

COLUMNS = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")


def resampled(ship: Recording, stamps: Array) -> Recording:
    """A log on a common clock, interpolated between samples of the ship at other times."""
    signals = {}
    for name in COLUMNS:
        signals[name] = np.interp(ship.t, stamps, np.interp(stamps, ship.t, ship[name]))
    return replace(ship, signals=signals)


@pytest.mark.parametrize("decimals", [None, 4])
def test_only_one_row_for_each_sample_is_used(decimals: int | None) -> None:
    ship = winding_ship(0)
    rng = np.random.default_rng(0)
    stamps = np.cumsum(rng.uniform(1.0, 3.0, 500)) - 3.0  # [s] four rows on average
    log = resampled(ship, stamps[stamps < ship.t[-1] + 3.0])
    if decimals is not None:
        log = replace(log, signals={n: np.round(x, decimals) for n, x in log.signals.items()})
    found = drop_interpolated_samples(log)
    samples = int(((stamps > 0.0) & (stamps < ship.t[-1])).sum())
    for name in ("x_m", "y_m", "psi_rad", "u_mps"):
        used = int(np.isfinite(found[name]).sum())
        assert 0.8 * samples < used < 1.2 * samples
    [finding] = cleaning_findings(found)
    assert finding.name == "interpolated" and "x_m, y_m in" in finding.evidence


@pytest.mark.parametrize("decimals", [None, 3, 2, 1])
def test_measured_rows_are_all_used(decimals: int | None) -> None:
    for noise in (0.0, 0.1, 1.0):
        ship = winding_ship(1, noise=noise)
        if decimals is not None:
            coarse = {name: np.round(x, decimals) for name, x in ship.signals.items()}
            ship = replace(ship, signals=coarse)
        assert drop_interpolated_samples(ship) is ship


def test_a_steady_turn_without_noise_is_measured() -> None:
    ship = winding_ship(2, noise=0.0)
    psi = np.where(ship.t > 200.0, ship["psi_rad"], ship["psi_rad"][400] + 0.05 * (ship.t - 200.0))
    assert drop_interpolated_samples(replace(ship, signals=ship.signals | {"psi_rad": psi}))[
        "psi_rad"
    ] == pytest.approx(psi)
