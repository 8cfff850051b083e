"""A vessel is data: hull, freedoms, effects with values, channels, loads, and what a diagnosis may assume."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from math import inf
from pathlib import Path
from typing import Literal, Self

from pydantic import Field, PositiveFloat, field_validator, model_validator

from boatsim.errors import BadInput, unknown_name
from boatsim.files import Table, checked, read_toml, tables
from boatsim.physics.content import find, load_class
from boatsim.physics.facts import wrong
from boatsim.physics.kernel.equations import tilts
from boatsim.physics.kinds.channel import Channel
from boatsim.physics.kinds.effect import Effect
from boatsim.physics.kinds.release import Change, Release
from boatsim.physics.signals import COMPONENTS, POSE, RATES
from boatsim.physics.spread import Spread, SpreadTable

SMALLEST, LARGEST = 1e-4, 1e4  # [m] of a hull
Freedom = Literal[
    "surge", "sway", "heave", "roll", "pitch", "yaw"
]  # AXES, as a type checker reads it


class Body(Table):
    """Rigid body; inertia about its mass centre, which is the origin of motion unless `centre` says otherwise."""

    mass: float = Field(gt=0)  # [kg]
    roll_inertia: float = Field(gt=0)  # [kg m^2]
    yaw_inertia: float = Field(gt=0)  # [kg m^2]
    pitch_inertia: float | None = Field(
        default=None, gt=0
    )  # [kg m^2]; needed where the hull pitches
    centre: tuple[float, float] = (0.0, 0.0)  # [m] ahead of the origin and below it

    def pitched(self) -> float:
        """Inertia in pitch; of a hull that does not pitch it is that in yaw, so that rolling turns nothing else."""
        return (
            max(self.roll_inertia, self.yaw_inertia)
            if self.pitch_inertia is None
            else self.pitch_inertia
        )


class CommandChannel(Table):
    """A command the vessel takes."""

    low: float
    high: float
    # in force where nothing is sent; a channel that can not be 0 must say its own
    neutral: float = 0.0
    # what a positive rudder does; recordings that differ are turned
    turns: Literal["", "starboard", "port"] = ""
    about: str = ""


class MeasuredChannel(Table):
    """What is measured of the boat's surroundings: known where it was recorded, and nobody's command."""

    neutral: float = 0.0  # in force in a simulation whose scenario says nothing of it
    about: str = ""


NAME = re.compile(r"[\w.+-]{1,60}")  # of a channel: it is a column of every log
FORCES = tuple(
    f"{what}_{component}" for what in ("force", "wind") for component in COMPONENTS.values()
)
OURS = ("t_s", "contacts", *POSE, *RATES, *FORCES)
PREFIXES = (
    "sent_",
    "actual_",
    "sensed_",
    "camera_",
    "estimate_",
    "reference_",
    "goal_",
)  # of other columns
OVERRIDES = (
    "ambient",
    "horizon",
    "rate",
    "noise",
)  # of the rules of a diagnosis, which need a reason


class DiagnosisTable(Table):
    """What a diagnosis may assume of this vessel before it has seen data."""

    leave_out: dict[str, str] = {}  # entry of the library that is not tried -> the reason, in words
    also: list[
        dict[str, object]
    ] = []  # tables as in [[effect]], tried beside the library: on what else it may act
    coefficient_uncertainty: dict[
        Literal["damping", "thrust", "added_mass", "restoring", "wind"], PositiveFloat
    ] = {}  # relative sd
    # In place of a rule of `boatsim.diagnosis.priors`, each with its reason in `reasons`
    ambient: dict[Freedom, PositiveFloat] = {}  # tolerated unmodelled force per axis, rms [N, N m]
    horizon: float | None = Field(default=None, gt=0)  # [s] length of a free run
    rate: float | None = Field(default=None, gt=0)  # [Hz] of rows that are used
    noise: dict[str, PositiveFloat] = {}  # sd of instruments by family
    reasons: dict[str, str] = {}
    facts: dict[
        str, float | str | bool | list[float]
    ] = {}  # what holds where a recording states nothing else: walls_m

    @field_validator("facts")
    @classmethod
    def _readable(cls, facts: dict[str, object]) -> dict[str, object]:
        if found := wrong(facts):
            raise ValueError(f"{found[0]} = {facts[found[0]]!r}; allowed is {found[1]}")
        return facts

    @model_validator(mode="after")
    def _reasoned(self) -> Self:
        for key in OVERRIDES:
            if getattr(self, key) and not self.reasons.get(key):
                raise ValueError(f"{key} takes the place of a rule; say why in reasons.{key}")
        return self


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
    found: list[str] = []  # names of those effects that a diagnosis found; set in a patched file
    spread: SpreadTable = SpreadTable()  # how far off what was fitted may be; set in a patched file
    hull: str = "hull.xml"
    freedoms: list[Freedom]
    length: float = Field(ge=SMALLEST, le=LARGEST)  # [m]
    beam: float = Field(ge=SMALLEST, le=LARGEST)  # [m]
    draught: float = Field(ge=SMALLEST, le=LARGEST)  # [m]
    scale: float | None = Field(default=None, gt=0)  # full scale length / this length
    scales: dict[str, float] = {}  # vessels that are the same hull at another scale
    body: Body
    geometry: dict[str, float] = {}
    marks: dict[
        str, tuple[float, float]
    ] = {}  # [m] ahead and to starboard of the CG: what a camera above follows
    channels: dict[str, CommandChannel] = {}
    measured: dict[str, MeasuredChannel] = {}
    columns: dict[
        str, str
    ] = {}  # our name -> the column of this vessel's recordings, "-" in front flips the sign
    effect: list[dict[str, object]] = []
    loads: dict[str, dict[str, object]] = {}
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
    dof: tuple[str, ...]
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
    # vessels that are the same hull at another scale
    scales: Mapping[str, float] = field(default_factory=dict)
    # our name -> column of its recordings, "-" flips the sign
    columns: Mapping[str, str] = field(default_factory=dict)
    manoeuvring: ManoeuvringTable = ManoeuvringTable()
    # [m] ahead and to starboard of the CG
    marks: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    found: tuple[str, ...] = ()  # names of those effects that a diagnosis found
    # of the surroundings: taken, not commanded
    measured: Mapping[str, MeasuredChannel] = field(default_factory=dict)
    # how far off what was fitted may be, where one was
    spread: Spread | None = field(default=None, compare=False)

    @property
    def inputs(self) -> tuple[str, ...]:
        """All that its program takes row by row: commands, then what is measured of the surroundings."""
        return (*self.commands, *self.measured)

    @property
    def actuators(self) -> tuple[str, ...]:
        """Channels that laws see: those bound to a role of an effect. The others only feed them (PWM feeds thrust)."""
        return tuple(n for n in self.commands if n in self.roles)

    @property
    def readings(self) -> tuple[str, ...]:
        """Measured channels that laws see, as they are: those bound to a role of an effect."""
        return tuple(n for n in self.measured if n in self.roles)

    @cached_property
    def roles(self) -> Mapping[str, str]:
        """Channel -> the role in which an effect takes it first."""
        found: dict[str, str] = {}
        for effect in self.effects:
            for role, channel in self.stated(effect).items():
                if isinstance(channel, str):
                    found.setdefault(channel, role)
        return found

    @cached_property
    def angles(self) -> tuple[str, ...]:
        """Actuators that are angles: laws see their cosine and sine too."""
        return tuple(n for n in self.actuators if self.unit(n) == "rad")

    @cached_property
    def bearings(self) -> tuple[str, ...]:
        """Measured channels that are angles: laws see their cosine and sine too."""
        return tuple(n for n in self.readings if self.unit(n) == "rad")

    @cached_property
    def held(self) -> tuple[str, ...]:
        """What laws see of its actuators: themselves, then cosine and sine of angles; then of its readings the same."""
        pairs = ((self.actuators, self.angles), (self.readings, self.bearings))
        parts = (
            (*all_of, *(f"{part}_{a}" for a in angles for part in ("cos", "sin")))
            for all_of, angles in pairs
        )
        return tuple(n for names in parts for n in names)

    @cached_property
    def sums(self) -> Mapping[str, tuple[str, ...]]:
        """Actuators that several share a role, by the role: together they are the `thrust`, whatever each is called."""
        alike = {
            role: tuple(n for n in self.actuators if self.roles[n] == role)
            for role in self.roles.values()
        }
        return {
            role: names
            for role, names in alike.items()
            if len(names) > 1 and role not in self.inputs
        }

    @property
    def seen(self) -> tuple[str, ...]:
        """What described laws see of its actuators: what is held, then the sums."""
        return (*self.held, *self.sums)

    def unit(self, channel: str) -> str:
        """Unit of an actuator, a reading or a sum: that of the role in which an effect takes it."""
        channel = self.sums.get(channel, (channel,))[0]
        units = (
            type(e).roles[r].unit
            for e in self.effects
            for r, c in self.stated(e).items()
            if c == channel
        )
        return next(units, "")

    def effect(self, name: str) -> Effect | None:
        """The vessel's own effect of that name, or the only one of that idea."""
        named = next((e for e in self.effects if e.name == name), None)
        alike = [e for e in self.effects if type(e).idea() == name]
        return named or (alike[0] if len(alike) == 1 else None)

    def known_as(self, name: str) -> list[str]:
        """Names of the vessel's own effects that a word means: the one called so, or all of that idea."""
        return [e.name for e in self.effects if name in (e.name, type(e).idea())]

    def all_of(self, idea: str) -> list[Effect]:
        """The vessel's own effects that are one idea, by name or besides their own, in the order of its file."""
        return [e for e in self.effects if type(e).idea() == idea or hasattr(type(e), f"as_{idea}")]

    @staticmethod
    def stated(effect: Effect) -> Mapping[str, str | float]:
        """What an effect's own table binds its roles to: a channel's name, or a number that is held."""
        return effect.on if isinstance(effect.on, Mapping) else {}

    def bound(self, effect: Effect) -> dict[str, str | float]:
        """What each role of an effect is bound to: as stated; if nothing is, the vessel's only channel in the role.

        A role that may be left out stays unbound: a fixed thruster does not turn with the only rudder.
        """
        found = dict(self.stated(effect))
        needed = [
            role
            for role, about in type(effect).roles.items()
            if about.fixed is None and not self.stated(effect)
        ]
        for role in needed:
            there = [n for n in self.actuators if self.roles[n] == role]
            if len(there) == 1:
                found[role] = there[0]
        return found

    def ridden(self, effect: Effect) -> list[Effect]:
        """The instances that an effect rides on: those it names, else all of the idea."""
        there = self.all_of(type(effect).rides)
        return [e for e in there if not effect.on or e.name in effect.on]

    def targets(self, effect: Effect) -> tuple[str, ...]:
        """Actuators that a channel effect acts on: those it names, else all in its role."""
        if not isinstance(effect, Channel):
            return ()
        if effect.on:
            return tuple(n for n in self.actuators if n in effect.on)
        roles = type(effect).acts_on.split("|")
        return tuple(n for n in self.actuators if roles == [""] or self.roles[n] in roles)

    def feeder(self, effect: Effect, actuator: str) -> str | None:
        """The command that feeds an actuator through a channel effect: its `fed_by` in the actuator's place."""
        if not isinstance(effect, Channel) or actuator not in effect.on:
            return None
        return dict(zip(effect.on, effect.fed_by, strict=False)).get(actuator)

    def side(self, channel: str) -> int:
        """-1 port, +1 starboard, 0 middle: where what a channel drives, itself or through another, is mounted."""
        for effect in self.effects:
            if channel in self.stated(effect).values():
                y = float(getattr(effect, "y", 0.0))
                return int(y > 0.0) - int(y < 0.0)
        fed = [a for e in self.effects for a in self.targets(e) if self.feeder(e, a) == channel]
        return self.side(fed[0]) if fed else 0

    def no_command(self, name: str) -> str:
        """Line for a command this vessel does not take."""
        return unknown_name(f"{self.name}: command", name, self.commands)

    def limits(self) -> dict[str, tuple[float, float]]:
        """Allowed range of each input, as `recording.read` takes it; what is measured may be anything."""
        return {n: (c.low, c.high) for n, c in self.commands.items()} | dict.fromkeys(
            self.measured, (-inf, inf)
        )

    def measuring(self, values: Mapping[str, float]) -> Self:
        """The vessel in surroundings that are measured so, and stay so where nothing else is recorded.

        Raises BadInput for a channel that it does not measure.
        """
        for name in values:
            if name not in self.measured:
                raise BadInput(unknown_name(f"{self.name}: measured", name, self.measured))
        told = {
            n: m.model_copy(update={"neutral": values.get(n, m.neutral)})
            for n, m in self.measured.items()
        }
        return replace(self, measured=told)


