"""A uniform current is a moving frame: seen from the water every vessel sails as in still water
(Galilei)."""

import numpy as np
import pytest
from alike import few

from boatsim.physics import content, vessel
from boatsim.physics.base import Array
from boatsim.physics.effects.current import Current
from boatsim.physics.program import Program
from boatsim.physics.signals import motion_signals
from boatsim.physics.vessel import Vessel
from boatsim.simulate.batch import Batch

NORTH, EAST = 0.8, -0.6  # [m/s] of the current: 1 m/s
HELD = 5.0  # [s] each row of commands
TOLERANCE = 1e-9  # [m, rad, m/s, rad/s] of a run of minutes in which ships go hundreds of metres
# Without vessels on which the air acts, since it does not move with the water
IN_WATER_ALONE = [
    name
    for name in content.shipped_content_names("vessel")
    if vessel.load_vessel(name).effect("gusty_wind") is None
]
CASES = [
    (name, load)
    for name in IN_WATER_ALONE
    for load in ([], *([one] for one in vessel.load_vessel(name).loads))
    if "surge"
    in vessel.load_vessel(name).dof  # a hull that only rolls about a fixed axis is carried nowhere
]


def in_flow(name: str, loads: list[str]) -> Vessel:
    """A vessel in water that may move."""
    boat = vessel.load_vessel(name, loads)
    return boat if boat.effect("current") else boat.with_completed_effect(Current())


def commands(boat: Vessel) -> Array:
    """(N, C): every command alone at the ends of its range, then ten rows in which all of them jump
    by lot."""
    low, high = np.array([(c.low, c.high) for c in boat.commands.values()]).T
    rest = np.array([c.neutral for c in boat.commands.values()])
    ends = [
        np.where(np.arange(len(low)) == i, end, rest)
        for i in range(len(low))
        for end in (low, high)
    ]
    return np.array([*ends, *np.random.default_rng(0).uniform(low, high, (10, len(low)))])


def start_of(boat: Vessel) -> Array:
    """Under way, drifting, turning and heeled."""
    U = 0.15 * np.sqrt(9.81 * boat.length)
    state = {"psi": 0.4, "phi": 0.05, "u": U, "v": 0.1 * U, "r": 0.1 * U / boat.length, "p": 0.02}
    return np.array([state.get(signal.symbol, 0.0) for signal in motion_signals(boat.dof)])


def carried(program: Program, states: Array, t: Array, by: float = 1.0) -> Array:
    """States (N, 2 NQ) as seen by one who sails the other way, with velocity -by * (NORTH, EAST)
    over the ground."""
    seen, nq = np.array([program.to_joint_rates(state) for state in states]), states.shape[1] // 2
    flow = by * np.array([NORTH, EAST])
    seen[:, :2] += np.outer(t, flow)
    seen[:, nq : nq + 2] += flow
    return program.to_body_velocities(seen)


def sails_as_in_still_water(boat: Vessel) -> None:
    """Law of a vessel that has the effect `current`."""
    compiled, rows, start = Batch(boat), commands(boat), start_of(boat)
    still, moving = compiled.program.values(), compiled.program.values()
    for way, velocity in (("north", NORTH), ("east", EAST)):
        at = compiled.program.parameter_index("current", way)
        still[at], moving[at] = 0.0, velocity
    t = HELD * np.arange(len(rows) + 1.0)
    wanted = compiled.rollout(start, rows, HELD, still)
    (begin,) = carried(compiled.program, start[None], t[:1])
    found = compiled.rollout(begin, rows, HELD, moving)
    assert np.ptp(wanted, axis=0).min() > 1e-5  # it did move, in heave by less than a millimetre
    assert carried(compiled.program, found, t, -1.0) == pytest.approx(
        wanted, rel=0.0, abs=TOLERANCE
    )


@pytest.mark.parametrize(("name", "loads"), few(CASES, 3, 10))
def test_a_vessel_in_a_uniform_current_sails_as_in_still_water(name: str, loads: list[str]) -> None:
    sails_as_in_still_water(in_flow(name, loads))


def test_so_does_a_boat_whose_model_lacks_what_is_on_board() -> None:
    """Ballast moves with the hull: its Coriolis force is that of its speed over ground."""
    ballast = [
        {"use": "extra_mass", "mass": 1.5, "x": 0.3},
        {"use": "payload", "mass": 0.8},
        {"use": "mass_centre_shift", "shift": -0.1},
        {"use": "current"},
    ]
    sails_as_in_still_water(vessel.load_vessel("trial_boat", extra=ballast))
