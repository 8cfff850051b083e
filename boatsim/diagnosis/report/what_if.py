"""The section of a report that repeats free runs in the browser while sliders move."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from boatsim.diagnosis.answer.families import FAMILIES
from boatsim.diagnosis.answer.schema import Family
from boatsim.physics.base import Array
from boatsim.view.formatting import IN_DEGREES, STEPS, convenient_unit, format_number, format_unit
from boatsim.webassembly.packing import PackedNumbers

SCRIPT = Path(__file__).parent / "templates" / "what_if.js"
STYLE = Path(__file__).parent / "templates" / "what_if.css"
TOO_LARGE = (
    "This report has no sliders, because with a single free run it would be larger than 1 MB."
)
LAYOUT_BYTES = 40_000  # of the section without its content: script, template, escaped characters
SIGNAL_WORDS = {  # column -> what its plot shows, and its SI unit
    "x_m": ("position x", "m"),
    "y_m": ("position y", "m"),
    "z_m": ("heave, down", "m"),
    "phi_rad": ("roll", "rad"),
    "theta_rad": ("pitch", "rad"),
    "psi_rad": ("heading", "rad"),
}
ABOUT = (
    "Move a slider, or switch an effect off: the simulation of the recording is repeated at once, "
    "with the recorded commands alone. Every run begins with the state that the corrected vessel "
    "model estimates there, so that the errors as found are those of this report, and other errors "
    "differ by the physics alone."
)


@dataclass(frozen=True)
class Slider:
    """A parameter of a vessel model that a slider changes.

    Attributes:
        words: What it is.
        unit: SI unit; "" for a ratio.
        low: Lower end of the slider.
        high: Upper end of the slider.
        off: Value without the effect; 1 for a coefficient.
        found: Fitted value.
        at: Places in the parameter values of the program.
        how: "sets", "scales" or "shifts" the values there.
        weights: Weight of a shift at each place.
        group: Group of recordings in which alone it acts; "" for all.
    """

    words: str
    unit: str
    low: float
    high: float
    off: float
    found: float
    at: tuple[int, ...]
    how: str
    weights: tuple[float, ...]
    group: str


@dataclass(frozen=True)
class AdjustableEffect:
    """An effect whose parameters sliders change, or refitted coefficients of the vessel file.

    Attributes:
        name: Name in words.
        words: Its meaning.
        found: Whether the corrected vessel has it.
        coefficients: Whether these are coefficients, which always act.
        switch: Place among the switches of the program; -1 if it has none.
        parameters: Its sliders.
    """

    name: str
    words: str
    found: bool
    coefficients: bool
    switch: int
    parameters: tuple[Slider, ...]


@dataclass(frozen=True)
class InstrumentDrift:
    """Drift of an instrument that decays from the start of each free run.

    Attributes:
        switch: Place of its effect among the switches of the program.
        time: Place of its decay time [s] in the parameter values.
        offsets: (runs, NQ) drift of the coordinates at the start of each run [m, rad].
    """

    switch: int
    time: int
    offsets: Array


@dataclass(frozen=True)
class ReplayedRecording:
    """A held-out recording, with what its free runs need.

    Attributes:
        name: Name of the recording.
        groups: Groups of recordings to which it belongs.
        times: (N,) times of the rows [s].
        command_times: (M,) times at which commands change [s].
        commands: (M, inputs) commands from then on.
        measured: Recorded coordinates (N,) [m, rad] by column.
        values: Parameter values of the program for the vessel file.
        starts: First row of each free run.
        ends: Last row of each free run.
        states: (runs, 2 NQ) state at the start of each run.
        drifts: Drifts of instruments.
    """

    name: str
    groups: tuple[str, ...]
    times: Array
    command_times: Array
    commands: Array
    measured: Mapping[str, Array]
    values: Array
    starts: tuple[int, ...]
    ends: tuple[int, ...]
    states: Array
    drifts: tuple[InstrumentDrift, ...]

    def first_runs(self, count: int) -> "ReplayedRecording":
        """Return the recording up to the end of some of its free runs.

        Args:
            count: Number of free runs, at least one.
        """
        rows = self.ends[count - 1] + 1
        changes = int(np.searchsorted(self.command_times, self.times[rows - 1], side="right"))
        return replace(
            self,
            times=self.times[:rows],
            command_times=self.command_times[: max(changes, 1)],
            commands=self.commands[: max(changes, 1)],
            measured={name: signal[:rows] for name, signal in self.measured.items()},
            starts=self.starts[:count],
            ends=self.ends[:count],
            states=self.states[:count],
            drifts=tuple(replace(d, offsets=d.offsets[:count]) for d in self.drifts),
        )


@dataclass(frozen=True)
class WhatIf:
    """A vessel's program for a browser, with the effects that sliders change.

    Attributes:
        program: WebAssembly module, from `boatsim.webassembly`.
        nq: Number of degrees of freedom.
        signals: Index of each recorded coordinate among the channels of the program, by column.
        horizon: Length of a free run [s].
        max_step: Longest integration step [s].
        effects: Coefficients, effects that were found and other candidates, in the order in which
            they write their values.
        links: Places in the parameter values that inherit a value, and of that value.
        switches: (effects,) switches of the program without any candidate.
        families: Signals whose deviations have one rms error, by key of `fit` in diagnosis.json.
        recordings: Held-out recordings.
    """

    program: bytes
    nq: int
    signals: Mapping[str, int]
    horizon: float
    max_step: float
    effects: tuple[AdjustableEffect, ...]
    links: tuple[tuple[int, int], ...]
    switches: Array
    families: Mapping[Family, Sequence[str]]
    recordings: tuple[ReplayedRecording, ...]


def template_values(what_if: WhatIf, runs: int) -> dict[str, object]:
    """Return the values that the template of the section uses.

    Args:
        what_if: Program, effects and recordings.
        runs: Number of free runs over all held-out recordings, of which it may have fewer.
    """
    numbers = PackedNumbers()
    content = _content(what_if, numbers)
    families = [FAMILIES[family][0] for family in what_if.families]
    others = [e for e in what_if.effects if not e.found and not e.coefficients]
    track = {"x_m", "y_m"} <= what_if.signals.keys()
    plots = []
    for name in what_if.signals:
        if track and name in ("x_m", "y_m"):
            continue
        plots.append((name, _title(what_if, name)))
    kept, cut = sum(len(one.starts) for one in what_if.recordings), ""
    if kept < runs:
        cut = f"So that this page stays below 1 MB, it has the first {kept} of {runs} free runs."
    return {
        "about": ABOUT,
        "cut": cut,
        "style": STYLE.read_text(encoding="utf-8"),
        "horizon": format_number(what_if.horizon),
        "families": families,
        "track": track,
        "plots": plots,
        "any_found": any(e.found and not e.coefficients for e in what_if.effects),
        "any_coefficients": any(e.coefficients for e in what_if.effects),
        "any_others": bool(others),
        "content": content,
        "numbers": numbers.text,
    }


def within_size(what_if: WhatIf, size: int) -> WhatIf | None:
    """Return a section whose content takes at most some bytes, with fewer free runs if needed.

    Args:
        what_if: Program, effects and recordings.
        size: Largest size of its content [bytes].

    Returns:
        The section with the first free runs that fit; None if not a single one fits.
    """
    left = size - _content_size(replace(what_if, recordings=()))
    kept = list[ReplayedRecording]()
    for recording in what_if.recordings:
        shown = _recording_within_size(what_if, recording, left)
        if shown is None:
            break
        kept.append(shown)
        if shown is not recording:
            break
        left -= _recording_size(what_if, recording)
    return replace(what_if, recordings=tuple(kept)) if kept else None


def _recording_within_size(
    what_if: WhatIf, recording: ReplayedRecording, size: int
) -> ReplayedRecording | None:
    """Return a recording with as many free runs as fit; None if not a single one fits."""
    most = len(recording.starts)
    if _recording_size(what_if, recording) <= size:
        return recording
    low, high = 0, most - 1  # numbers of free runs that fit, and that may fit
    while low < high:
        middle = (low + high + 1) // 2
        if _recording_size(what_if, recording.first_runs(middle)) <= size:
            low = middle
        else:
            high = middle - 1
    return recording.first_runs(low) if low else None


def _recording_size(what_if: WhatIf, recording: ReplayedRecording) -> int:
    """Size of a recording in the page [bytes]: compressed alone it is not smaller."""
    alone = replace(what_if, program=b"", effects=(), recordings=(recording,))
    return _content_size(alone)


def _content_size(what_if: WhatIf) -> int:
    numbers = PackedNumbers()
    content = _content(what_if, numbers)
    return len(numbers.text) + len(json.dumps(content))


def _content(what_if: WhatIf, numbers: PackedNumbers) -> dict[str, Any]:
    """Return what the script reads as JSON; arrays are places in the packed numbers."""
    recordings = []
    for one in what_if.recordings:
        drifts = []
        for drift in one.drifts:
            entry = {"switch": drift.switch, "time": drift.time, "offsets": drift.offsets.tolist()}
            drifts.append(entry)
        recordings.append(
            {
                "name": one.name,
                "groups": one.groups,
                "times": numbers.place(one.times),
                "command_times": numbers.place(one.command_times),
                "commands": numbers.place(one.commands),
                "measured": {name: numbers.place(x) for name, x in one.measured.items()},
                "values": numbers.place(one.values),
                "starts": one.starts,
                "ends": one.ends,
                "states": numbers.place(one.states),
                "drifts": drifts,
            }
        )
    quantities = {}
    for name in what_if.signals:
        unit, factor = _signal_unit(what_if, name)
        quantities[name] = {"unit": unit, "factor": factor}
    families = []
    for family, signals in what_if.families.items():
        families.append({"signals": signals, "units": _units(FAMILIES[family][1])})
    return {
        "nq": what_if.nq,
        "signals": dict(what_if.signals),
        "max_step": what_if.max_step,
        "switches": what_if.switches.tolist(),
        "links": what_if.links,
        "effects": [_effect_content(effect) for effect in what_if.effects],
        "families": families,
        "quantities": quantities,
        "recordings": recordings,
        "program": numbers.place_program(what_if.program),
    }


def _effect_content(effect: AdjustableEffect) -> dict[str, Any]:
    """Return an effect with its sliders as JSON."""
    parameters = []
    for slider in effect.parameters:
        parameters.append(
            {
                "words": slider.words,
                "units": _units(slider.unit),
                "low": slider.low,
                "high": slider.high,
                "off": slider.off,
                "found": slider.found,
                "at": slider.at,
                "how": slider.how,
                "weights": slider.weights,
                "group": slider.group,
            }
        )
    return {
        "name": effect.name,
        "words": effect.words,
        "found": effect.found,
        "coefficients": effect.coefficients,
        "switch": effect.switch,
        "parameters": parameters,
    }


def _units(unit: str) -> list[tuple[float, str, float]]:
    """Return convenient units of a quantity, the largest first.

    Each has the smallest size [SI unit] from which it is used, its name, and its value per SI unit.
    """
    steps = STEPS.get(unit)
    if steps is None or unit in IN_DEGREES:
        name, factor = convenient_unit(unit, 1.0)
        return [(0.0, format_unit(name), factor)]
    return [(least, format_unit(name), 1.0 / size) for least, size, name in steps]


def _signal_unit(what_if: WhatIf, name: str) -> tuple[str, float]:
    """Return the unit in which a coordinate is plotted, and its value per SI unit."""
    largest = 0.0
    for recording in what_if.recordings:
        recorded = recording.measured.get(name, np.zeros(0))
        finite = recorded[np.isfinite(recorded)]
        largest = max([largest, *np.abs(finite).tolist()])
    return convenient_unit(SIGNAL_WORDS[name][1], largest)


def _title(what_if: WhatIf, name: str) -> str:
    unit, _ = _signal_unit(what_if, name)
    return f"{SIGNAL_WORDS[name][0]} [{unit}]"