def load(
    name: str,
    loads: Sequence[str] = (),
    settings: Mapping[str, Mapping[str, object]] | None = None,
    extra: Sequence[Mapping[str, object]] = (),
    beside: Path | None = None,
) -> Vessel:
    """A vessel by name or path, in the given loads, with `settings` of its own effects and `extra` effects on top.

    Raises BadInput for names, keys and values that do not exist or are out of bounds.
    """
    path = find("vessel", name, beside)
    called = path.parent.name if path.name == "vessel.toml" else path.stem
    label = f"{path.parent.name}/{path.name}"
    raw: Mapping[str, object] = read_toml(path)
    known = checked(VesselFile, raw, label).loads
    for one in loads:
        if one not in known:
            raise BadInput(unknown_name(f"{label}: load", one, known))
    _check_apart(loads, known, label)
    for one in dict.fromkeys(loads):
        raw = overlaid(raw, known[one], label)
    raw = overlaid(raw, dict(settings or {}), label)
    file = checked(VesselFile, raw, label)
    _check_channels(file.channels, label)
    if twice := [n for n in file.measured if n in file.channels]:
        raise BadInput(
            f"{label}: measured.{twice[0]} is among the [channels] too; it is either sent or measured"
        )
    own = [_called(table) for table in file.effect]
    for table in extra:
        if _called(table) in own:
            raise BadInput(
                f"{_called(table)} is one of {called}'s own effects; change its values in [set.{_called(table)}], or "
                "give the further one a name of its own"
            )
    folder = _base(file.based_on, path, label)
    vessel = Vessel(
        called,
        folder,
        path,
        file.about,
        file.source,
        file.hull,
        tuple(file.freedoms),
        file.length,
        file.beam,
        file.draught,
        file.body,
        file.geometry,
        file.channels,
        (),
        tuple(loads),
        tuple(known),
        file.diagnosis,
        file.scale,
        file.scales,
        file.columns,
        file.manoeuvring,
        file.marks,
        tuple(file.found),
        file.measured,
        Spread.read(file.spread),
    )
    whole = with_effects(with_effects(vessel, file.effect, folder, label), extra, beside or folder)
    check_bindings(whole, label)
    if "pitch" in whole.dof and whole.body.pitch_inertia is None:
        raise BadInput(f"{label}: body.pitch_inertia is missing; {called} pitches")
    if whole.body.centre[1] and "roll" in whole.dof and not tilts(frozenset(whole.dof)):
        raise BadInput(
            f"{label}: body.centre = {whole.body.centre}; allowed is a height of 0 where pitch is held"
        )
    return whole


