"""A vessel is data: hull, freedoms, effects with values, command channels, loads, and what a diagnosis may assume."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from pydantic import Field, PositiveFloat

from boatsim.errors import BadInput, unknown_name
from boatsim.files import Table, checked, read_toml
from boatsim.physics.base import Effect
from boatsim.physics.content import find, load_class

Freedom = Literal["surge", "sway", "roll", "yaw"]
Noise = Literal[
    "position_sd_m", "heading_sd_rad", "roll_sd_rad", "speed_sd_mps", "yaw_rate_sd_radps", "roll_rate_sd_radps"
]


class Body(Table):
    """Rigid body about its mass centre, which is the origin of motion."""

    mass: float = Field(gt=0)  # [kg]
    roll_inertia: float = Field(gt=0)  # [kg m^2]
    yaw_inertia: float = Field(gt=0)  # [kg m^2]


class CommandChannel(Table):
    """A command the vessel takes. `family` groups the sides ("thrust", "steer", "pwm")."""

    low: float
    high: float
    family: str
    side: Literal[-1, 0, 1] = 0  # port, middle, starboard
    actuator: bool = True  # False: only feeds an actuator of the same side (PWM feeds thrust)
    turns: Literal["", "starboard", "port"] = ""  # what a positive rudder does; recordings that differ are turned
    about: str = ""


class DiagnosisTable(Table):
    """What a diagnosis may assume of this vessel before it has seen data."""

    suspects: list[str] = []
    ambient: dict[
        Freedom, PositiveFloat
    ] = {}  # tolerated unmodelled force per axis (surge, sway, roll, yaw), rms [N, N m]
    horizon: float = Field(default=6.0, gt=0)  # [s] length of a free run
    rate: float = Field(default=20.0, gt=0)  # [Hz] rows closer together are thinned out: their noise is not independent
    most: int = Field(default=3, ge=1, le=8)  # effects in one answer
    coefficient_uncertainty: dict[
        Literal["damping", "thrust", "restoring"], PositiveFloat
    ] = {}  # relative sd: damping, thrust, restoring
    noise: dict[Noise, PositiveFloat] = {}  # sensor noise where a recording states none


class ManoeuvringTable(Table):
    """How the vessel is handled in a standard manoeuvre; what is left out follows from its channels."""

    ahead: dict[str, float] = {}  # commands of the approach
    astern: dict[str, float] = {}  # commands of a crash stop
    steer: dict[str, float] = {}  # command per rad of helm
    speed: float | None = Field(default=None, gt=0)  # [m/s] at which the approach begins


class VesselFile(Table):
    """The content of a vessel.toml."""

    about: str
    source: str
    based_on: str = ""  # vessel whose folder holds the hull and own effects; set in a patched file
    hull: str = "hull.xml"
    freedoms: list[Freedom]
    length: float = Field(gt=0)  # [m]
    beam: float = Field(gt=0)  # [m]
    draught: float = Field(gt=0)  # [m]
    scale: float | None = Field(default=None, gt=0)  # full scale length / this length
    scales: dict[str, float] = {}  # vessels that are the same hull at another scale
    body: Body
    geometry: dict[str, float] = {}
    channels: dict[str, CommandChannel] = {}
    columns: dict[str, str] = {}  # our name -> the column of this vessel's recordings, "-" in front flips the sign
    effect: list[dict[str, Any]] = []
    loads: dict[str, dict[str, Any]] = {}
    diagnosis: DiagnosisTable = DiagnosisTable()
    manoeuvring: ManoeuvringTable = ManoeuvringTable()


@dataclass(frozen=True)
class Vessel:
    """A vessel in one load condition, its effects ready to compute with."""

    name: str
    path: Path  # its folder
    file: Path  # its vessel.toml
    about: str
    source: str
    hull: str  # file name of the MJCF beside vessel.toml
    freedoms: tuple[str, ...]
    length: float  # [m]
    beam: float  # [m]
    draught: float  # [m]
    body: Body
    geometry: dict[str, float]  # [m], [kg] what the drawing of the hull needs
    commands: dict[str, CommandChannel]
    effects: tuple[Effect, ...]
    load: tuple[str, ...]
    loads: tuple[str, ...]  # names of all loads there are
    diagnosis: DiagnosisTable
    scale: float | None = None  # full scale length / this length
    scales: Mapping[str, float] = field(default_factory=dict)  # vessels that are the same hull at another scale
    columns: Mapping[str, str] = field(default_factory=dict)  # our name -> column of its recordings, "-" flips the sign
    manoeuvring: ManoeuvringTable = ManoeuvringTable()

    @property
    def actuators(self) -> tuple[str, ...]:
        """Channels the force laws see."""
        return tuple(n for n, c in self.commands.items() if c.actuator)

    def effect(self, name: str) -> Effect | None:
        """The vessel's own effect of that name."""
        return next((e for e in self.effects if e.name() == name), None)

    def beside(self, command: str, family: str) -> str | None:
        """The command of another family on the same side."""
        side = self.commands[command].side
        return next((n for n, c in self.commands.items() if c.family == family and c.side == side), None)

    def no_command(self, name: str) -> str:
        """Line for a command this vessel does not take."""
        return unknown_name(f"{self.name}: command", name, self.commands)

    def limits(self) -> dict[str, tuple[float, float]]:
        """Allowed range of each command, as `recording.read` takes it."""
        return {n: (c.low, c.high) for n, c in self.commands.items()}


