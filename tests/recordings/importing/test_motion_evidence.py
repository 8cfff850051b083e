"""Units and positions by what the signals of a log show together."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from turning_ship import winding_ship

from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map

SHIP = winding_ship(0)
DEG = 180.0 / np.pi


def log_of(**columns: np.ndarray) -> Log:
    signals = {name: Signal(SHIP.t, values) for name, values in columns.items()}
    return Log(Path("ship.csv"), signals)


def lines(log: Log) -> dict[str, str]:
    found = {}
    for line in propose_map(log).splitlines():
        name, equals, value = line.removeprefix("# ").partition(" = ")
        if equals:
            found[name] = value.partition('"  #')[0].strip('"')
    return found


def test_north_and_east_move_as_the_ship_and_are_no_revolutions() -> None:
    found = lines(log_of(N=SHIP["x_m"], E=SHIP["y_m"], psi=SHIP["psi_rad"], u=SHIP["u_mps"]))
    assert found["x_m"] == "N" and found["y_m"] == "E" and "throttle" not in found


def test_north_and_east_without_a_speed_move_where_the_heading_points() -> None:
    found = lines(log_of(N=SHIP["x_m"], E=SHIP["y_m"], psi=SHIP["psi_rad"]))
    assert found["x_m"] == "N" and found["y_m"] == "E"


def test_a_signal_called_n_without_such_a_motion_stays_a_command() -> None:
    rng = np.random.default_rng(0)
    n, e = 100.0 + rng.standard_normal((2, len(SHIP.t)))
    found = lines(log_of(N=n, E=e, psi=SHIP["psi_rad"], u=SHIP["u_mps"]))
    assert "x_m" not in found and found["throttle"] == "N"


@pytest.mark.parametrize("small", [1.0, 0.02])
def test_a_yaw_rate_has_the_unit_in_which_it_turns_the_heading(small: float) -> None:
    """A rate of 0.5 may be in degrees or radians; the range alone does not tell."""
    psi = 1.0 + small * (SHIP["psi_rad"] - 1.0)
    r = small * SHIP["r_radps"]
    assert lines(log_of(psi=psi * DEG, r=r * DEG))["r_radps"] == "r * degps"
    assert lines(log_of(psi=psi * DEG, r=r))["r_radps"] == "r"


def test_angles_without_a_unit_have_that_of_the_heading_to_be_checked() -> None:
    roll = 2.0 * np.sin(0.3 * SHIP.t)  # [deg]
    helm = 1.0 * np.sin(0.1 * SHIP.t)  # [deg]
    degrees = log_of(psi=SHIP["psi_rad"] * DEG, phi=roll, rudder=helm)
    found = lines(degrees)
    assert found["phi_rad"] == "phi * deg" and found["steer_rad"] == "rudder * deg"
    radians = lines(log_of(psi=SHIP["psi_rad"], phi=roll / DEG, rudder=helm / DEG))
    assert radians["phi_rad"] == "phi" and radians["steer"] == "rudder"
    stated = dict(degrees.signals)
    stated["phi"] = replace(stated["phi"], unit="rad")
    assert lines(replace(degrees, signals=stated))["phi_rad"] == "phi"
