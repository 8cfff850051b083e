"""Cases of the effects: vessel, parameters and example of each effect on its reference page.

They are in `effect_cases.toml`. The errors of single recorded channels (`yaw_rate_gain`, ...) need
no entry, because they differ in channel and kind of error only.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from boatsim.physics import content
from boatsim.physics.base import Effect
from boatsim.physics.effects.sensor_error import SensorError
from boatsim.physics.vessel import Vessel, load_vessel
from boatsim.physics.vessel.schema import MeasuredChannel

FILE = Path(__file__).with_name("effect_cases.toml")
Case = Mapping[str, Any]
VESSEL = "trial_boat"  # of an effect whose case names none
# Scenario in which a vessel is driven; that of its own where it has one.
SCENARIOS = {
    "catamaran": "catamaran/turn_20N",
    "eastward_ho": "eastward_ho/rudder_steps",
    "jet_ski": "jet_ski/steady_turn",
    "kvlcc2_mmg": "kvlcc2_mmg/turning_circle_35",
    "martin_tank_model": "martin_tank_model/release",
}
OPEN_LOOP = "otter/turn"  # of all other vessels
# Commands of a vessel that has no scenario of its own: a slow turn.
GOALS = {
    "trial_boat": {"thrust_port_N": 0.6, "thrust_starboard_N": 0.4},
    "kvlcc2": {"delta_rad": 0.1, "n_rps": 11.85},
    "kvlcc2_full_scale": {"n_rpm": 60.0},
    "mariner": {"delta_rad": 0.35},
    "eastward_ho": {"rudder_rad": 0.17},
    "jet_ski": {"throttle": 4.0, "jet_rad": 0.1},
}
STARTS = {
    "kvlcc2": {"u": 1.18},
    "mariner": {"u": 7.7},
}  # [m/s], of a vessel whose model holds near its approach speed only
DURATION = 6.0  # [s] of an example whose case states none
# Errors of a recorded channel that an example applies, by the parameter that differs from zero.
ERRORS = {"gain_fraction": 0.1, "offset": 0.02, "delay": 0.3, "drift": 0.002}

RATES = {"z": "w", "phi": "p", "theta": "q", "psi": "r"}  # coordinate -> its rate on level water


@cache
def all_cases() -> dict[str, Case]:
    """Return the case of every effect of the library by name; effects without one are missing."""
    found = dict(tomllib.loads(FILE.read_text(encoding="utf-8")))
    for name in content.shipped_content_names("effect"):
        kind = content.load_class("effect", name)
        if name not in found and issubclass(kind, SensorError):
            found[name] = _channel_case(kind)
    return found


def _channel_case(kind: type[SensorError]) -> Case:
    """Return the case of one error of one recorded channel."""
    freed = next(name for name, about in kind.params().items() if about.fit)
    signal = kind.column.partition("_")[0]
    over, high = (signal, 0.3)
    if freed in ("drift", "delay"):
        over, high = ("t", 20.0)
    low = 0.0 if over == "t" else -high
    plot = {"over": over, "low": low, "high": high, "shows": [signal]}
    motion = {signal: 0.2}
    if freed == "delay":
        motion[RATES[signal]] = 0.1
    return {"measures": {freed: ERRORS[freed]}, "motion": motion, "see": [signal], "plot": plot}


def vessel_of(case: Case) -> Vessel:
    """Return the vessel of a case without the change by its effect."""
    boat = load_vessel(case.get("vessel", VESSEL), case.get("load", []))
    measured = {name: MeasuredChannel(neutral=x) for name, x in case.get("measured", {}).items()}
    if measured:
        boat = replace(boat, measured=measured)
    return boat.with_parameters(case.get("set", {}))


def changed_vessel(name: str, case: Case) -> Vessel:
    """Return the vessel of a case with the effect added, or with its parameters changed.

    Args:
        name: Name of the effect.
        case: Its case.
    """
    boat = vessel_of(case)
    if "add" in case:
        return boat.with_effect({"use": name, **case["add"]})
    changes = case.get("change", {})
    return boat.with_parameters({case.get("change_of", name): changes})


def measurement_error(name: str, case: Case) -> Effect:
    """Return a measurement effect with the parameters of its case, complete for its vessel."""
    kind = content.load_class("effect", name)
    found: Effect = kind(**case["measures"]).with_all_parameters(vessel_of(case))
    return found
