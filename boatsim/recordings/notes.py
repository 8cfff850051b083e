"""What a `recording.toml` says about the recordings in its folder: vessel, loads, columns, noise, facts."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from stat import S_IWOTH
from typing import TypedDict, TypeVar

from boatsim.errors import BadInput, unknown_name
from boatsim.files import Value, home_folder, read_toml
from boatsim.physics.facts import wrong
from boatsim.physics.signals import AXES

T = TypeVar("T")
NOISE = (
    "position_sd_m",
    "heading_sd_rad",
    "yaw_rate_sd_radps",
    "roll_sd_rad",
    "roll_rate_sd_radps",
)
AMBIENT = ("axes", "force_rms", "time_constant_s")
TABLES = ("columns", "noise", "ambient", "coefficient_uncertainty", "facts", "set")
KEYS = ("vessel", "load", "scale", "use", *TABLES, "runs")
HUGE = 1e300  # larger integers do not fit a float
# endings that say the unit of a column or key, longest first so that `_mps2` is not taken for `_s`
UNITS = {
    "Nspm": "N s/m",
    "radps2": "rad/s^2",
    "radps": "rad/s",
    "mps2": "m/s^2",
    "mps": "m/s",
    "deg": "deg",
    "rad": "rad",
    "rpm": "1/min",
    "rps": "1/s",
    "kgm2": "kg m^2",
    "kg": "kg",
    "Nm": "N m",
    "Hz": "Hz",
    "us": "us",
    "m2": "m^2",
    "N": "N",
    "V": "V",
    "A": "A",
    "W": "W",
    "m": "m",
    "s": "s",
}


def unit_of(name: str) -> str:
    """Unit a column's or key's ending stands for: `r_radps` -> "rad/s"; "" where the name has no unit."""
    for bound in ("_low", "_high"):  # of an adaptive estimate: the bound has the estimate's unit
        name = name.removesuffix(bound)
    _, separator, ending = name.rpartition("_")
    return UNITS.get(ending, "") if separator else ""


class Ambient(TypedDict, total=False):
    """What [ambient] states of the force that no model explains."""

    axes: list[str]
    force_rms: list[float] | dict[str, float]  # [N, N m] by axis, or of those in `axes` in turn
    time_constant_s: float


@dataclass(frozen=True)
class Notes:
    """What is known about a recording besides its columns; empty where nobody wrote a `recording.toml`."""

    vessel: str | None = None
    load: tuple[str, ...] = ()
    # [set.<effect>]: the vessel's own, this run
    settings: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    use: tuple[float, float] | None = None  # [s] the part of the recording that counts
    scale: float | None = None  # full scale length / model length
    noise: dict[str, float] = field(default_factory=dict)  # names in NOISE, one standard deviation
    ambient: Ambient = field(default_factory=Ambient)
    # relative, one standard deviation
    coefficient_uncertainty: dict[str, float] = field(default_factory=dict)
    # forward_speed_mps, walls_m, fan position, free text
    facts: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True)
class NotesFile:
    """A `recording.toml` as it applies to one run: the notes, the names of columns, and what was not understood."""

    notes: Notes = field(default_factory=Notes)
    # our name -> expression of their column: "-delta", "heading_deg * deg"
    columns: dict[str, str] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    folder: Path | None = None  # in which it lies, and where its own paths start


def notes_for(recording: Path) -> NotesFile:
    """Notes of one recording from the `recording.toml` in its folder or the nearest folder above that it belongs to."""
    if not recording.is_file():  # nor is a ring of links
        return NotesFile()
    for folder in _belonging(recording.resolve().parent):
        file = folder / "recording.toml"
        if file.is_file():
            return _parse(file, recording.stem)
    return NotesFile()


def _belonging(folder: Path) -> Iterator[Path]:
    """A recording's folder and those above it, up to the user's home or the repository, whichever comes first.

    A folder that everybody may write to, such as /tmp, ends it too: what lies there may be anybody's.
    """
    home = home_folder()
    yield folder
    for inner, above in pairwise((folder, *folder.parents)):
        if inner == home or (inner / ".git").exists() or above.stat().st_mode & S_IWOTH:
            return
        yield above


def _parse(file: Path, stem: str) -> NotesFile:
    table = read_toml(file)
    runs = _Reader(file, table).table("runs")
    merged = _merge(
        {k: v for k, v in table.items() if k != "runs"}, _Reader(file, runs, "runs.").table(stem)
    )
    return _Reader(file, merged).notes()


def _merge(base: Mapping[str, Value], over: Mapping[str, Value]) -> dict[str, Value]:
    """A run's own entries over those of all runs, table by table."""
    both = {**base, **over}
    for key, value in over.items():
        lower = base.get(key)
        if isinstance(lower, dict) and isinstance(value, dict):
            both[key] = _merge(lower, value)
    return both


def _numbers(value: Value) -> list[float]:
    """The numbers of a list; none where it is no list, or holds anything else."""
    listed = value if isinstance(value, list) else []
    found = [x for x in listed if isinstance(x, int | float) and not isinstance(x, bool)]
    return found if len(found) == len(listed) and all(abs(x) <= HUGE for x in found) else []


def _tried(wrong: list[str], part: Callable[[], T], instead: T) -> T:
    """A part of the notes; what is wrong with it is kept aside, so that all of a file's mistakes are said at once."""
    try:
        return part()
    except BadInput as error:
        wrong.append(str(error))
        return instead


