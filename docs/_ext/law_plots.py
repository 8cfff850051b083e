"""Plots of the laws of the effects, by the functions that a simulation uses.

Each effect is plotted with the vessel, the parameters and the range of its case
(`effect_cases.toml`). Angles are in degrees, as a person reads them.
"""

from collections.abc import Callable, Mapping, Sequence
from math import cos, degrees, pi, sin
from typing import Any

import numpy as np
from charts import Axes, Curve, line_chart
from effect_cases import Case, all_cases, changed_vessel, measurement_error, vessel_of

from boatsim.physics import content
from boatsim.physics.base import (
    Array,
    ChannelEffect,
    CoefficientRelease,
    Effect,
    Measurement,
    SignalSegment,
    Wrench,
    make_motion,
)
from boatsim.physics.debugging import python_function
from boatsim.physics.signals import MeasuredMotion
from boatsim.physics.vessel import Vessel

POINTS = 181  # of a curve over a motion or a signal
STEPS = 600  # of a curve over time
LABELS = {  # quantity -> words of its axis, unit
    "u": ("surge velocity u", "m/s"),
    "v": ("sway velocity v", "m/s"),
    "w": ("heave velocity w", "m/s"),
    "p": ("roll rate p", "rad/s"),
    "q": ("pitch rate q", "rad/s"),
    "r": ("yaw rate r", "rad/s"),
    "x": ("position x, north", "m"),
    "y": ("position y, east", "m"),
    "z": ("heave z", "m"),
    "phi": ("roll angle φ", "rad"),
    "theta": ("pitch angle θ", "rad"),
    "psi": ("heading ψ", "rad"),
    "t": ("time t", "s"),
    "thrust": ("thrust T", "N"),
    "moment": ("measured moment K", "N m"),
    "elevation_rate": ("rate of the elevation at the hull", "m/s"),
    "mean_square": ("mean square of the elevation", "m²"),
    "angle": ("steering angle δ", "rad"),
    "bucket": ("bucket angle β", "rad"),
    "shaft": ("shaft rate n", ""),
    "throttle": ("throttle handle", ""),
    "comes_from": ("direction the wind comes from", "rad"),
    "command": ("command x", ""),
    "source": ("raw command", ""),
    "payload": ("additional mass Δm", "kg"),
}
UNITS = {"X": "N", "Y": "N", "Z": "N", "K": "N m", "M": "N m", "N": "N m"}
# Smallest force or moment [N, N m] that is shown in a unit, the unit's size and its prefix.
PREFIXES = ((1e7, 1e6, "M"), (1e4, 1e3, "k"), (0.05, 1.0, ""), (0.0, 1e-3, "m"))
STEP_AT, BACK_AT = 0.15, 0.6  # shares of the time at which a command steps up, and back beyond zero
BACK = -0.6  # share of the first step to which a command steps back


def plot(name: str) -> str:
    """Return the plot of an effect's law as SVG.

    Args:
        name: Name of the effect.
    """
    case = all_cases()[name]
    over = case["plot"]["over"]
    special: Mapping[str, Callable[[Case], str]] = {
        "delay": _delay_plot,
        "wander": _wander_plot,
        "payload": _payload_plot,
    }
    if over in special:
        return special[over](case)
    if over == "frequency":
        return _frequency_plot(name, case)
    kind = content.load_class("effect", name)
    with np.errstate(over="ignore"):  # unsigned integers of the random numbers wrap around
        if issubclass(kind, Measurement):
            return _measurement_plot(name, case)
        if issubclass(kind, ChannelEffect):
            return _channel_plot(name, case)
        return _force_plot(name, case)


def _shown_unit(unit: str) -> tuple[float, str]:
    """Return factor and unit with which a quantity of SI unit is shown."""
    if unit.startswith("rad"):
        return degrees(1.0), f"deg{unit.removeprefix('rad')}"
    return 1.0, unit


def _x_axis(over: str, case: Case, unit: str = "") -> tuple[Array, Array, str]:
    """Return the abscissae in SI units, as shown, and their label."""
    spec = case["plot"]
    count = STEPS if over == "t" else POINTS
    x = np.linspace(spec["low"], spec["high"], count)
    words, own = LABELS[over]
    factor, shown = _shown_unit(own or unit)
    if not own and unit != "rad":  # a shaft turns in rad/s
        factor, shown = 1.0, unit
    label = spec.get("x_label", f"{words} [{shown}]" if shown else words)
    return x, factor * x, label


