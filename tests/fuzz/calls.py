"""Calls of the Python interface with changed arguments: what each raises names the argument."""

import json
import tempfile
from collections.abc import Callable
from contextlib import chdir
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import boatsim
from boatsim import api
from boatsim.diagnosis import pipeline
from boatsim.errors import BadInput
from tests.fuzz import seeds

BOAT, SCENARIO = "joystick_boat", "joystick_boat/sway_1"
BODY = {"mass": 120.0, "roll_inertia": 8.0, "yaw_inertia": 40.0}
THRUSTER = {"use": "thruster", "x": -1.0, "on": {"thrust": "thrust_N", "angle": "angle_rad"}}
BARGE = {
    "name": "barge",
    "dof": ["surge", "sway", "yaw"],
    "length": 2.0,
    "beam": 0.8,
    "draught": 0.2,
    "body": BODY,
    "channels": {
        "thrust_N": {"low": -50.0, "high": 50.0},
        "angle_rad": {"low": -0.6, "high": 0.6},
    },
    "effects": [{"use": "linear_damping", "surge": 12.0, "sway": 60.0, "yaw": 30.0}, THRUSTER],
    "manoeuvring": {"ahead": {"thrust_N": 10.0}},
}
MOST_RUNS = 1000
STATE = [0.0, 0.0, 0.0, 0.1, 0.0, 0.0]
COMMANDS = {"pwm_port": 0.1, "steer_port_rad": 0.1}
TIMES = [0.0, 0.1, 0.2]
# Calls that are allowed: name and keyword arguments. A text in braces stands for an object.
CALLS: list[tuple[str, dict[str, Any]]] = [
    ("load_vessel", {"name": BOAT, "load": ["heavy"]}),
    ("load_scenario", {"name": SCENARIO, "controller": "l1_joystick", "duration": 0.1}),
    ("load_scenario", {"name": SCENARIO, "vessel": "{vessel}", "goal": [{"sway_mps": 0.05}]}),
    ("run", {"scenario": "{scenario}", "seed": 1, "out": "{folder}"}),
    ("read", {"path": "{log}", "vessel": None, "load": []}),
    ("export", {"recording": "{log}", "path": "{mcap}"}),
    (
        "diagnose",
        {
            "runs": ["{log}"],
            "hold_out": [],
            "vessel": "trial_boat",
            "load": [],
            "library": ["current"],
            "without": ["wind"],
            "horizon": 2.0,
            "settings": {"select.odds": 3.0},
        },
    ),
    ("replay", {"recording": "{log}", "vessel": "trial_boat", "load": [], "horizon": 1.0}),
    (
        "sweep",
        {
            "scenarios": [SCENARIO],
            "vary": {"body.mass": [5.0, 6.0], "controller.use": "l1_joystick,pid_autopilot"},
            "draw": {"start.psi": "normal(0, 0.1)"},
            "runs": 2,
            "design": "latin",
            "seed": 0,
            "out": "{folder}",
            "jobs": 1,
            "ray": None,
            "norms": "heading_at_end",
        },
    ),
    ("Vessel.from_effects", BARGE),
    ("vessel.replace", {"length": 1.3, "body": "{body}", "dof": ["surge", "sway", "yaw"]}),
    ("vessel.with_effect", {"effect": {"use": "current", "north": 0.1, "name": "drift"}}),
    ("vessel.without_effect", {"name": "thrust_lag"}),
    (
        "vessel.with_parameters",
        {"parameters": {"body": {"mass": 6.0}, "added_mass": {"surge": 1.0}}},
    ),
    ("vessel.with_measured", {"values": {}}),
    ("vessel.save", {"folder": "{folder}"}),
    ("Body", BODY),
    ("CommandChannel", {"low": -1.0, "high": 1.0, "neutral": 0.0, "turns": "port", "about": "a"}),
    ("Recording", {"name": "a", "t": TIMES, "signals": {"x_m": TIMES, "psi_rad": TIMES}}),
    ("recording.between", {"from_s": 0.0, "to_s": 0.15}),
    ("recording.thinned", {"rate": 5.0}),
    ("recording.unit", {"name": "psi_rad"}),
    (
        "Scenario.from_settings",
        {
            "vessel": "{vessel}",
            "name": "a",
            "duration": 0.1,
            "controller": {"use": "open_loop"},
            "goal": [{"pwm_port": 0.1}],
        },
    ),
    ("Batch", {"vessels": ["{vessel}"], "n": 2, "step": 0.02, "threads": 1, "seeds": [1, 2]}),
    ("batch.reset", {"states": STATE, "commands": COMMANDS, "boats": [0]}),
    ("batch.reset", {"states": [STATE, STATE], "commands": None, "boats": [True, True]}),
    ("batch.advance", {"commands": COMMANDS, "steps": 3}),
    ("batch.advance", {"commands": [[0.1] * 6, [0.0] * 6], "steps": 3}),
    ("batch.set", {"parameter": "body.mass", "values": [5.0, 6.0], "boats": [0, 1]}),
    ("batch.get", {"parameter": "added_mass.surge"}),
    ("batch.assign", {"vessel": 0, "boats": [0]}),
    ("batch.rollout", {"start": STATE, "commands": [[0.1] * 6], "interval": 0.1, "t0": 0.0}),
    ("batch.hold_commands", {"start": STATE, "commands": COMMANDS, "steps": 3}),
    ("Fleet", {"scenario": "{scenario}", "n": 2, "vessels": None, "seeds": [1, 2], "threads": 1}),
    ("fleet.reset", {"starts": STATE}),
    ("fleet.run", {"seconds": 0.1, "log": 0.05}),
]
# Objects that JSON lacks, by the text that a mutation may put in a place
STRANGE: dict[str, Callable[[], Any]] = {
    "{object}": object,
    "{bytes}": lambda: b"a",
    "{set}": lambda: {"a", "b"},
    "{array}": lambda: np.array([1.0, 2.0]),
    "{complex}": lambda: 1j,
    "{type}": lambda: int,
    "{function}": lambda: len,
    "{generator}": lambda: iter([1, 2]),
    "{numpy int}": lambda: np.int64(2),
    "{numpy float}": lambda: np.float32(0.5),
    "{numpy bool}": lambda: np.True_,
    "{circle}": lambda: _circle(),
    "{mixed keys}": lambda: {1: 2, (3, 4): 5},
    "{vessel}": lambda: _vessel(),
    "{scenario}": lambda: _scenario(),
    "{body}": lambda: _vessel().body,
    "{folder}": lambda: Path(_folder().name) / "out",
    "{mcap}": lambda: Path(_folder().name) / "run.mcap",
    "{log}": lambda: seeds.folder() / "noted" / "run.csv",
}


