"""Commands act when they were given, however few rows of a recording are used; an exact log is
taken for exact."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from answers import diagnosed
from real_boat import FURTHER, Real, recorded

from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.filter import rigid_body_values
from boatsim.diagnosis.prior_noise import relative_noise
from boatsim.diagnosis.recording_mapping import map_recording
from boatsim.physics import vessel
from boatsim.physics.base import Array
from boatsim.physics.kernel.records import Inputs, VesselNumbers
from boatsim.physics.program import Program
from boatsim.recordings.table import Recording
from boatsim.simulate.batch import Batch

EVERY, ROWS = 0.02, 1501  # [s]; 30 s


def quick() -> tuple[Recording, Array]:
    """The tool's own exact log at 50 Hz of a boat whose thrusts change every 40 ms, and twice as
    many states (N, 6)."""
    boat, rng = vessel.load_vessel("trial_boat"), np.random.default_rng(4)
    commands = np.repeat(rng.uniform(-0.6, 0.9, (ROWS // 2 + 1, len(boat.commands))), 2, axis=0)[
        :ROWS
    ]
    states = Batch(boat, step=EVERY / 2).rollout(
        [0.0] * 6, np.repeat(commands, 2, axis=0), EVERY / 2
    )[: 2 * ROWS]
    t = EVERY * np.arange(ROWS)
    pose = dict(zip(("x_m", "y_m", "psi_rad"), states[::2, :3].T, strict=True))
    return Recording("quick", t, pose | dict(zip(boat.commands, commands.T, strict=True))), states


def test_thinned_rows_keep_every_command_at_its_own_time() -> None:
    run, states = quick()
    boat = vessel.load_vessel("trial_boat")
    laid = map_recording(run.thinned(5.0), Program(boat))
    assert len(laid.times) == ROWS // 10 + 1 and len(laid.command_times) == ROWS // 2 + 1
    n, out = len(laid.times), np.full((1, len(laid.times), 6), np.nan)
    there = np.rint(laid.times / (EVERY / 2)).astype(int)
    laid.program.estimation_functions.simulate_intervals(
        Inputs(laid.times, laid.command_times, laid.command_values),
        DEFAULT.filter.free_run_step,
        VesselNumbers(rigid_body_values(laid.values), laid.values, laid.program.effect_switches()),
        np.array([0]),
        np.array([n - 1]),
        states[there[:1]],
        out,
    )
    assert np.abs(out[0, :, :3] - states[there, :3]).max() < 1e-5
    part = run.thinned(5.0).between(10.0, 20.0)
    assert (
        part.orders is not None
        and part.orders.t[0] <= 10.0 < part.orders.t[1]
        and part.orders.t[-1] <= 20.0
    )


def test_channels_of_any_name_are_commands() -> None:
    """A channel that a user calls port_N is averaged and kept as one called thrust_port_N is."""
    run, _ = quick()
    other = replace(
        run, signals={k.replace("thrust_port_N", "port_N"): v for k, v in run.signals.items()}
    )
    thin, plain = other.thinned(5.0), run.thinned(5.0)
    assert np.array_equal(thin["port_N"], plain["thrust_port_N"])
    assert thin.orders is not None and np.array_equal(
        thin.orders.signals["port_N"], run["thrust_port_N"]
    )


@pytest.mark.slow
def test_an_exact_log_is_named_exactly(tmp_path: Path) -> None:
    """The tool's own log without any noise: what is left over is rounding, which is nobody's
    fault."""
    boat = vessel.load_vessel(
        "trial_boat", settings={n: {"gain": 0.7} for n in ("port", "starboard")}
    )
    exact = []
    for seed in (1, 2, 3):
        run = recorded(Real(), seed, 5)
        commands, every = (
            np.column_stack([run[n] for n in boat.commands]),
            float(run.t[1] - run.t[0]),
        )
        states = Batch(boat, step=every / 4).rollout([0.0] * 6, commands, every)[: len(run)]
        pose = dict(zip(("x_m", "y_m", "psi_rad"), states[:, :3].T, strict=True))
        exact.append(replace(run, signals=run.signals | pose))
    answer = diagnosed(exact, tmp_path, "trial_boat", FURTHER)
    assert answer["verdict"] == "named" and [e["name"] for e in answer["effects"]] == [
        "thrust_gain_error"
    ]
    assert abs(answer["effects"][0]["parameters"]["factor"]["value"] - 0.7) < 0.01


def test_how_noisy_an_unseen_log_is_does_not_hang_on_those_fitted() -> None:
    boat, rng = vessel.load_vessel("trial_boat"), np.random.default_rng(1)
    exact, _ = quick()
    noisy = {
        n: exact[n] + sd * rng.standard_normal(ROWS) for n, sd in (("x_m", 0.01), ("y_m", 0.01))
    }
    camera = replace(exact, signals=exact.signals | noisy)
    assert relative_noise(boat, [camera], camera) == {}
    there = relative_noise(boat, [camera], exact)
    assert set(there) == {"position_sd_m"} and there["position_sd_m"] < 0.1
    assert relative_noise(boat, [exact], camera)["position_sd_m"] > 10.0
