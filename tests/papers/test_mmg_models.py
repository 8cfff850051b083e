"""The published MMG model of the KVLCC2 at both scales, and what is read of the tanks' zig-zags."""

from dataclasses import replace

import numpy as np
import pytest

from boatsim.diagnosis import priors
from boatsim.diagnosis.problem import froude_scale
from boatsim.physics import vessel
from boatsim.physics.effects.mmg_hull import MmgHull
from boatsim.recordings.table import Recording
from boatsim.simulate import manoeuvre, scenario
from boatsim.simulate.evaluation import requested_metrics
from boatsim.simulate.run import Run, run
from validation.real import kvlcc2_mmg as bench
from validation.real.common import RECORDINGS, runs_of

MODEL, SHIP = vessel.load_vessel("kvlcc2_mmg"), vessel.load_vessel("kvlcc2_mmg_full_scale")
RATIO = SHIP.length / MODEL.length
TIME = RATIO**0.5  # Froude's law


def grows(unit: str) -> float:
    """How much larger a number of this unit is on the ship, in the same water."""
    return froude_scale(unit, SHIP) / froude_scale(unit, MODEL)


def test_every_number_of_the_ship_is_the_models_by_froudes_law() -> None:
    for own in MODEL.effects:
        scaled = SHIP.effect(own.name)
        assert scaled is not None, own.name
        for name, about in type(own).params().items():
            unscaled = (
                about.unit == "kg/m^3" or name == "instant"
            )  # the water, and what is so large that it never acts
            wanted = getattr(own, name) * (1.0 if unscaled else grows(about.unit))
            assert getattr(scaled, name) == pytest.approx(wanted, rel=1e-6, nan_ok=True), (
                f"{own.name}.{name}"
            )
    assert MODEL.scale == pytest.approx(RATIO, rel=1e-4) == SHIP.scales[MODEL.name]
    assert {e.name for e in SHIP.effects} - {e.name for e in MODEL.effects} == {"shaft_rpm"}
    assert SHIP.body.mass == pytest.approx(MODEL.body.mass * RATIO**3)
    assert SHIP.body.yaw_inertia == pytest.approx(MODEL.body.yaw_inertia * RATIO**5)
    assert (SHIP.beam, SHIP.draught) == pytest.approx((MODEL.beam * RATIO, MODEL.draught * RATIO))


def zigzag(name: str, step: float) -> Recording:
    """A 10/10 zig-zag with this step [s] and rows at every fourth."""
    made = manoeuvre.manoeuvre_scenario("zigzag", name, angle=10.0)
    made = replace(made, file=made.file.model_copy(update={"step": step, "log": 4 * step}))
    made.controller.period = step  # type: ignore[attr-defined]
    return run(made).recording


@pytest.fixture(scope="module")
def published() -> Run:
    return run(scenario.load("kvlcc2_mmg/zigzag_10"))


@pytest.mark.slow
def test_the_ship_sails_a_zigzag_as_its_model_does_in_longer_time() -> None:
    small, large = zigzag(MODEL.name, 0.05), zigzag(SHIP.name, 0.05 * TIME)
    rows = min(len(small), len(large))
    assert np.ptp(small["psi_rad"]) > np.radians(20.0) and abs(len(small) - len(large)) <= 1
    assert large.t[:rows] == pytest.approx(small.t[:rows] * TIME)
    assert large["psi_rad"][:rows] == pytest.approx(small["psi_rad"][:rows], abs=1e-5)
    assert large["x_m"][:rows] == pytest.approx(small["x_m"][:rows] * RATIO, rel=1e-5, abs=1e-3)


def test_the_model_turns_back_sooner_than_the_tanks_measured(published: Run) -> None:
    """10/10 to starboard: 4.9 and 13.6 degrees by the published equations, 8.2 and 21.9 measured by
    MARIN."""
    made = requested_metrics(published)
    found = made["first_overshoot"].value, made["second_overshoot"].value
    assert found == pytest.approx((4.9, 13.6), abs=0.05)
    assert found[0] < 8.2 - 1.5 and found[1] < 21.9 - 2.8  # by more than two tanks differ


def test_a_recalibration_moves_every_derivative_of_the_hull_and_the_flow_at_the_rudder() -> None:
    """What is called recalibrated is the published structure at its best, not at its gains
    alone."""
    derivatives = {n for n in MmgHull.params() if n[:2] in ("X_", "Y_", "N_")}
    free = {
        (type(e).type_name(), n)
        for e in MODEL.effects
        for n, about in type(e).params().items()
        if about.calibrates
    }
    assert {n for idea, n in free if idea == "mmg_hull"} == derivatives | {"R_0"}
    assert {n for idea, n in free if idea == "mmg_rudder"} == {
        "gain",
        "hull_share",
        "straightening_port",
        "straightening_starboard",
    }
    assert (
        priors.coefficient_uncertainty(MODEL)
        == priors.coefficient_uncertainty(SHIP)
        == {"damping": 0.5, "thrust": 0.5}
    )


# ---- the benchmark's helpers


def test_reversals_and_overshoots_of_a_zigzag_are_those_of_its_norms(published: Run) -> None:
    log, made = published.recording, requested_metrics(published)
    at = bench.reversals(log["delta_rad"])
    found = bench.overshoots(log["psi_rad"], log["delta_rad"], at)
    assert np.abs(log["psi_rad"][at]) == pytest.approx(
        np.full(len(at), np.radians(10.0)), abs=np.radians(0.3)
    )
    wanted = [made[f"{n}_overshoot"].value for n in bench.COUNT]
    assert found[:2] == pytest.approx(wanted, abs=0.3)  # the log has ten rows a second


def test_a_swing_that_the_rows_cut_off_is_no_overshoot() -> None:
    delta = np.repeat([0.2, -0.2], 50)
    rising = np.linspace(0.0, 1.0, 100)
    assert bench.reversals(delta) == [49]
    assert bench.overshoots(rising, delta, [49]) == []
    assert bench.overshoots(
        rising - np.maximum(rising - 0.8, 0.0) * 2.0, delta, [49]
    ) == pytest.approx([np.degrees(0.8 - rising[49])], abs=1.0)


@pytest.mark.skipif(
    not (RECORDINGS / "kvlcc2_marin_free").is_dir(), reason="needs ../shared/recordings"
)
def test_overshoots_read_of_marins_zigzags_are_the_published_ones() -> None:
    runs = bench.open_runs(runs_of("kvlcc2_marin_free"), SHIP.name)
    wanted = {"zz_m10": (8.2, 21.9), "zz_10": (9.5, 15.0), "zz_m20": (13.7, 14.9)}
    for name, published in wanted.items():
        psi, delta = runs[name]["psi_rad"], runs[name]["delta_rad"]
        found = bench.overshoots(psi, delta, bench.reversals(delta))[:2]
        assert found == pytest.approx(published, abs=0.5), name