def _check_channels(channels: Mapping[str, CommandChannel], label: str) -> None:
    """Every channel has a range, and its neutral lies within."""
    for name, c in channels.items():
        if not NAME.fullmatch(name) or name in OURS or name.startswith(PREFIXES):
            why = (
                "columns of a run are called so"
                if NAME.fullmatch(name)
                else "allowed are letters, digits and _ . + -"
            )
            raise BadInput(f"{label}: channels: {name!r} can not be the name of one: {why}")
        if not c.low < c.high:
            raise BadInput(
                f"{label}: channels.{name}: low = {c.low:g}, high = {c.high:g}; low must be below high"
            )
        if not c.low <= c.neutral <= c.high:
            given = "neutral" in c.model_fields_set
            what = f"neutral = {c.neutral:g}" if given else "neutral is missing and can not be 0"
            raise BadInput(f"{label}: channels.{name}: {what}; allowed {c.low:g} to {c.high:g}")


def _called(table: Mapping[str, object]) -> str:
    """Name of the instance that an [[effect]] table makes."""
    return str(table.get("name", table.get("use")))


def check_bindings(vessel: Vessel, label: str) -> None:
    """Every effect has a name of its own and finds what it acts on. Raises BadInput."""
    names = [e.name for e in vessel.effects]
    for effect in vessel.effects:
        what = f"{label}: effect {effect.name}"
        if names.count(effect.name) > 1:
            raise BadInput(
                f"{what} is there {names.count(effect.name)} times; give each a name of its own"
            )
        _check_roles(vessel, effect, what)
        kind = type(effect)
        if kind.sees_held and not effect.still_as_on(vessel):
            raise BadInput(
                f"{what} stands before an effect by which a channel acts; put it behind all of these"
            )
        if isinstance(effect, Channel):
            for name in (*effect.on, *effect.fed_by):
                if name not in vessel.commands:
                    raise BadInput(unknown_name(f"{what}: channel", name, vessel.commands))
            if effect.fed_by and len(effect.fed_by) != len(effect.on):
                raise BadInput(
                    f"{what}: fed_by names {len(effect.fed_by)} channels, on {len(effect.on)}; each needs one"
                )
        elif kind.rides:
            there = [e.name for e in vessel.all_of(kind.rides)]
            for name in effect.on:
                if name not in there:
                    raise BadInput(unknown_name(f"{what}: {kind.rides}", name, there))
            if not there:
                raise BadInput(f"{what} needs a vessel with {kind.rides}")