def _force_axes(curves: Mapping[str, Mapping[str, Array]], x: Array) -> list[Axes]:
    """Return axes of forces and of moments, with a unit that suits their size.

    Args:
        curves: Component -> name of a curve -> values [N] or [N m].
        x: Abscissae.
    """
    axes = []
    for unit in dict.fromkeys(UNITS[component] for component in curves):
        group = {name: by for name, by in curves.items() if UNITS[name] == unit}
        highest = max(float(np.abs(y).max()) for by in group.values() for y in by.values())
        scale, prefix = next((s, p) for least, s, p in PREFIXES if highest >= least)
        drawn = []
        for component, by in group.items():
            for label, y in by.items():
                words = " ".join((component, label)).strip()
                drawn.append(Curve(words, x, y / scale))
        if len(drawn) == 1:
            drawn = [Curve("", x, drawn[0].y)]
        axes.append(Axes(f"{', '.join(group)} [{prefix}{unit}]", drawn))
    return axes


def _force_plot(name: str, case: Case) -> str:
    """Return the plot of a force, of a reaction, of a flow, or of a released coefficient."""
    spec = case["plot"]
    over, shows = spec["over"], spec["shows"]
    kind = content.load_class("effect", name)
    if over != "psi" and spec.get("of") is None and issubclass(kind, CoefficientRelease):
        raise ValueError(f"{name}: its plot needs `of`, the effect whose coefficient it changes")
    laws = _laws(name, case)
    unit = laws[-1][1].roles[over].unit if over in laws[-1][1].roles else ""
    x, shown, label = _x_axis(over, case, unit)
    curves: dict[str, dict[str, Array]] = {key: {} for key in shows}
    for words, effect, vessel in laws:
        values = np.array([_evaluate(effect, vessel, case, over, value) for value in x])
        for key in shows:
            curves[key][words] = values[:, _place(effect, key)]
    about = f"Law of {name}: {', '.join(shows)} over {label}"
    if hasattr(laws[-1][1], "water_velocity"):
        drawn = [Curve(f"{key}_r", shown, curves[key][""]) for key in shows]
        return line_chart([Axes("velocity through the water [m/s]", drawn)], label, about)
    return line_chart(_force_axes(curves, shown), label, about)


def _place(effect: Effect, key: str) -> int:
    """Return the index of a component in the result of `_evaluate`."""
    if hasattr(effect, "water_velocity"):
        return "uv".index(key)
    return Wrench._fields.index(key)


def _laws(name: str, case: Case) -> list[tuple[str, Effect, Vessel]]:
    """Return the effects to plot, with a word for the legend and their vessel."""
    spec = case["plot"]
    if "law" in case and "vessel" not in case:
        kind = content.load_class("effect", name)
        boat = vessel_of(case)
        return [("", kind(**case["add"]), boat)]
    changed = changed_vessel(name, case)
    own = spec.get("of")
    if own is None:
        effect = changed.effect(case.get("change_of", name))
        assert effect is not None, name
        return [("", effect.with_values(spec.get("set", {})), changed)]
    found = []
    for words, vessel in (("as specified", vessel_of(case)), ("changed", changed)):
        effect = vessel.effect(own) or vessel.effects_of_type(own)[0]
        found.append((words, effect.with_values(spec.get("set", {})), vessel))
    return found


