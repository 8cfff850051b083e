"""A fault of one drive of several is named with the drive and its size, and nothing else is.

The recordings come from an integrator that shares no code with the tool; the diagnosis has all
candidates."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from answers import diagnosed, named, nothing_missing
from driven_boats import platform_of_three_drives
from scipy.integrate import odeint

from boatsim.physics.base import Array
from boatsim.recordings.table import Notes, Recording

MASS, INERTIA = 30.0, 4.0  # kg, kg m^2
DAMPING = np.array([6.0, 15.0, 6.0])  # N s/m, N s/m, N m s
DRIVES = ("bow", "port", "starboard")
X, Y = np.array([0.6, -0.6, -0.6]), np.array([0.0, -0.3, 0.3])  # ahead and to starboard [m]
ANGLE = np.array([0.5 * np.pi, 0.0, 0.0])  # rad
FULL = 8.0  # N
RATE, ROWS, HOLD = 5.0, 400, 10  # Hz, rows of a recording, rows between two orders
PORT = np.arange(3) == 1

# orders (3,) [N] and speeds of advance of the drives (3,) [m/s] -> thrusts (3,) [N]
Fault = Callable[[Array, Array], Array]


def dead(order: Array, speed: Array) -> Array:
    """The port drive gives nothing below 1.6 N, and loses 1.6 N above."""
    beyond = np.sign(order) * np.maximum(abs(order) - 1.6, 0.0)
    return np.where(PORT, beyond, order)


def bent(order: Array, speed: Array) -> Array:
    """The thrust of the port drive grows with a power of its command."""
    return np.where(PORT, np.sign(order) * FULL * (abs(order) / FULL) ** 1.3, order)


def weak(order: Array, speed: Array) -> Array:
    """The port drive gives less than specified."""
    return np.where(PORT, 0.8 * order, order)


def lossy(order: Array, speed: Array) -> Array:
    """The port drive loses thrust with its speed of advance."""
    return np.where(PORT, order - 0.3 * speed * abs(order), order)


def weak_astern(order: Array, speed: Array) -> Array:
    """The port drive gives less than specified where it pushes astern."""
    return np.where(PORT & (order < 0.0), 0.6 * order, order)


def all_weak_astern(order: Array, speed: Array) -> Array:
    """All drives give less than specified where they push astern."""
    return np.where(order < 0.0, 0.6 * order, order)


def derivatives(state: Array, time: float, order: Array, fault: Fault) -> list[float]:
    """Rates of north, east, heading and the velocities ahead, to starboard and of turn."""
    u, v, r = state[3:]
    speed = (u - r * Y) * np.cos(ANGLE) + (v + r * X) * np.sin(ANGLE)
    thrust = fault(order, speed)
    ahead, right = thrust * np.cos(ANGLE), thrust * np.sin(ANGLE)
    forces = np.array([ahead.sum(), right.sum(), X @ right - Y @ ahead]) - DAMPING * state[3:]
    c, k = np.cos(state[2]), np.sin(state[2])
    velocities = [u * c - v * k, u * k + v * c, r]
    return [*velocities, forces[0] / MASS + r * v, forces[1] / MASS - r * u, forces[2] / INERTIA]


def sailed(fault: Fault, seed: int) -> Recording:
    """A recording of random orders of all drives, ahead and astern."""
    rng = np.random.default_rng(seed)
    orders = rng.uniform(-FULL, FULL, (ROWS // HOLD, 3))
    times = np.arange(HOLD + 1) / RATE
    state, poses = np.zeros(6), list[Array]()
    for order in orders:
        course = odeint(derivatives, state, times, args=(order, fault), rtol=1e-8)
        poses += list(course[:-1, :3])
        state = course[-1]
    seen = np.array(poses) + rng.standard_normal((ROWS, 3)) * 0.005
    signals = dict(zip(("x_m", "y_m", "psi_rad"), seen.T, strict=True))
    for drive, given in zip(DRIVES, orders.T, strict=True):
        signals[f"{drive}_N"] = np.repeat(given, HOLD)
    return Recording(f"run_{seed}", np.arange(ROWS) / RATE, signals, Notes())


def answer(fault: Fault, folder: Path) -> dict[str, Any]:
    """The answer for three recordings of the platform with a fault; the last one is held out."""
    saved = platform_of_three_drives().save(folder / "platform").file
    return diagnosed([sailed(fault, seed) for seed in (1, 2, 3)], folder, str(saved))


@pytest.mark.slow
def test_the_dead_band_of_one_drive_is_named_with_the_drive_and_its_width(tmp_path: Path) -> None:
    named(answer(dead, tmp_path), "drive_deadband_port_N", {"width": 1.6})


@pytest.mark.slow
def test_a_bent_curve_of_one_drive_is_not_taken_for_a_dead_band(tmp_path: Path) -> None:
    named(answer(bent, tmp_path), "drive_exponent_port_N", {"exponent": 1.3})


@pytest.mark.slow
def test_a_weak_drive_is_not_taken_for_one_with_a_dead_band(tmp_path: Path) -> None:
    named(answer(weak, tmp_path), "drive_gain_error_port", {"factor": 0.8})


@pytest.mark.slow
def test_a_drive_that_alone_loses_thrust_with_the_speed_is_named(tmp_path: Path) -> None:
    named(answer(lossy, tmp_path), "drive_loss_with_speed_port", {"loss_spm": 0.3})


@pytest.mark.long
@pytest.mark.slow
def test_a_drive_that_alone_is_weak_astern_is_named(tmp_path: Path) -> None:
    named(answer(weak_astern, tmp_path), "drive_weak_reverse_port_N", {"astern_factor": 0.6})


@pytest.mark.slow
def test_drives_that_are_equally_weak_astern_have_one_fault(tmp_path: Path) -> None:
    named(answer(all_weak_astern, tmp_path), "weak_reverse", {"astern_factor": 0.6})


@pytest.mark.slow
def test_drives_without_a_fault_have_nothing_missing(tmp_path: Path) -> None:
    nothing_missing(answer(lambda order, speed: order, tmp_path))
