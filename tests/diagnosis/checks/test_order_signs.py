"""Lost signs of orders are restored only where the motion shows that the vessel followed them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boatsim.diagnosis.checks.order_signs import _response_evidence, restore_order_signs
from boatsim.diagnosis.loading import open_recording_parts
from boatsim.diagnosis.log_check import check_files
from boatsim.physics.vessel import load_vessel
from boatsim.recordings.importing.channels import VesselChannel
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.table import Recording, write_csv
from boatsim.simulate import scenario
from boatsim.simulate.run import run

SEGMENT, COUNT = 6.0, 20  # [s] of each order, and their number
GAIN, HALF = 0.01108, 0.395  # the law of a program: thrust over squared rate, half the spacing
CHANNELS = ("n_port_radps", "n_starboard_radps")


def program(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Force ahead [N] and moment [N m] that a program asks for in each segment."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-60.0, 120.0, COUNT), rng.uniform(-12.0, 12.0, COUNT)


def rates(force: np.ndarray, moment: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    both = 0.5 * force + 0.5 * moment / HALF, 0.5 * force - 0.5 * moment / HALF
    port, starboard = (np.sign(T) * np.sqrt(np.abs(T) / GAIN) for T in both)
    return port, starboard


def mirrored_rates(
    force: np.ndarray, moment: np.ndarray
) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """What a program logs, that never asks for less than zero, and what it makes of a force astern.

    It computes orders for the size of the force and turns the direction of the force afterwards.
    """
    logged = tuple(np.maximum(values, 0.0) for values in rates(np.abs(force), moment))
    port, starboard = logged
    astern = force < 0.0
    done = np.where(astern, -starboard, port), np.where(astern, -port, starboard)
    return (port, starboard), done


def logged_run(
    folder: Path, seed: int, astern: bool, mirrored: bool = False, sizes: bool = True
) -> Recording:
    """A log of 10 Hz of an Otter whose drives push astern or not, with the sizes of the rates.

    Without `sizes` it has zero for a drive that does not push astern.
    """
    force, moment = program(seed)
    port, starboard = rates(force, moment)
    logged = np.abs(port), np.abs(starboard)
    if mirrored:
        logged, (port, starboard) = mirrored_rates(force, moment)
    if not astern:
        port, starboard = np.maximum(port, 0.0), np.maximum(starboard, 0.0)
    if not sizes:
        logged = port, starboard
    lines = [
        f'vessel = "otter"\nduration = {SEGMENT * COUNT}\nlog = 0.1\n[controller]\nuse = "open_loop"'
    ]
    for i in range(COUNT):
        goals = f"n_port_radps = {port[i]:.6f}\nn_starboard_radps = {starboard[i]:.6f}"
        lines.append(f"[[goal]]\nfrom = {SEGMENT * i}\n{goals}")
    (folder / f"run_{seed}.toml").write_text("\n".join(lines) + "\n")
    log = run(scenario.load(str(folder / f"run_{seed}.toml"))).recording
    rng, at = np.random.default_rng(seed + 100), np.minimum(log.t // SEGMENT, COUNT - 1).astype(int)
    signals = {}
    for name, sd in (("x_m", 0.03), ("y_m", 0.03), ("psi_rad", 0.01), ("r_radps", 0.01)):
        values = np.unwrap(log[name]) if name == "psi_rad" else log[name]
        signals[name] = values + sd * rng.standard_normal(len(log.t))
    for name, values in zip(CHANNELS, logged, strict=True):
        signals[name] = values[at]
    signals["force_x_N"], signals["force_n_Nm"] = force[at], moment[at]
    return Recording(f"run_{seed}", log.t, signals)


def true_rates(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    return rates(recording["force_x_N"], recording["force_n_Nm"])


def test_signs_that_the_vessel_followed_are_restored(tmp_path: Path) -> None:
    otter = load_vessel("otter")
    logs = [logged_run(tmp_path, seed, astern=True) for seed in (1, 2)]
    for log, found in zip(logs, restore_order_signs(logs, otter, 1), strict=True):
        for name, true in zip(CHANNELS, true_rates(log), strict=True):
            small = np.abs(true * true) < 0.02 * np.max(true * true)
            assert found[name][~small] == pytest.approx(true[~small], rel=1e-3)
        assert any("vessel followed the sign" in remark for remark in found.remarks)


def test_sides_that_a_program_exchanges_astern_are_put_right(tmp_path: Path) -> None:
    """The orders of the force and moment would push one side ahead, which the program never did."""
    logs = [logged_run(tmp_path, seed, astern=True, mirrored=True) for seed in (1, 2)]
    for log, found in zip(logs, restore_order_signs(logs, load_vessel("otter"), 2), strict=True):
        _, done = mirrored_rates(log["force_x_N"], log["force_n_Nm"])
        for name, true in zip(CHANNELS, done, strict=True):
            assert np.array_equal(found[name], true)
            assert not np.array_equal(found[name], log[name])
        assert any("sides are exchanged" in remark for remark in found.remarks)


def test_a_log_with_other_laws_than_the_judged_ones_is_used_as_logged(tmp_path: Path) -> None:
    first, second = [logged_run(tmp_path, seed, astern=True, mirrored=True) for seed in (1, 2)]
    signals = {**second.signals, CHANNELS[0]: 1.2 * second[CHANNELS[0]]}
    other = replace(second, signals=signals)
    found = restore_order_signs([first, other], load_vessel("otter"), 1)
    assert any("sides are exchanged" in remark for remark in found[0].remarks)
    assert all(np.array_equal(found[1][name], other[name]) for name in CHANNELS)
    assert any("used as logged" in remark for remark in found[1].remarks)


def test_drives_that_do_not_push_astern_stand_still(tmp_path: Path) -> None:
    logs = [logged_run(tmp_path, seed, astern=False) for seed in (1, 2)]
    for log, found in zip(logs, restore_order_signs(logs, load_vessel("otter"), 2), strict=True):
        for name, true in zip(CHANNELS, true_rates(log), strict=True):
            large = np.abs(true * true) > 0.02 * np.max(true * true)
            assert np.array_equal(
                found[name][large], np.maximum(log[name] * np.sign(true), 0.0)[large]
            )
        assert any("stood still" in remark for remark in found.remarks)


def test_orders_of_drives_that_do_not_push_astern_stay_as_they_are(tmp_path: Path) -> None:
    logs = [logged_run(tmp_path, seed, astern=False, sizes=False) for seed in (1, 2)]
    for log, found in zip(logs, restore_order_signs(logs, load_vessel("otter"), 2), strict=True):
        assert found.remarks == log.remarks
        assert all(np.array_equal(found[name], log[name]) for name in CHANNELS)


def test_a_log_without_force_and_moment_or_poses_is_left_alone(tmp_path: Path) -> None:
    otter, log = load_vessel("otter"), logged_run(tmp_path, 1, astern=True)
    for missing in ("force_n_Nm", "x_m", CHANNELS[0]):
        signals = {name: values for name, values in log.signals.items() if name != missing}
        less = replace(log, signals=signals)
        assert restore_order_signs([less], otter, 1)[0] is less


@pytest.mark.slow
def test_a_check_reports_the_signs_that_a_diagnosis_restores(tmp_path: Path) -> None:
    log = logged_run(tmp_path, 1, astern=True)
    write_csv(log, tmp_path / "log.csv")
    (tmp_path / "recording.toml").write_text('vessel = "otter"\n')
    parts, _ = open_recording_parts(tmp_path / "log.csv", None, ())
    assert float(parts[0][CHANNELS[0]].min()) >= 0.0  # each file alone stays as it was written
    entries, refused = check_files([tmp_path / "log.csv"])
    assert not refused
    (found,) = entries.values()
    (entry,) = [one for one in found if one["name"] == "order_signs"]
    assert entry["kind"] == "mended" and "restored" in entry["evidence"]


def test_a_proposed_map_keeps_the_force_and_moment_of_unsigned_orders(tmp_path: Path) -> None:
    log = logged_run(tmp_path, 1, astern=True)
    names = {
        "x_m": "x",
        "y_m": "y",
        "psi_rad": "heading",
        CHANNELS[0]: "n1",
        CHANNELS[1]: "n2",
        "force_x_N": "tau_X",
        "force_n_Nm": "tau_N",
    }
    signals = {theirs: Signal(log.t, log[ours]) for ours, theirs in names.items()}
    drives = [
        VesselChannel(name, -104.0, 104.0, lever=side)
        for name, side in zip(CHANNELS, (0.4, -0.4), strict=True)
    ]
    text = propose_map(Log(Path("log.csv"), signals), "otter", drives, ("surge", "sway", "yaw"))
    assert 'force_x_N = "tau_X"' in text and 'force_n_Nm = "tau_N"' in text
    assert "are never" in text and 'n_port_radps = "n1"' in text
    signals["tau_X"] = Signal(log.t, np.abs(log["force_x_N"]) + 200.0)
    assert "are never" not in propose_map(
        Log(Path("log.csv"), signals), "otter", drives, ("surge", "sway", "yaw")
    )


def test_a_time_without_positions_is_no_evidence() -> None:
    rng, t = np.random.default_rng(3), np.arange(0.0, 60.0, 0.2)
    force, speed, acceleration = rng.normal(size=(3, len(t)))
    whole = _response_evidence(force, t, t, speed, acceleration)
    later = np.where(t > 30.0, t + 1200.0, t)
    assert _response_evidence(force, later, later, speed, acceleration) < whole + 1.0
