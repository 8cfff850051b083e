"""Recordings that show little: a diagnosis of them names what is there or nothing, and never
invents a cause."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alike import few, long
from real_boat import Real, recorded

from boatsim.diagnosis import pipeline
from boatsim.recordings.table import Notes, Recording, write_csv

NOISE = (0.003, 0.003, 0.012)  # [m, m, rad] of camera and compass
COMMANDS = ("thrust_port_N", "thrust_starboard_N", "steer_port_rad", "steer_starboard_rad")


def short(real: Real, seed: int, seconds: float) -> Recording:
    """The first seconds of random steps."""
    return recorded(real, seed).between(0.0, seconds)


def still(seed: int, seconds: float = 40.0) -> Recording:
    """A boat at rest with its motors off: noise alone."""
    return steady(seed, seconds, 0.0)


def steady(seed: int, seconds: float, thrust: float) -> Recording:
    """A boat at its steady speed straight ahead: both thrusts balance the surge damping of 3 N
    s/m."""
    rng, t = np.random.default_rng(seed), np.arange(0.0, seconds, 1 / 6)
    place = (
        np.column_stack([2.0 * thrust / 3.0 * t, 0.0 * t, 0.0 * t])
        + rng.standard_normal((len(t), 3)) * NOISE
    )
    held = np.tile([thrust, thrust, 0.0, 0.0], (len(t), 1))
    signals = dict(zip(("x_m", "y_m", "psi_rad"), place.T, strict=True)) | dict(
        zip(COMMANDS, held.T, strict=True)
    )
    return Recording(f"{seed}", t, signals, Notes(vessel="trial_boat"))


def answer(recording: Recording, folder: Path) -> dict[str, Any]:
    """Answer of a diagnosis of one run."""
    write_csv(replace(recording, notes=Notes()), folder / "run.csv")
    return pipeline.diagnose([folder / "run.csv"], vessel="trial_boat").findings.answer


def named(found: dict[str, Any]) -> set[str]:
    return {e["name"] for e in found["effects"]}


NOTHING_TO_SEE = {
    "6 s of random steps": lambda: short(Real(), 1, 6.0),
    "12 s of random steps": lambda: short(Real(), 2, 12.0),
    "at rest": lambda: still(3),
    "6 s at rest": lambda: still(4, 6.0),
    "straight ahead": lambda: steady(5, 40.0, 0.4),
    "straight ahead for 12 s": lambda: steady(6, 12.0, 0.8),
}


@pytest.mark.slow
@pytest.mark.long
def test_still_water_is_no_evidence_of_more_damping(tmp_path: Path) -> None:
    """An Otter that lies still in water far calmer than is tolerated; instruments of 6 mm and 4
    mrad alone."""
    files = []
    for seed in (1, 2):
        rng, t = np.random.default_rng(seed), np.arange(0.0, 40.0, 0.15)
        place = rng.standard_normal((6, len(t))) * np.array(
            [[0.006], [0.006], [0.006], [0.004], [0.004], [0.004]]
        )
        columns = ("x_m", "y_m", "z_m", "phi_rad", "theta_rad", "psi_rad")
        signals = dict(zip(columns, place, strict=True))
        signals |= {
            n: rng.uniform(-0.4, 0.4, len(t)) for n in ("n_port_radps", "n_starboard_radps")
        }  # next to no thrust
        files.append(tmp_path / f"{seed}.csv")
        write_csv(Recording(str(seed), t, signals, Notes()), files[-1])
    found = pipeline.diagnose(files[:1], files[1:], "otter").findings.answer
    assert found["verdict"] == "nothing_missing" and not named(found), found["sentence"]


@pytest.mark.parametrize("case", few(NOTHING_TO_SEE))
def test_nothing_is_named_where_nothing_is_missing(case: str, tmp_path: Path) -> None:
    found = answer(NOTHING_TO_SEE[case](), tmp_path)
    assert found["verdict"] == "nothing_missing" and not named(found)
    assert found["upper_limits"]  # what such data cannot exclude


def test_a_run_at_rest_excludes_outer_forces_alone(tmp_path: Path) -> None:
    """No upper limit is claimed for what shows only in motion or under commands."""
    limits = answer(still(3), tmp_path)["upper_limits"]
    outer = {"wind", "current", "tether", "steady_force", "wave_forcing"}
    assert {name for name, limit in limits.items() if limit} <= outer | {
        "damping_exponent"
    }  # without any at rest
    assert limits["wind"]["force_N"] < 0.1


EFFECTS = {
    "late commands": (Real(late=0.5), {"command_delay", "clock_offset", "thrust_lag"}),
    "cargo": (Real(cargo=(2.0, 0.3)), {"extra_mass"}),
    "a short line": (Real(line=(2.0, 0.3, 0.5, 0.5)), {"tether"}),
    "play": (Real(play=0.35), {"steering_backlash"}),
    "stretched picture": (Real(scale=(1.2, 0.85)), {"camera_scale"}),
    "waves": (Real(sea=(0.2, 0.3, 0.1)), {"wave_forcing"}),
}


@pytest.mark.parametrize("seconds", [6.0, long(12.0)])
@pytest.mark.parametrize("case", few(EFFECTS, 0, 2))
def test_a_short_run_names_what_is_there_or_nothing(
    case: str, seconds: float, tmp_path: Path
) -> None:
    real, right = EFFECTS[case]
    found = answer(short(real, 7, seconds), tmp_path)
    for effect in found["effects"]:
        assert {effect["name"], *effect["tied_with"]} & right, found["sentence"]
