"""Entries of the library that a rolling hull shows, found with their values in decays integrated by
scipy."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from alike import long
from answers import diagnosed, named, nothing_missing
from scipy.integrate import solve_ivp

from boatsim.physics.base import Array
from boatsim.recordings.table import Recording

USUAL = 0.4  # [rad/s] at which the moments below are in the words of the simple laws
INERTIA, DAMPING, RIGHTING = (
    135.4,
    6.7,
    822.3,
)  # [kg m^2], [N m s], [N m] of the 4.7 m tanker, water included


@dataclass(frozen=True)
class Hull:
    """What the tanker really has, in the words of this file."""

    square: float = 0.0  # [N m s^2] of moment per roll rate squared
    cube: float = 0.0  # [N m s^3] of moment per roll rate cubed
    stiffening: float = 0.0  # [1/rad^2] of the righting moment
    height: float = 1.0  # of the metacentre, per stated one
    dry: float = 0.0  # [N m] of friction that is the same at any rate
    lopsided: float = 0.0  # [N m/rad^2] more of righting moment to one side, less to the other
    heeling: float = 0.0  # [N m] of a weight off the centreline


def slopes(t: float, y: Array, hull: Hull) -> list[float]:
    """Newton's law of a hull that rolls about a fixed axis; powers are not whole, and a curve of
    levers bends back."""
    phi, p = y
    part = abs(p) / USUAL
    righting = (
        RIGHTING * (hull.height * phi + hull.stiffening * phi**3 * (1.1 - 1.5 * phi**2))
        + hull.lopsided * phi**2
    )
    resisting = (DAMPING + hull.square * USUAL * part**0.85 + hull.cube * USUAL**2 * part**1.8) * p
    return [p, -(righting + resisting + hull.dry * np.tanh(p / 0.005) - hull.heeling) / INERTIA]


def released(hull: Hull, seed: int) -> Recording:
    """60 s at 5 Hz from rest at a heel of 18, 13 or 8 deg, seen by motion tracking with noise."""
    t, heel = np.arange(0.0, 60.0, 0.2), np.radians(23.0 - 5.0 * seed)
    phi = solve_ivp(
        slopes, (0.0, 60.0), [heel, 0.0], t_eval=t, args=(hull,), rtol=1e-9, atol=1e-12
    ).y[0]
    noise = 1e-4 * np.random.default_rng(seed).standard_normal(len(t))
    return Recording(f"{seed}", t, {"phi_rad": phi + noise})


CASES = {
    "quadratic_damping": (Hull(square=15.0), {"roll_Nms2": 15.0}),
    "righting_arm_stiffening": (Hull(stiffening=-1.5), {"cubic_perrad2": -1.5}),
    "metacentric_height_error": (Hull(height=0.5), {"factor": 0.5}),
}


@pytest.mark.parametrize("entry", CASES)
def test_an_entry_is_named_with_its_values(tmp_path: Path, entry: str) -> None:
    hull, true = CASES[entry]
    named(diagnosed(decays(hull), tmp_path, "kvlcc2_roll"), entry, true)


def test_a_power_between_two_and_three_is_said_once(tmp_path: Path) -> None:
    """Power 2.8 in decays that are seen to a tenth of a milliradian: one law, whose nearest entry
    carries over."""
    answer = diagnosed(decays(Hull(cube=40.0)), tmp_path, "kvlcc2_roll", horizon=60.0)
    found = {
        e["name"]: {k: p["value"] for k, p in e["parameters"].items()} for e in answer["effects"]
    }
    assert answer["verdict"] == "named" and set(found) == {"cubic_damping"}
    assert found["cubic_damping"]["roll_Nms3"] == pytest.approx(40.0, rel=0.1)
    rms = answer["fit"]["roll_rms_rad"]
    assert rms["patched"] < 0.05 * rms["recalibrated"]


def test_a_linear_hull_of_the_stated_height_misses_nothing(tmp_path: Path) -> None:
    nothing_missing(diagnosed(decays(Hull()), tmp_path, "kvlcc2_roll"))


@pytest.mark.slow
def test_dry_friction_is_not_taken_for_waves(tmp_path: Path) -> None:
    """It goes to and fro with the hull, at her own rhythm, but always against her: no entry does,
    and waves do not."""
    answer = diagnosed(decays(Hull(dry=4.0)), tmp_path, "kvlcc2_roll")
    assert "wave_forcing" not in [e["name"] for e in answer["effects"]]
    assert answer["verdict"] == "described", answer["sentence"]
    (law,) = answer["described"]
    assert law["axis"] == "roll" and law["carries_over"] and len(law["terms"]) == 1
    (term,) = law["terms"]
    assert term["of"] == "the sign of roll rate" and term["unit"] == "N m"
    assert term["value"] == pytest.approx(-4.0, rel=0.1)
    rms = answer["fit"]["roll_rms_rad"]
    assert rms["patched"] < 0.5 * rms["recalibrated"]


@pytest.mark.slow
def test_a_hull_that_rights_herself_better_from_one_side_is_told_by_the_square_of_heel(
    tmp_path: Path,
) -> None:
    """No entry is even in heel, and a moment that is so stays far below the tolerated one."""
    answer = diagnosed(decays(Hull(lopsided=20.0)), tmp_path, "kvlcc2_roll")
    assert not answer["effects"] and answer["verdict"] == "described", answer["sentence"]
    assert answer["unknown"]["structure"]["goes_with"] == "the roll angle squared"
    ((term,),) = (law["terms"] for law in answer["described"])
    assert term["of"] == "roll angle squared" and term["value"] == pytest.approx(-20.0, rel=0.1)


@pytest.mark.parametrize("askew", [-0.06, long(0.06)])
def test_an_inclinometer_askew_is_no_moment_and_hides_no_law(tmp_path: Path, askew: float) -> None:
    """The righting moment bends about upright, wherever the zero of the instrument lies."""
    runs = [
        replace(r, signals={"phi_rad": r["phi_rad"] + askew}) for r in decays(Hull(stiffening=-1.5))
    ]
    found = {
        e["name"]: e["parameters"] for e in diagnosed(runs, tmp_path, "kvlcc2_roll")["effects"]
    }
    assert set(found) == {"roll_offset", "righting_arm_stiffening"}
    assert found["roll_offset"]["offset_rad"]["value"] == pytest.approx(askew, rel=0.05)
    assert found["righting_arm_stiffening"]["cubic_perrad2"]["value"] == pytest.approx(
        -1.5, rel=0.15
    )


def test_a_weight_off_the_centreline_is_no_inclinometer_askew(tmp_path: Path) -> None:
    runs = decays(Hull(stiffening=-1.5, heeling=40.0))
    found = {
        e["name"]: e["parameters"] for e in diagnosed(runs, tmp_path, "kvlcc2_roll")["effects"]
    }
    assert set(found) == {"steady_force", "righting_arm_stiffening"}
    assert found["steady_force"]["roll_Nm"]["value"] == pytest.approx(40.0, rel=0.05)


def decays(hull: Hull) -> list[Recording]:
    """Three decays of a hull: the middle one is the last, to be held out inside the range of the
    others."""
    return [released(hull, seed) for seed in (1, 3, 2)]