def _check_roles(vessel: Vessel, effect: Effect, what: str) -> None:
    """Roles that exist, bound to channels that exist, none left out that is needed."""
    roles, stated = type(effect).roles, vessel.stated(effect)
    for role, channel in stated.items():
        if role not in roles:
            raise BadInput(unknown_name(f"{what}: on", role, roles))
        if isinstance(channel, str) and channel not in vessel.inputs:
            raise BadInput(unknown_name(f"{what}: on.{role} channel", channel, vessel.inputs))
    for role, about in roles.items():
        if role not in vessel.bound(effect) and about.fixed is None:
            there = ", ".join(vessel.inputs)
            raise BadInput(
                f"{what}: on.{role} is missing: the channel of {about.words}; there are: {there}"
            )


def _base(name: str, path: Path, label: str) -> Path:
    """Folder of hull and own effects: the vessel file's, or that of the vessel it is based on."""
    try:
        return find("vessel", name, path.parent).parent if name else path.parent
    except BadInput as error:
        raise BadInput(f"{label}: based_on: {error}") from None


def with_effects(
    vessel: Vessel, tables: Sequence[Mapping[str, object]], folder: Path, label: str | None = None
) -> Vessel:
    """The vessel with the effects of [[effect]] tables of a file added, each completed by those before it."""
    for table in tables:
        vessel = added(vessel, effect_from(table, label or vessel.name, folder))
    return vessel