def _circle() -> list[Any]:
    made: list[Any] = []
    made.append(made)
    return made


@cache
def _vessel() -> boatsim.Vessel:
    return boatsim.load_vessel(BOAT)


@cache
def _scenario() -> boatsim.Scenario:
    return boatsim.load_scenario(SCENARIO, duration=0.1)


@cache
def _folder() -> "tempfile.TemporaryDirectory[str]":
    return tempfile.TemporaryDirectory(prefix="fuzz-calls-")


@cache
def _working_folder() -> Path:
    """A folder so deep that `..` stays in the temporary one."""
    place = Path(_folder().name) / "a" / "b" / "c"
    place.mkdir(parents=True)
    return place


@cache
def _subject(name: str) -> Any:
    """The object whose method is called."""
    made: dict[str, Callable[[], Any]] = {
        "vessel": _vessel,
        "recording": lambda: boatsim.Recording("a", np.array(TIMES), {"x_m": np.array(TIMES)}),
        "batch": lambda: boatsim.Batch(_vessel(), 2, threads=1),
        "fleet": lambda: boatsim.Fleet(_scenario(), 2, threads=1),
    }
    if name in made:
        return made[name]()
    return getattr(boatsim, name)


def calls() -> list[bytes]:
    """Every allowed call."""
    return [json.dumps({"call": name, "with": given}).encode() for name, given in CALLS]


def call(path: Path) -> object:
    """Call what a file names; raises BadInput for a TypeError that names an argument."""
    asked = json.loads(path.read_bytes())
    if not isinstance(asked, dict) or not isinstance(asked.get("with"), dict):
        raise BadInput("no call")
    known = dict(CALLS)
    name = asked.get("call")
    if not isinstance(name, str) or name not in known:
        raise BadInput("no call")
    owner, _, method = name.partition(".")
    function = _subject(owner)
    if method:
        function = getattr(function, method)
    given = {key: _object(value) for key, value in asked["with"].items()}
    try:
        with (
            chdir(_working_folder()),  # of calls that write to a relative path
            patch.object(api, "run_plan", _without_runs),
            patch.object(pipeline, "diagnose_loaded", _without_fit),
        ):
            return function(**given)
    except TypeError as error:
        keys = [*given, *known[name], "argument"]  # "missing 1 required positional argument"
        if not any(key in str(error) for key in keys) or "\n" in str(error):
            raise
        raise BadInput(str(error)) from None


def _object(value: Any) -> Any:
    if isinstance(value, str) and value in STRANGE:
        return STRANGE[value]()
    if isinstance(value, dict):
        return {key: _object(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_object(inner) for inner in value]
    return value


def _without_runs(plan: Any, *_: object) -> tuple[Any, bool]:
    """In place of the runs of a sweep: the first are loaded, none is run."""
    if plan.run_count > MOST_RUNS:
        raise BadInput("more runs than a test has time for")
    for _ in plan.tasks():
        break
    return api.Results(plan, {}), True


def _without_fit(loaded: Any, _: object, config: Any) -> Any:
    """In place of a diagnosis: what it does before it fits."""
    return pipeline.set_up_estimation_problem(loaded, config)
