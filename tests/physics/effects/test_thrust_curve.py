"""A measured table of thrust against command is followed exactly and survives its vessel file."""

from pathlib import Path

import boats
import numpy as np
import pytest

from boatsim.errors import BadInput
from boatsim.physics import vessel
from boatsim.physics.effects.thrust_curve import ThrustCurve
from boatsim.physics.program import Program
from boatsim.physics.vessel.effect_tables import effect_table

POINTS = [[-100.0, -20.0], [-10.0, 0.0], [10.0, 0.0], [50.0, 15.0], [100.0, 60.0]]


def with_curve(folder: Path, points: list[list[float]]) -> vessel.Vessel:
    """A boat with two thrusters, the port one driven in per cent."""
    raw = "[channels]\nthrottle_port = { low = -100.0, high = 100.0 }"
    file = boats.written(folder, "curved", boats.PLANAR.replace("[channels]", raw))
    table = {
        "use": "thrust_curve",
        "on": "thrust_port_N",
        "fed_by": "throttle_port",
        "points": points,
    }
    return vessel.load_vessel(str(file), extra=[table])


@pytest.mark.parametrize("count", [2, 5])
def test_the_thrust_is_that_of_the_table(tmp_path: Path, count: int) -> None:
    program = Program(with_curve(tmp_path, POINTS[-count:]))
    values, on = program.values(), program.effect_switches()
    for command in np.linspace(-120.0, 120.0, 25):
        act, memory = np.zeros(program.actuator_signal_size), np.zeros(program.memory_size)
        program.simulation_functions.advance_actuators(
            program.command_array({"throttle_port": command}), memory, 0.1, values, on, act
        )
        settled = dict(zip(program.vessel.actuators, act.tolist(), strict=False))
        expected = np.interp(command, *np.transpose(POINTS[-count:]))
        assert settled["thrust_port_N"] == pytest.approx(expected, abs=1e-12)


def test_the_table_of_the_effect_has_its_points() -> None:
    table = effect_table(ThrustCurve(points=POINTS))
    assert table["points"] == POINTS
    assert effect_table(ThrustCurve.from_settings({"points": table["points"]})) == table


@pytest.mark.parametrize(
    "points",
    [POINTS[::-1], POINTS[:1], [[0.0, 1.0], [0.0, 2.0]], [[0.0], [1.0]], "steep", [["a", 1]]],
)
def test_a_table_without_increasing_commands_is_refused(points: object) -> None:
    with pytest.raises(BadInput, match="thrust_curve.points = .* by increasing command"):
        ThrustCurve(points=points)  # type: ignore[arg-type]