def added(vessel: Vessel, effect: Effect) -> Vessel:
    """The vessel with one more effect; a release changes the numbers it names, now."""
    try:
        effect = effect.completed(vessel)
    except (
        ArithmeticError,
        ValueError,
    ) as error:  # a rule divides by what is 0, or takes a root of what is below it
        raise BadInput(
            f"{vessel.name}: {effect.name}: no number follows from what is stated ({error})"
        ) from None
    if not isinstance(effect, Release):
        return replace(vessel, effects=(*vessel.effects, effect))
    for change in effect.changes(vessel):
        vessel = _changed(vessel, change, getattr(effect, change.parameter))
    return vessel


def _changed(vessel: Vessel, change: Change, value: float) -> Vessel:
    """The vessel with one number changed, and with it what nobody stated and follows it."""
    if change.owner == "body":
        new = change.of(getattr(vessel.body, change.key), value)
        if new <= 0.0:
            raise BadInput(f"{vessel.name}: body.{change.key} = {new:g}; allowed is more than 0")
        vessel = replace(vessel, body=vessel.body.model_copy(update={change.key: new}))
        source = f"vessel.body.{change.key}"
    else:
        new = change.of(getattr(vessel.effect(change.owner), change.key), value)
        source = f"{change.owner}.{change.key}"
    effects = []
    for e in vessel.effects:
        follows = {n: type(e).params()[n].follows.removesuffix("?") for n in e.filled}
        keys = [n for n, place in follows.items() if place == source]
        own = [change.key] if e.name == change.owner else []
        effects.append(e.having(dict.fromkeys([*keys, *own], new)))
    return replace(vessel, effects=tuple(effects))


