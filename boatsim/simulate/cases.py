"""What a scenario file says: on its own, as one of its cases, or on top of another that it builds on.

A file is one scenario, or says in [[case]] tables (each with a `name`) what differs between several. A file may build
on another with base = "folder/scenario", "file.toml" or "file.toml:case". A case builds on the rest of its file, or,
where it says so, on another scenario or on a case beside it: base = "case".

One rule lays the upper on the lower: a table is merged key by key, unless the upper one says what to `use`, for that
is another thing and begins anew. All else, a list of tables too, takes the lower one's place.
A file whose name begins with _ is only there to be built on. A path in a file starts at that file.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from boatsim.errors import BadInput, unknown_name
from boatsim.files import Value, read_toml, tables
from boatsim.physics import trust
from boatsim.physics.content import all_names, find, full_name, root

NAME = re.compile(r"[\w.+-]+")
OTHERS = (
    "vessel.toml",
    "patched.toml",
    "recording.toml",
    "pins.toml",
)  # files of a folder that are no scenarios


@dataclass(frozen=True)
class Place:
    """Where a scenario stands: a file, and which of its cases, "" for one that has none."""

    path: Path
    case: str = ""

    @property
    def label(self) -> str:
        """What a mistake in it is reported under."""
        return f"{self.path.name}: {self.case}" if self.case else self.path.name

    @property
    def name(self) -> str:
        """vessel/case for scenarios that are found by name, the case or the file's stem for a file of the user's."""
        own = self.case or self.path.stem
        for home in (root(), *trust.content()):
            if self.path.parent.parent == home / "scenarios":
                return f"{self.path.parent.name}/{own}"
        return own

    @property
    def address(self) -> str:
        """What it is found by again: vessel/case, or the path of a file of the user's, with its case."""
        found = f"{self.path.resolve()}:{self.case}" if self.case else str(self.path.resolve())
        return self.name if "/" in self.name or not self.path.is_file() else found


def content(given: str) -> tuple[dict[str, Value], Place]:
    """All that a scenario says, by its name or path, and where it stands. Raises BadInput."""
    place = located(given)
    return _told(place, ()), place


def meant(given: str) -> list[str]:
    """The scenarios that a word on the command line stands for: a name, a folder, a pattern, or a file's cases."""
    shipped = all_names("scenario")
    if not given:
        raise BadInput(
            f"the name of a scenario is empty; {unknown_name('scenario', given, shipped)}"
        )
    if given in shipped:
        return [given]
    inside = [n for n in shipped if n.startswith(f"{given.rstrip('/')}/")]
    if inside:
        return inside
    if Path(given).is_dir():
        return [one for path in files_of(Path(given)) for one in meant(str(path))]
    if any(sign in given for sign in "*?[") and not Path(given).is_file():
        found = [n for n in shipped if fnmatchcase(n, given)]
        if not found:
            folders = sorted({n.partition("/")[0] for n in shipped})
            raise BadInput(f"no scenario is like {given!r} (they are in {', '.join(folders)})")
        return found
    if given.endswith(".toml"):
        return [f"{given}:{case}" for case in cases(find("scenario", given))] or [given]
    return [full_name("scenario", given)]


def files_of(folder: Path) -> list[Path]:
    """Scenario files in a folder, by name. Raises BadInput where there is none."""
    files = [path for path in sorted(folder.glob("[!_]*.toml")) if path.name not in OTHERS]
    if not files:
        raise BadInput(f"{folder}: there is no scenario (*.toml) in this folder")
    return files


def cases(path: Path) -> list[str]:
    """Names of a file's cases; none if it is one scenario. Raises BadInput for one without a name, or a name twice."""
    given = read_toml(path).get("case", [])
    there = tables(given)
    if not isinstance(given, list) or len(there) < len(given):
        raise BadInput(f"{path.name}: case = {given!r}; allowed are [[case]] tables")
    found: list[str] = []
    for number, case in enumerate(there, 1):
        name = case.get("name")
        if not isinstance(name, str) or not NAME.fullmatch(name):
            raise BadInput(
                f"{path.name}: [[case]] {number}: name = {name!r}; allowed are letters, digits and _ . + -"
            )
        if name in found:
            raise BadInput(
                f"{path.name}: case {name!r} stands there twice; each needs a name of its own"
            )
        found.append(name)
    return found


def located(given: str, beside: Path | None = None) -> Place:
    """The place of a scenario by its name, or by a path from the folder `beside`: a file, or `file.toml:case`."""
    file, _, case = given.rpartition(":")
    named = file.endswith(".toml")
    path = find("scenario", file if named else given, beside)
    there = cases(path)
    if named:
        if case not in there:
            raise BadInput(unknown_name(f"{path.name}: case", case, there))
        return Place(path, case)
    if not there:
        return Place(path)
    own = given.rpartition("/")[2]
    if given.endswith(".toml") or own not in there:
        raise BadInput(
            f"{path.name} holds several cases; say which: {', '.join(f'{path.name}:{c}' for c in there)}"
        )
    return Place(path, own)


def merged(base: Mapping[str, Value], over: Mapping[str, Value]) -> dict[str, Value]:
    """One table on top of another."""
    out = dict(base)
    for key, value in over.items():
        mine = out.get(key)
        if isinstance(mine, dict) and isinstance(value, dict) and "use" not in value:
            value = merged(mine, value)
        out[key] = value
    return out


def _told(place: Place, above: Sequence[Place]) -> dict[str, Value]:
    """Content of a place with that of its base beneath; `above` are those that build on it."""
    if place in above:
        way = " -> ".join(p.case or p.path.name for p in [*above[above.index(place) :], place])
        raise BadInput(f"{above[0].label}: base leads back to where it came from: {way}")
    file = {
        key: _at_home(value, place.path.parent, key) for key, value in read_toml(place.path).items()
    }
    own: dict[str, Value] = next(
        (case for case in tables(file.pop("case", [])) if case["name"] == place.case), {}
    )
    layers = [own] if "base" in own else [file, own]
    given = layers[0].get("base")
    said: dict[str, Value] = {} if given is None else _told(_base(given, place), [*above, place])
    for layer in layers:
        said = merged(said, {k: v for k, v in layer.items() if k not in ("base", "name")})
    return said


def _base(given: Value, place: Place) -> Place:
    """Where a base stands: a case beside the one that names it, or a scenario of another file."""
    try:
        if not isinstance(given, str):
            raise BadInput(f"{given!r}; allowed is the name of a scenario")
        there = cases(place.path)
        if given in there:
            return Place(place.path, given)
        if "/" not in given and ".toml" not in given:
            raise BadInput(unknown_name("scenario", given, [*there, *all_names("scenario")]))
        return located(given, place.path.parent)
    except BadInput as error:
        raise BadInput(f"{place.label}: base: {error}") from None


def _at_home(value: Value, folder: Path, key: str = "") -> Value:
    """Content of a file with the paths in it, of vessels and of what is to `use`, made to start at its folder."""
    if isinstance(value, dict):
        return {k: _at_home(v, folder, k) for k, v in value.items()}
    if isinstance(value, list):
        return [_at_home(v, folder) for v in value]
    if key in ("vessel", "use") and isinstance(value, str) and ("/" in value or "." in value):
        return str((folder / value).resolve()) if (folder / value).exists() else value
    return value