def _evaluate(
    effect: Effect, vessel: Vessel, case: Case, over: str, value: float
) -> Sequence[float]:
    """Return the wrench of a law, or the velocity of the hull through the water, at one point."""
    spec = case["plot"]
    kind: Any = type(effect)
    moves, signals = dict(spec.get("at", {})), dict(spec.get("signals", {}))
    carrier = _carrier(effect, vessel, spec)
    if carrier.roles and over in type(carrier).signals_type()._fields:
        signals[over] = value
    else:
        moves[over] = value
    if hasattr(kind, "water_velocity"):
        flow: Any = effect
        moving = make_motion(flow.velocity_at(*map(moves.get, "txy", (0.0, 0.0, 0.0))), **moves)
        return moving.ur, moving.vr
    arguments: list[Any] = [make_motion(**moves), effect.values()]
    if hasattr(kind, "reaction"):
        others = Wrench(X=spec["others"])
        return tuple(python_function(kind.reaction)(arguments[0], others, arguments[1]))
    if carrier.roles:
        arguments.append(type(carrier).signals(**signals))
    if kind.per_instance_of:
        arguments.append(carrier.values())
    if kind.sees_held:
        arguments += [np.zeros(100), 0, 0]
    if kind.sees_table:
        arguments += [np.array([*effect.table(), 0.0]), 0]
    if getattr(kind, "influence", None) is not None:
        other = vessel.effect(spec["on"][1])
        assert other is not None
        second = [type(other).signals(**spec["other"]), other.values()]
        arguments.append(python_function(kind.influence)(*arguments[1:4], *second))
    return tuple(python_function(kind.law)(*arguments))


def _carrier(effect: Effect, vessel: Vessel, spec: Mapping[str, Any]) -> Effect:
    """Return the effect whose signals a law takes: that on which it acts, or the effect itself."""
    kind = type(effect)
    if not kind.per_instance_of:
        return effect
    if "on" in spec:
        host = vessel.effect(spec["on"][0])
        assert host is not None
        return host
    return vessel.effects_of_type(kind.per_instance_of)[0]


def _command(case: Case, t: Array) -> Array:
    """Return a command over time: a step and a step back beyond zero, or a sine."""
    spec = case["plot"]
    if "sine" in spec:
        return spec["amplitude"] * np.sin(2.0 * pi * t / spec["sine"])
    command = np.zeros_like(t)
    command[t >= STEP_AT * t[-1]] = spec["amplitude"]
    command[t >= BACK_AT * t[-1]] = BACK * spec["amplitude"]
    return command


def _channel_plot(name: str, case: Case) -> str:
    """Return the plot of an effect between a command and an actuator."""
    spec = case["plot"]
    changed = changed_vessel(name, case)
    effect: Any = changed.effect(name) or changed.effects_of_type(name)[0]
    factor, unit = 1.0, spec["unit"]
    if unit == "rad":
        factor, unit = _shown_unit(unit)
    x, shown, label = _x_axis(spec["over"], case, spec["unit"])
    curves = []
    if spec["over"] == "t":
        command = _command(case, x)
        output = _outputs(effect, command, np.zeros_like(x), 1.0, float(x[1] - x[0]))
        curves = [Curve("command", shown, factor * command, "reference")]
        curves.append(Curve("output", shown, factor * output, "one"))
    elif spec["over"] == "source":
        command = np.full_like(x, spec.get("command", 0.0))
        curves = [Curve("", shown, factor * _outputs(effect, command, x, 1.0, 0.0))]
    else:
        sides = {"output": 1.0}
        if spec.get("sides"):
            sides = {"port": -1.0, "starboard": 1.0}
        for words, side in sides.items():
            output = _outputs(effect, x, np.zeros_like(x), side, 0.0)
            curves.append(Curve(words, shown, factor * output))
        curves.append(Curve("command", shown, factor * x, "reference"))
    about = f"Law of {name}: output over {label}"
    return line_chart([Axes(f"output y [{unit}]", curves)], label, about)


def _outputs(effect: Any, commands: Array, sources: Array, side: float, step: float) -> Array:
    """Return the output of a channel effect for each command; a step of 0 s keeps no memory."""
    law = python_function(type(effect).transform_signal)
    memory = np.zeros(max(effect.slots, 1))
    values = effect.values()
    output = np.zeros_like(commands)
    for i, (c, source) in enumerate(zip(commands, sources, strict=True)):
        held = SignalSegment(c, c, c)
        output[i] = law(held, side, source, memory, 0, step or 0.01, values).end
        if not step:
            memory[:] = 0.0
    return output


