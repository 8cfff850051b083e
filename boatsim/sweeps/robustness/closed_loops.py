"""Simulation of the drawn boats of a robustness benchmark under one controller."""

from dataclasses import dataclass, replace
from math import pi

import numpy as np

from boatsim.control.base import Controller
from boatsim.control.compiled import CompiledController
from boatsim.errors import BadInput
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.signals import Array
from boatsim.physics.vessel import Vessel
from boatsim.simulate.fleet import Fleet, FleetLog
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.vessel_model import introduce_vessel
from boatsim.sweeps.robustness.disturbances import Disturbance
from boatsim.sweeps.robustness.drawn_boats import DrawnBoats
from boatsim.sweeps.robustness.manoeuvre import Manoeuvre, TrackedSignal, integration_step

# [m/s] noise of the speed log for a hull of 1 m, that of the sensors of scenario files
SPEED_NOISE = 0.01
ROW = 0.15  # [s] between two rows for a hull of 1 m: twenty rows for an oscillation of 3 s


@dataclass(frozen=True)
class ClosedLoop:
    """A controller on a vessel with the manoeuvre that it performs.

    Attributes:
        name: Name of the controller.
        controller: The controller.
        manoeuvre: The manoeuvre.
        scenario: Scenario of the manoeuvre.
    """

    name: str
    controller: Controller
    manoeuvre: Manoeuvre
    scenario: Scenario


def check_controller(name: str, controller: Controller, vessel: Vessel) -> None:
    """Check that a controller can steer a fleet of a vessel.

    Args:
        name: Name of the controller.
        controller: The controller.
        vessel: The vessel.

    Raises:
        BadInput: The controller cannot run in a fleet, or does not fit the vessel.
    """
    if not runs_in_a_fleet(type(controller)):
        able = []
        for other in shipped_content_names("controller"):
            if runs_in_a_fleet(load_class("controller", other)):
                able.append(other)
        raise BadInput(
            f"controller {name!r} has no compiled law, so that it cannot steer a fleet "
            f"(these have one: {', '.join(able)})"
        )
    introduce_vessel(controller, vessel)
    for channel in controller.channels():
        if channel not in vessel.commands:
            raise BadInput(
                f"controller {name} does not fit {vessel.name}: "
                f"{vessel.unknown_command_message(channel)}"
            )


def make_closed_loop(
    name: str, controller: Controller, vessel: Vessel, manoeuvre: Manoeuvre
) -> ClosedLoop:
    """Return the closed loop of a controller on a vessel.

    Args:
        name: Name of the controller.
        controller: The controller.
        vessel: The vessel.
        manoeuvre: The manoeuvre.
    """
    scenario = Scenario.from_settings(
        vessel=vessel,
        name="robustness",
        controller={"use": "open_loop", "period": controller.period},
        sensors={"speed_sd": SPEED_NOISE * vessel.length**0.5},
        duration=manoeuvre.duration,
        step=integration_step(vessel, controller),
    )
    file = scenario.file.model_copy(update={"goal": list(manoeuvre.goals)})
    scenario = replace(scenario, file=file, controller=controller)
    return ClosedLoop(name, controller, manoeuvre, scenario)


def runs_in_a_fleet(controller: type[Controller]) -> bool:
    """Return whether a controller has a compiled law and does nothing else."""
    compiled = issubclass(controller, CompiledController)
    return compiled and controller.step is CompiledController.step


def tracking_errors(
    loop: ClosedLoop, boats: DrawnBoats, disturbance: Disturbance | None, value: float
) -> Array:
    """Return the rms errors (n, signals) of all boats under a disturbance.

    Args:
        loop: The closed loop.
        boats: The boats.
        disturbance: The disturbance; None for none.
        value: Its value.

    Returns:
        Errors in the units of the signals; infinite for a boat whose motion has diverged.
    """
    scenario = loop.scenario
    if disturbance is not None:
        sensors = disturbance.disturbed_sensors(scenario.sensors, value)
        scenario = replace(scenario, sensors=sensors)
    count = len(boats)
    seeds = range(boats.seed, boats.seed + count)
    fleet = Fleet(scenario, count, vessels=boats.vessel, seeds=seeds, controller=loop.controller)
    boats.assign_to(fleet.batch)
    if disturbance is not None:
        for key, values in disturbance.changes(boats, value).items():
            fleet.batch.set(key, values)
    fleet.reset()
    log = fleet.run(log=ROW * boats.vessel.length**0.5)
    errors = [_rms_error(loop, log, signal) for signal in loop.manoeuvre.signals]
    return np.column_stack(errors)


def _rms_error(loop: ClosedLoop, log: FleetLog, signal: TrackedSignal) -> Array:
    """Rms errors (n,) of one signal over the scored rows."""
    rows = loop.manoeuvre.scored_rows(log.t)
    wanted = np.array([loop.scenario.goal_at(t)[signal.goal] for t in log.t[rows]])
    with np.errstate(invalid="ignore", over="ignore"):
        error = log[signal.column][rows] - wanted[:, None]
        if signal.column == "psi_rad":
            error = (error + pi) % (2.0 * pi) - pi
        rms = np.sqrt(np.mean(np.square(error), axis=0))
    return np.where(np.isfinite(rms), rms, np.inf)