class _Reader:
    """Checked look-ups in one table; each refusal is a line with file, key, value found and what is allowed."""

    def __init__(self, file: Path, table: Mapping[str, Value], prefix: str = "") -> None:
        self.file, self.content, self.prefix = file, table, prefix

    def bad(self, key: str, allowed: str) -> BadInput:
        found = " ".join(repr(self.content[key])[:60].split())
        return BadInput(f"{self.file}: {self.prefix}{key} = {found}; allowed is {allowed}")

    def table(self, key: str) -> dict[str, Value]:
        value = self.content.get(key, {})
        if not isinstance(value, dict):
            raise self.bad(key, "a table")
        return value

    def inner(self, key: str) -> "_Reader":
        return _Reader(self.file, self.table(key), f"{self.prefix}{key}.")

    def text(self, key: str) -> str | None:
        value = self.content.get(key)
        if value is None or (isinstance(value, str) and value):
            return value
        raise self.bad(key, "a text in quotation marks")

    def texts(self, key: str) -> tuple[str, ...]:
        value = self.content.get(key, [])
        given = [value] if isinstance(value, str) else value
        found = [text for text in given if isinstance(text, str)] if isinstance(given, list) else []
        if not isinstance(given, list) or len(found) < len(given):
            raise self.bad(key, "a text or a list of texts")
        return tuple(found)

    def number(self, key: str, *, low: float = -math.inf) -> float:
        value = self.content[key]
        if (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or not low <= value <= HUGE
        ):
            raise self.bad(key, "a number" if low < 0 else f"a number of at least {low:g}")
        return float(value)

    def numbers(self, *, low: float = -math.inf) -> dict[str, float]:
        return {key: self.number(key, low=low) for key in self.content}

    def use(self) -> tuple[float, float] | None:
        if "use" not in self.content:
            return None
        ends = _numbers(self.content["use"])
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise self.bad("use", "[from_s, to_s], two numbers of which the second is larger")
        return float(ends[0]), float(ends[1])

    def columns(self) -> dict[str, str]:
        inner = self.inner("columns")
        return {name: column for name in inner.content if (column := inner.text(name)) is not None}

    def ambient(self) -> Ambient:
        inner, found = self.inner("ambient"), Ambient()
        if "axes" in inner.content:
            found["axes"] = list(inner.texts("axes"))
        for axis in found.get("axes", ()):
            if axis not in AXES:
                raise BadInput(f"{self.file}: {unknown_name('ambient.axes: axis', axis, AXES)}")
        if "time_constant_s" in inner.content:
            found["time_constant_s"] = inner.number("time_constant_s", low=0.0)
        if "force_rms" in inner.content:
            found["force_rms"] = inner.sizes("force_rms")
        return found

    def sizes(self, key: str) -> list[float] | dict[str, float]:
        """Numbers by axis, or in turn."""
        value = self.content[key]
        given = (
            list(value.values())
            if isinstance(value, dict)
            else value
            if isinstance(value, list)
            else [value]
        )
        found = [
            x
            for x in given
            if isinstance(x, int | float) and not isinstance(x, bool) and 0 <= x <= HUGE
        ]
        if len(found) < len(given):
            raise self.bad(key, "a number of at least 0 for each axis")
        if isinstance(value, dict):
            return dict(zip(value, found, strict=True))
        return found

    def facts(self) -> dict[str, Value]:
        if found := wrong(self.content):
            raise self.bad(*found)
        return dict(self.content)

    def notes(self) -> NotesFile:
        """All of it. Raises one BadInput that says everything that is wrong."""
        known = [key for key in self.content if key in KEYS]
        # a key that carries a unit, such as a run's own `forward_speed_mps`, is a fact about the
        # run
        facts = {key: self.content[key] for key in self.content if key not in KEYS and unit_of(key)}
        wrong: list[str] = []
        notes = Notes(
            vessel=_tried(wrong, lambda: self.text("vessel"), None),
            load=_tried(wrong, lambda: self.texts("load"), ()),
            settings=_tried(wrong, self.settings, {}),
            use=_tried(wrong, self.use, None),
            scale=_tried(
                wrong,
                lambda: self.number("scale", low=1e-9) if "scale" in self.content else None,
                None,
            ),
            noise=_tried(wrong, lambda: self.inner("noise").numbers(low=0.0), {}),
            ambient=_tried(wrong, self.ambient, Ambient()),
            coefficient_uncertainty=_tried(
                wrong, lambda: self.inner("coefficient_uncertainty").numbers(low=0.0), {}
            ),
            facts=_tried(wrong, lambda: self.all_facts(facts), {}),
        )
        notes = replace(notes, noise={k: v for k, v in notes.noise.items() if k in NOISE})
        columns: dict[str, str] = _tried(wrong, self.columns, dict[str, str]())
        if wrong:
            raise BadInput(
                "; ".join([wrong[0], *(w.removeprefix(f"{self.file}: ") for w in wrong[1:])])
            )
        strange = [
            self.strange(key, KEYS) for key in self.content if key not in known and key not in facts
        ]
        for table, allowed in (("noise", NOISE), ("ambient", AMBIENT)):
            strange += [
                self.strange(f"{table}.{k}", allowed) for k in self.table(table) if k not in allowed
            ]
        remarks = (f"{self.file}: not used: {', '.join(strange)}",) if strange else ()
        return NotesFile(notes, columns, remarks, self.file.parent)

    def settings(self) -> dict[str, dict[str, float]]:
        settings = self.inner("set")
        return {effect: settings.inner(effect).numbers() for effect in settings.content}

    def all_facts(self, beside: Mapping[str, Value]) -> dict[str, Value]:
        return _Reader(self.file, {**beside, **self.table("facts")}, f"{self.prefix}facts.").facts()

    def strange(self, key: str, allowed: tuple[str, ...]) -> str:
        near = get_close_matches(key.rpartition(".")[2], allowed, n=1, cutoff=0.5)
        return f"{key} (did you mean {near[0]}?)" if near else key
