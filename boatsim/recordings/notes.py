"""Notes of recordings: the content of a `recording.toml` that applies to one recording."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from functools import partial
from itertools import pairwise
from pathlib import Path
from stat import S_IWOTH
from typing import TypedDict, TypeVar

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Value, home_folder, read_toml
from boatsim.physics.facts import first_invalid_fact
from boatsim.physics.groups import IN_GROUP
from boatsim.physics.signals import AXES, NOISE
from boatsim.recordings.conversion import Curve, Range, conversion_of

T = TypeVar("T")
AMBIENT = ("axes", "force_rms", "time_constant_s")
TABLES = ("columns", "latency", "noise", "ambient", "coefficient_uncertainty", "facts", "set")
KEYS = ("vessel", "load", "group", "scale", "use", "clock", *TABLES, "runs")
FORBIDDEN_IN_GROUP = (IN_GROUP, ".", "'", '"')  # in the name of a group
CLOCK_BY_MOTION = "motion"  # the value of `clock` with which the motion sets the times of the rows
MAX_LATENCY = 60.0  # [s] a longer one is a wrong clock
MAX_NUMBER = 1e300  # larger integers do not fit a float
# Suffix of a column or key -> unit
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
    """Return the unit of a signal by the suffix of its name, such as "rad/s" for `r_radps`.

    The result is "" for a name without a known suffix.
    """
    for bound in ("_low", "_high"):  # bounds of an adaptive estimate have the unit of the estimate
        name = name.removesuffix(bound)
    _, separator, ending = name.rpartition("_")
    if not separator:
        return ""
    return UNITS.get(ending, "")


class Ambient(TypedDict, total=False):
    """The [ambient] table of a recording.toml: the known level of the unmodelled disturbance force.

    Attributes:
        axes: Axes to which the list `force_rms` belongs.
        force_rms: Rms of force and moment [N, N m], by axis or in the order of `axes`.
        time_constant_s: Correlation time [s].
    """

    axes: list[str]
    force_rms: list[float] | dict[str, float]
    time_constant_s: float


@dataclass(frozen=True)
class Notes:
    """Notes on a recording from its `recording.toml`: vessel, load, noise and other known facts.

    All fields are empty without the file.

    Attributes:
        vessel: Name or path of the vessel.
        load: Load conditions.
        groups: Groups of recordings, such as a day or a build, to which it belongs.
        settings: Values of the vessel's effects in this run: effect -> parameter -> value.
        use: Parts of the recording that are used, each from and to [s]; () for all of it.
        latency: Column -> delay by which its values are older than their times [s].
        clock: "motion" if the times of the rows follow from the recorded motion, else "".
        scale: Full-scale length / model length.
        noise: Standard deviation of the sensors, by the names in NOISE.
        ambient: The unmodelled disturbance.
        coefficient_uncertainty: Relative standard deviation of the model's coefficients, by kind.
        facts: Facts such as `walls_m` and `position_fix_type`, and free text.
    """

    vessel: str | None = None
    load: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    settings: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    use: tuple[tuple[float, float], ...] = ()
    latency: dict[str, float] = field(default_factory=dict)
    clock: str = ""
    scale: float | None = None
    noise: dict[str, float] = field(default_factory=dict)
    ambient: Ambient = field(default_factory=Ambient)
    coefficient_uncertainty: dict[str, float] = field(default_factory=dict)
    facts: Mapping[str, Value] = field(default_factory=dict)


@dataclass(frozen=True)
class NotesFile:
    """Content of a `recording.toml` as it applies to one recording.

    Attributes:
        notes: The notes.
        columns: Signal -> expression of the file's column: "-delta", "heading_deg * deg"; or the
            range or curve by which it follows from one.
        remarks: Messages about unknown keys.
        folder: Folder of the file, from which its paths start; None without a file.
    """

    notes: Notes = field(default_factory=Notes)
    columns: dict[str, str | Range | Curve] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    folder: Path | None = None


def notes_for(recording: Path) -> NotesFile:
    """Return the notes on a recording from the nearest `recording.toml` in or above its folder.

    Args:
        recording: File of the recording.

    Raises:
        BadInput: With all mistakes of the `recording.toml`.
    """
    if not recording.is_file():  # false for a ring of links too
        return NotesFile()
    for folder in _folders_to_search(recording.resolve().parent):
        file = folder / "recording.toml"
        if file.is_file():
            return _parse(file, recording.stem)
    return NotesFile()


def _folders_to_search(folder: Path) -> Iterator[Path]:
    """The folder of a recording and those above it, up to home or root of a repository.

    The search ends below a folder that all users may write to, such as /tmp, for its files may be
    of other users.
    """
    home = home_folder()
    yield folder
    for inner, above in pairwise((folder, *folder.parents)):
        if inner == home or (inner / ".git").exists() or above.stat().st_mode & S_IWOTH:
            return
        yield above


def _parse(file: Path, stem: str) -> NotesFile:
    table = read_toml(file)
    runs = _Reader(file, table).read_table("runs")
    table.pop("runs", None)
    merged = table
    for name in _matching_runs(runs, stem):
        merged = _merge(merged, _Reader(file, runs, "runs.").read_table(name))
    return _Reader(file, merged).read_notes()


def _matching_runs(runs: Mapping[str, Value], stem: str) -> list[str]:
    """Tables of [runs] for one recording: patterns such as "4*" in order, then its own name."""
    patterns = [name for name in runs if name != stem and fnmatchcase(stem, name)]
    return [*patterns, stem]


def _merge(base: Mapping[str, Value], over: Mapping[str, Value]) -> dict[str, Value]:
    """The entries of all runs with those of one run in their place, table by table."""
    both = {**base, **over}
    for key, value in over.items():
        lower = base.get(key)
        if isinstance(lower, dict) and isinstance(value, dict):
            both[key] = _merge(lower, value)
    return both


def _numbers(value: Value) -> list[float]:
    """The numbers of a list; [] for a value that is not a list of numbers."""
    if not isinstance(value, list) or not all(map(_is_number, value)):
        return []
    return [x for x in value if isinstance(x, int | float)]


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= MAX_NUMBER


def _read_or_collect_mistake(mistakes: list[str], read: Callable[[], T], default: T) -> T:
    """A part of the notes.

    Its mistake is added to a list, so that one message has all mistakes of a file.
    """
    try:
        return read()
    except BadInput as error:
        mistakes.append(str(error))
        return default


class _Reader:
    """Checked access to one table; errors have file, key, value found and what is allowed."""

    def __init__(self, file: Path, table: Mapping[str, Value], prefix: str = "") -> None:
        self.file, self.content, self.prefix = file, table, prefix

    def bad_value(self, key: str, allowed: str) -> BadInput:
        found = " ".join(repr(self.content[key])[:60].split())
        return BadInput(f"{self.file}: {self.prefix}{key} = {found}; allowed is {allowed}")

    def read_table(self, key: str) -> dict[str, Value]:
        value = self.content.get(key, {})
        if not isinstance(value, dict):
            raise self.bad_value(key, "a table")
        return value

    def subtable_reader(self, key: str) -> "_Reader":
        return _Reader(self.file, self.read_table(key), f"{self.prefix}{key}.")

    def read_text(self, key: str) -> str | None:
        value = self.content.get(key)
        if value is None or (isinstance(value, str) and value):
            return value
        raise self.bad_value(key, "a text in quotation marks")

    def read_texts(self, key: str) -> tuple[str, ...]:
        value = self.content.get(key, [])
        texts: list[str] = []
        if not isinstance(value, list):
            value = [value]
        for text in value:
            if not isinstance(text, str):
                raise self.bad_value(key, "a text or a list of texts")
            texts.append(text)
        return tuple(texts)

    def read_number(self, key: str, *, low: float = -math.inf) -> float:
        value = self.content[key]
        if isinstance(value, int | float) and not isinstance(value, bool):
            if low <= value <= MAX_NUMBER:
                return float(value)
        if low < 0:
            raise self.bad_value(key, "a number")
        raise self.bad_value(key, f"a number of at least {low:g}")

    def read_numbers(self, *, low: float = -math.inf) -> dict[str, float]:
        read = partial(self.read_number, low=low)
        return dict(zip(self.content, map(read, self.content), strict=True))

    def read_used_interval(self) -> tuple[tuple[float, float], ...]:
        if "use" not in self.content:
            return ()
        given = self.content["use"]
        if isinstance(given, list) and any(isinstance(part, list) for part in given):
            parts = given
        else:
            parts = [given]
        found: list[tuple[float, float]] = []
        for part in parts:
            ends = _numbers(part)
            after = not found or (ends and ends[0] > found[-1][1])
            if len(ends) != 2 or not ends[0] < ends[1] or not after:
                raise self.bad_value(
                    "use",
                    "[from_s, to_s], two numbers of which the second is larger, or a list of "
                    "these in order of time",
                )
            found.append((float(ends[0]), float(ends[1])))
        return tuple(found)

    def read_latency(self) -> dict[str, float]:
        inner = self.subtable_reader("latency")
        found = inner.read_numbers()
        for name, seconds in found.items():
            if abs(seconds) > MAX_LATENCY:
                raise inner.bad_value(name, f"-{MAX_LATENCY:g} to {MAX_LATENCY:g} s")
        return found

    def read_clock(self) -> str:
        if "clock" not in self.content:
            return ""
        if self.content["clock"] != CLOCK_BY_MOTION:
            raise self.bad_value("clock", f'"{CLOCK_BY_MOTION}", or no line')
        return CLOCK_BY_MOTION

    def read_columns(self) -> dict[str, str | Range | Curve]:
        inner = self.subtable_reader("columns")
        columns: dict[str, str | Range | Curve] = {}
        for name, value in inner.content.items():
            if isinstance(value, dict):
                columns[name] = conversion_of(value, f"{self.file}: {inner.prefix}{name}")
                continue
            column = inner.read_text(name)
            if column is not None:
                columns[name] = column
        return columns

    def read_ambient(self) -> Ambient:
        inner, found = self.subtable_reader("ambient"), Ambient()
        if "axes" in inner.content:
            found["axes"] = list(inner.read_texts("axes"))
        for axis in found.get("axes", ()):
            if axis not in AXES:
                raise BadInput(
                    f"{self.file}: {unknown_name_message('ambient.axes: axis', axis, AXES)}"
                )
        if "time_constant_s" in inner.content:
            found["time_constant_s"] = inner.read_number("time_constant_s", low=0.0)
        if "force_rms" in inner.content:
            found["force_rms"] = inner.read_force_rms("force_rms")
        return found

    def read_force_rms(self, key: str) -> list[float] | dict[str, float]:
        """Numbers of at least 0, by axis or in a list."""
        value = self.content[key]
        listed: list[Value] = [value]
        if isinstance(value, dict):
            listed = list(value.values())
        elif isinstance(value, list):
            listed = value
        found = _numbers(listed)
        if len(found) < len(listed) or min(found, default=0.0) < 0:
            raise self.bad_value(key, "a number of at least 0 for each axis")
        if isinstance(value, dict):
            return dict(zip(value, found, strict=True))
        return found

    def checked_facts(self) -> dict[str, Value]:
        if found := first_invalid_fact(self.content):
            raise self.bad_value(*found)
        return dict(self.content)

    def read_notes(self) -> NotesFile:
        """Return the content of recording.toml. Raises one BadInput with all mistakes."""
        facts: dict[str, Value] = {}
        unknown: list[str] = []
        for key, value in self.content.items():
            if key in KEYS:
                continue
            if unit_of(key):  # such as `forward_speed_mps`: a fact about the run
                facts[key] = value
            else:
                unknown.append(_with_hint(key, KEYS))
        mistakes: list[str] = []
        notes = Notes(
            vessel=_read_or_collect_mistake(mistakes, lambda: self.read_text("vessel"), None),
            load=_read_or_collect_mistake(mistakes, lambda: self.read_texts("load"), ()),
            groups=_read_or_collect_mistake(mistakes, self.read_groups, ()),
            settings=_read_or_collect_mistake(mistakes, self.read_settings, {}),
            use=_read_or_collect_mistake(mistakes, self.read_used_interval, ()),
            latency=_read_or_collect_mistake(mistakes, self.read_latency, {}),
            clock=_read_or_collect_mistake(mistakes, self.read_clock, ""),
            scale=_read_or_collect_mistake(mistakes, self.read_scale, None),
            noise=_read_or_collect_mistake(
                mistakes, lambda: self.subtable_reader("noise").read_numbers(low=0.0), {}
            ),
            ambient=_read_or_collect_mistake(mistakes, self.read_ambient, Ambient()),
            coefficient_uncertainty=_read_or_collect_mistake(
                mistakes,
                lambda: self.subtable_reader("coefficient_uncertainty").read_numbers(low=0.0),
                {},
            ),
            facts=_read_or_collect_mistake(mistakes, lambda: self.all_facts(facts), {}),
        )
        noise = {name: sd for name, sd in notes.noise.items() if name in NOISE}
        columns: dict[str, str | Range | Curve] = _read_or_collect_mistake(
            mistakes, self.read_columns, {}
        )
        if mistakes:
            raise BadInput(join_mistakes(mistakes, self.file))
        for table, allowed in (("noise", tuple(NOISE)), ("ambient", AMBIENT)):
            for key in self.read_table(table):
                if key not in allowed:
                    unknown.append(_with_hint(f"{table}.{key}", allowed))
        remarks = []
        if unknown:
            remarks.append(f"{self.file}: not used: {', '.join(unknown)}")
        notes = replace(notes, noise=noise)
        return NotesFile(notes, columns, tuple(remarks), self.file.parent)

    def read_groups(self) -> tuple[str, ...]:
        """The groups of the recording, names without the signs that names of effects use."""
        groups = self.read_texts("group")
        if set("".join(groups)) & set(FORBIDDEN_IN_GROUP):
            raise self.bad_value("group", f"a name without {' '.join(FORBIDDEN_IN_GROUP)}")
        return groups

    def read_settings(self) -> dict[str, dict[str, float]]:
        settings = self.subtable_reader("set")
        values: dict[str, dict[str, float]] = {}
        for effect in settings.content:
            values[effect] = settings.subtable_reader(effect).read_numbers()
        return values

    def read_scale(self) -> float | None:
        if "scale" not in self.content:
            return None
        return self.read_number("scale", low=1e-9)

    def all_facts(self, outside: Mapping[str, Value]) -> dict[str, Value]:
        """The [facts] table, with the facts outside it."""
        facts = {**outside, **self.read_table("facts")}
        return _Reader(self.file, facts, f"{self.prefix}facts.").checked_facts()


def _with_hint(key: str, allowed: tuple[str, ...]) -> str:
    """An unknown key, with the nearest valid one."""
    near = get_close_matches(key.rpartition(".")[2], allowed, n=1, cutoff=0.5)
    if near:
        return f"{key} (did you mean {near[0]}?)"
    return key


def join_mistakes(mistakes: Sequence[str], file: Path) -> str:
    """Join several error messages that begin with the same file name into one message."""
    first, *others = mistakes
    return "; ".join([first, *(one.removeprefix(f"{file}: ") for one in others)])