def effect_from(table: Mapping[str, object], file: str, folder: Path) -> Effect:
    """An effect from its [[effect]] table; raises BadInput naming the file."""
    use = table.get("use")
    if not isinstance(use, str):
        raise BadInput(f"{file}: an [[effect]] needs use = its name")
    try:
        kind: type[Effect] = load_class("effect", use, folder)
        return kind.from_settings({k: v for k, v in table.items() if k != "use"})
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None


def with_loads(
    name: str, loads: Sequence[str], more: Sequence[str], beside: Path | None = None
) -> list[str]:
    """Load conditions with `more` on top of them: those that exclude one of these give way. Raises BadInput."""
    path = find("vessel", name, beside)
    label = f"{path.parent.name}/{path.name}"
    known = checked(VesselFile, read_toml(path), label).loads
    for one in more:
        if one not in known:
            raise BadInput(unknown_name(f"{label}: load", one, known))
    kept = [
        one
        for one in loads
        if one in known and not any(_clash(known[one], known[new]) for new in more)
    ]
    return list(dict.fromkeys((*kept, *more)))


def _check_apart(
    loads: Sequence[str], known: Mapping[str, Mapping[str, object]], label: str
) -> None:
    """Two loads that change the same value contradict each other: which one counts must not depend on their order."""
    for first, second in combinations(dict.fromkeys(loads), 2):
        for key, (one, other) in _clash(known[first], known[second]).items():
            raise BadInput(
                f"{label}: loads {first} ({key} = {one}) and {second} ({key} = {other}) exclude each other"
            )


def _clash(
    one: Mapping[str, object], other: Mapping[str, object]
) -> dict[str, tuple[object, object]]:
    """What two loads set to different values."""
    mine, theirs = _flat(one), _flat(other)
    return {
        key: (mine[key], theirs[key]) for key in mine if key in theirs and mine[key] != theirs[key]
    }


def _flat(table: Mapping[str, object]) -> dict[str, object]:
    """`length` and `body.mass` of a load's tables, with their values."""
    inner = {k: v for k, v in table.items() if isinstance(v, Mapping)}
    flat = {k: v for k, v in table.items() if k not in inner}
    return flat | {f"{k}.{name}": v for k, values in inner.items() for name, v in values.items()}


def overlaid(
    raw: Mapping[str, object], load_table: Mapping[str, object], label: str
) -> dict[str, object]:
    """A vessel file with a load's tables laid over it: top-level numbers, body, geometry, and effects by name."""
    out = dict(raw)
    effects = [dict(t) for t in tables(raw.get("effect"))]
    for key, value in load_table.items():
        mine = next((t for t in effects if _called(t) == key), None)
        if mine is not None:
            if not isinstance(value, Mapping):
                raise BadInput(f"{label}: {key} = {value!r}; allowed is a table of its values")
            mine.update(value)
        elif isinstance(value, dict) and key in ("body", "geometry", "manoeuvring", "diagnosis"):
            own = raw.get(key)
            out[key] = {**own, **value} if isinstance(own, Mapping) else value
        elif key in ("length", "beam", "draught"):
            out[key] = value
        else:
            own_tables = (
                "body",
                "geometry",
                "manoeuvring",
                "diagnosis",
                "length",
                "beam",
                "draught",
            )
            names = [*(_called(t) for t in effects), *own_tables]
            raise BadInput(unknown_name(f"{label}: table to change", key, names))
    out["effect"] = effects
    return out