def load(
    name: str,
    loads: Sequence[str] = (),
    settings: Mapping[str, Mapping[str, Any]] | None = None,
    extra: Sequence[Mapping[str, Any]] = (),
    beside: Path | None = None,
) -> Vessel:
    """A vessel by name or path, in the given loads, with `settings` of its own effects and `extra` effects on top.

    Raises BadInput for names, keys and values that do not exist or are out of bounds.
    """
    path = find("vessel", name, beside)
    called = path.parent.name if path.name == "vessel.toml" else path.stem
    label = f"{path.parent.name}/{path.name}"
    raw = read_toml(path)
    known = checked(VesselFile, raw, label).loads
    for one in loads:
        if one not in known:
            raise BadInput(unknown_name(f"{label}: load", one, known))
    _check_apart(loads, known, label)
    for one in dict.fromkeys(loads):
        raw = _overlaid(raw, known[one], label)
    raw = _overlaid(raw, dict(settings or {}), label)
    file = checked(VesselFile, raw, label)
    own = [table["use"] for table in file.effect if "use" in table]
    for table in extra:
        if table.get("use") in own:
            raise BadInput(
                f"{table['use']} is one of {called}'s own effects; change its values in [set.{table['use']}]"
            )
    folder = _base(file.based_on, path, label)
    vessel = Vessel(
        called, folder, path, file.about, file.source, file.hull, tuple(file.freedoms), file.length, file.beam,
        file.draught, file.body, file.geometry, file.channels, (), tuple(loads), tuple(known), file.diagnosis,
        file.scale, file.scales, file.columns, file.manoeuvring,
    )  # fmt: skip
    return with_effects(with_effects(vessel, file.effect, folder, label), extra, beside or folder)


def _base(name: str, path: Path, label: str) -> Path:
    """Folder of hull and own effects: the vessel file's, or that of the vessel it is based on."""
    try:
        return find("vessel", name, path.parent).parent if name else path.parent
    except BadInput as error:
        raise BadInput(f"{label}: based_on: {error}") from None


def with_effects(vessel: Vessel, tables: Sequence[Mapping[str, Any]], folder: Path, label: str | None = None) -> Vessel:
    """The vessel with the effects of [[effect]] tables of a file added, each completed by those before it."""
    for table in tables:
        vessel = added(vessel, effect_from(table, label or vessel.name, folder))
    return vessel


def added(vessel: Vessel, effect: Effect) -> Vessel:
    """The vessel with one more effect."""
    from dataclasses import replace

    return replace(vessel, effects=(*vessel.effects, effect.completed(vessel)))


def effect_from(table: Mapping[str, Any], file: str, folder: Path) -> Effect:
    """An effect from its [[effect]] table; raises BadInput naming the file."""
    if not isinstance(table.get("use"), str):
        raise BadInput(f"{file}: an [[effect]] needs use = its name")
    try:
        kind: type[Effect] = load_class("effect", table["use"], folder)
        return kind.from_settings({k: v for k, v in table.items() if k != "use"})
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None


def _check_apart(loads: Sequence[str], known: Mapping[str, Mapping[str, Any]], label: str) -> None:
    """Two loads that change the same value contradict each other: which one counts must not depend on their order."""
    changed: dict[str, tuple[str, Any]] = {}
    for one in dict.fromkeys(loads):
        for key, value in _flat(known[one]).items():
            other, before = changed.setdefault(key, (one, value))
            if before != value:
                raise BadInput(
                    f"{label}: loads {other} ({key} = {before}) and {one} ({key} = {value}) exclude each other"
                )


def _flat(table: Mapping[str, Any]) -> dict[str, Any]:
    """`length` and `body.mass` of a load's tables, with their values."""
    inner = {k: v for k, v in table.items() if isinstance(v, Mapping)}
    flat = {k: v for k, v in table.items() if k not in inner}
    return flat | {f"{k}.{name}": v for k, values in inner.items() for name, v in values.items()}


def _overlaid(raw: dict[str, Any], load_table: Mapping[str, Any], label: str) -> dict[str, Any]:
    """A vessel file with a load's tables laid over it: top-level numbers, body, geometry, and effects by name."""
    out = dict(raw)
    effects = [dict(t) for t in raw.get("effect", [])]
    for key, value in load_table.items():
        mine = next((t for t in effects if t.get("use") == key), None)
        if mine is not None:
            mine.update(value)
        elif isinstance(value, dict) and key in ("body", "geometry", "manoeuvring", "diagnosis"):
            out[key] = {**raw.get(key, {}), **value}
        elif key in ("length", "beam", "draught"):
            out[key] = value
        else:
            tables = ("body", "geometry", "manoeuvring", "diagnosis", "length", "beam", "draught")
            names = [*(str(t.get("use")) for t in effects), *tables]
            raise BadInput(unknown_name(f"{label}: table to change", key, names))
    out["effect"] = effects
    return out