def _measurement_plot(name: str, case: Case) -> str:
    """Return the plot of a recorded signal, or of its error."""
    spec = case["plot"]
    error = measurement_error(name, case)
    x, shown, label = _x_axis(spec["over"], case)
    curves = []
    signal = spec["shows"][0]
    words, own = LABELS[signal]
    factor, unit = _shown_unit(own)
    for signal in spec["shows"]:
        true, recorded = _measured(error, spec["over"], signal, x)
        if spec.get("error"):
            curves.append(Curve(signal, shown, factor * (recorded - true)))
        else:
            curves.append(Curve("recorded", shown, factor * recorded))
            curves.append(Curve("true", shown, factor * true, "reference"))
    title = f"{words} [{unit}]"
    if spec.get("error"):
        title = f"error of {', '.join(spec['shows'])} [{unit}]"
    return line_chart([Axes(title, curves)], label, f"Law of {name}: {title} over {label}")


def _measured(error: Any, over: str, signal: str, x: Array) -> tuple[Array, Array]:
    """Return the true and the recorded values (N,) of a signal of a motion."""
    law = python_function(type(error).apply_measurement_error)
    rates = {"z": "w", "phi": "p", "theta": "q", "psi": "r"}
    true, recorded = np.zeros_like(x), np.zeros_like(x)
    for i, value in enumerate(x):
        given = {over: value}
        time = 0.0
        if over == "t":
            time, swing = value, 2.0 * pi / x[-1] * 2.0
            given = {signal: 0.2 * sin(swing * value)}
            if signal in rates:
                given[rates[signal]] = 0.2 * swing * cos(swing * value)
        moved = MeasuredMotion(*[0.0] * 12)._replace(**given)
        arguments = (moved, time) if type(error).uses_time else (moved,)
        true[i] = getattr(moved, signal)
        recorded[i] = getattr(law(*arguments, error.values()), signal)
    return true, recorded


def _frequency_plot(name: str, case: Case) -> str:
    """Return the plot of a radiation force: damping and added mass over the frequency."""
    spec = case["plot"]
    effect: Any = content.load_class("effect", name)(**case["add"])
    w = np.linspace(spec["low"], spec["high"], POINTS)
    found = effect.response(w)
    damping, mass = spec["units"]
    axes = [
        Axes(f"damping [{damping}]", [Curve("", w, found.real)]),
        Axes(f"added mass [{mass}]", [Curve("", w, found.imag / w)]),
    ]
    label = "frequency of the motion [rad/s]"
    return line_chart(axes, label, f"Law of {name}: damping and added mass over the frequency")


def _delay_plot(case: Case) -> str:
    """Return the plot of a motion that is recorded late."""
    late = case["measures"]["pose_late"]
    t = np.linspace(0.0, 6.0, STEPS)
    curves = [
        Curve("recorded", t, np.sin(t - late), "one"),
        Curve("true", t, np.sin(t), "reference"),
    ]
    about = "A signal and its recording, which is late by the offset of the clocks"
    return line_chart([Axes("signal", curves)], "time t [s]", about)


def _wander_plot(case: Case) -> str:
    """Return the plot of one realisation of a slowly varying position error."""
    spec, given = case["plot"], case["measures"]
    t = np.linspace(spec["low"], spec["high"], STEPS)
    decay = float(np.exp(-(t[1] - t[0]) / given["time"]))
    noise = np.random.default_rng(1).normal(size=(STEPS, 2))
    error = given["position"] * noise
    for i in range(1, STEPS):
        error[i] = decay * error[i - 1] + np.sqrt(1.0 - decay**2) * error[i]
    curves = [Curve("north", t, error[:, 0]), Curve("east", t, error[:, 1])]
    about = "One realisation of the position error of a Gauss-Markov process"
    return line_chart([Axes("error of the position [m]", curves)], "time t [s]", about)


def _payload_plot(case: Case) -> str:
    """Return the plot of the surge acceleration by a constant force over the additional mass."""
    boat = vessel_of(case)
    added = boat.effect("added_mass")
    inertia = boat.body.mass + getattr(added, "surge", 0.0)
    mass = np.linspace(case["plot"]["low"], case["plot"]["high"], POINTS)
    words, unit = LABELS["payload"]
    curves = [Curve("", mass, 1.0 / (inertia + mass))]
    about = "Surge acceleration by a force of 1 N over the additional mass"
    title = "surge acceleration by 1 N [m/s²]"
    return line_chart([Axes(title, curves)], f"{words} [{unit}]", about)
