"""Content of a scenario file: on its own, as one of its cases, or based on another scenario.

A file is one scenario, or several in [[case]] tables (each with a `name`), which hold what differs
between them. A file may be based on another one with base = "folder/scenario", "file.toml" or
"file.toml:case". A case is based on the rest of its file, or on another scenario or a case of the
same file: base = "case".

Tables are merged key by key, except that a table with `use` replaces the one below it. All other
values, lists of tables too, are replaced. Files whose names begin with _ only serve as a base.
Paths in a file are relative to that file.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import chain
from pathlib import Path

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Value, array_of_tables, read_toml
from boatsim.physics import trust
from boatsim.physics.content import (
    all_content_names,
    content_root,
    find_content_file,
    full_scenario_name,
    is_scenario_name,
)

NAME = re.compile(r"[\w.+-]+")
# files in a folder of scenarios that are none
OTHERS = ("vessel.toml", "patched.toml", "recording.toml", "pins.toml")


@dataclass(frozen=True)
class ScenarioLocation:
    """Where a scenario is stored: a file, and the name of a case if the file has several.

    Attributes:
        path: The file.
        case: Name of the case; "" if the file has none.
    """

    path: Path
    case: str = ""

    @property
    def label(self) -> str:
        """Name of a scenario in error messages: file name, and case if it has one."""
        return f"{self.path.name}: {self.case}" if self.case else self.path.name

    @property
    def name(self) -> str:
        """Name of a scenario: "vessel/case" if it is shipped, else its case or file name."""
        own = self.case or self.path.stem
        for home in (content_root(), *trust.user_content_folders()):
            if self.path.parent.parent == home / "scenarios":
                return f"{self.path.parent.name}/{own}"
        return own

    @property
    def address(self) -> str:
        """Address by which a scenario can be loaded again: "vessel/case", or path and case."""
        if "/" in self.name or not self.path.is_file():
            return self.name
        path = str(self.path.resolve())
        return f"{path}:{self.case}" if self.case else path


def read_scenario(given: str) -> tuple[dict[str, Value], ScenarioLocation]:
    """Read the content of a scenario file, merged with the scenarios on which it is based.

    Args:
        given: Name or path, as for `find_scenario`.

    Returns:
        The merged content, and the paths of its files.

    Raises:
        BadInput: If the scenario or its base does not exist or a file is not valid.
    """
    place = find_scenario(given)
    return _merge_with_bases(place, ()), place


def find_scenarios(given: str) -> list[str]:
    """Find all scenarios that an argument of the command line denotes, such as a folder or pattern.

    Args:
        given: A name, a folder, a pattern with * and ?, or a file, which stands for its cases.

    Returns:
        Names and paths.

    Raises:
        BadInput: If there is none.
    """
    if is_scenario_name(given):
        return [given]
    shipped = all_content_names("scenario")
    if not given:
        raise BadInput(
            f"the name of a scenario is empty; {unknown_name_message('scenario', given, shipped)}"
        )
    inside = [name for name in shipped if name.startswith(f"{given.rstrip('/')}/")]
    if inside:
        return inside
    if Path(given).is_dir():
        return list(
            chain.from_iterable(find_scenarios(str(path)) for path in scenario_files(Path(given)))
        )
    if any(sign in given for sign in "*?[") and not Path(given).is_file():
        found = [name for name in shipped if fnmatchcase(name, given)]
        if not found:
            folders = sorted({name.partition("/")[0] for name in shipped})
            raise BadInput(f"no scenario is like {given!r} (they are in {', '.join(folders)})")
        return found
    if given.endswith(".toml"):
        names = case_names(find_content_file("scenario", given))
        return [f"{given}:{case}" for case in names] or [given]
    return [full_scenario_name("scenario", given)]


def scenario_files(folder: Path) -> list[Path]:
    """Return the paths of the scenario files in a folder, sorted by name.

    Raises:
        BadInput: If there is none.
    """
    files = [path for path in sorted(folder.glob("[!_]*.toml")) if path.name not in OTHERS]
    if not files:
        raise BadInput(f"{folder}: there is no scenario (*.toml) in this folder")
    return files


def case_names(path: Path) -> list[str]:
    """Return the names of the [[case]] tables of a scenario file; none if it is a single scenario.

    Raises:
        BadInput: If the file is not valid, a case has no name or two have the same.
    """
    given = read_toml(path).get("case", [])
    case_tables = array_of_tables(given)
    if not isinstance(given, list) or len(case_tables) < len(given):
        raise BadInput(f"{path.name}: case = {given!r}; allowed are [[case]] tables")
    found: list[str] = []
    for number, case in enumerate(case_tables, 1):
        name = case.get("name")
        if not isinstance(name, str) or not NAME.fullmatch(name):
            raise BadInput(
                f"{path.name}: [[case]] {number}: name = {name!r}; "
                "allowed are letters, digits and _ . + -"
            )
        if name in found:
            raise BadInput(f"{path.name}: case {name!r} occurs twice; names must be different")
        found.append(name)
    return found


def find_scenario(given: str, base_folder: Path | None = None) -> ScenarioLocation:
    """Find a scenario by its name or path; return its file and case.

    Args:
        given: Name, or path of a file, or `file.toml:case`.
        base_folder: Folder from which a path starts; default: the working directory.

    Raises:
        BadInput: If it does not exist, or the file has several cases and none is given.
    """
    file, _, case = given.rpartition(":")
    named = file.endswith(".toml")
    path = find_content_file("scenario", file if named else given, base_folder)
    names = case_names(path)
    if named:
        if case not in names:
            raise BadInput(unknown_name_message(f"{path.name}: case", case, names))
        return ScenarioLocation(path, case)
    if not names:
        return ScenarioLocation(path)
    own = given.rpartition("/")[2]
    if given.endswith(".toml") or own not in names:
        choices = ", ".join(f"{path.name}:{name}" for name in names)
        raise BadInput(f"{path.name} holds several cases; name one: {choices}")
    return ScenarioLocation(path, own)


def merge_tables(base: Mapping[str, Value], over: Mapping[str, Value]) -> dict[str, Value]:
    """Merge the table of a scenario file into the table of the scenario on which it is based.

    Tables within both are merged recursively, unless the overriding one has the key `use`; all
    other values of the overriding table replace those of the base.

    Args:
        base: The base.
        over: The table whose values take precedence.
    """
    out = dict(base)
    for key, value in over.items():
        mine = out.get(key)
        if isinstance(mine, dict) and isinstance(value, dict) and "use" not in value:
            value = merge_tables(mine, value)
        out[key] = value
    return out


def _merge_with_bases(
    place: ScenarioLocation, above: Sequence[ScenarioLocation]
) -> dict[str, Value]:
    """Content merged into that of its bases; `above` are the scenarios based on this one."""
    if place in above:
        loop = [p.case or p.path.name for p in [*above[above.index(place) :], place]]
        raise BadInput(f"{above[0].label}: base leads back to itself: {' -> '.join(loop)}")
    file: dict[str, Value] = {}
    for key, value in read_toml(place.path).items():
        file[key] = _make_paths_absolute(value, place.path.parent, key)
    own: dict[str, Value] = {}
    for case in array_of_tables(file.pop("case", [])):
        if case["name"] == place.case:
            own = case
    layers = [own] if "base" in own else [file, own]
    found: dict[str, Value] = {}
    base = layers[0].get("base")
    if base is not None:
        found = _merge_with_bases(_find_base(base, place), [*above, place])
    for layer in layers:
        found = merge_tables(found, {k: v for k, v in layer.items() if k not in ("base", "name")})
    return found


def _find_base(given: Value, place: ScenarioLocation) -> ScenarioLocation:
    """The base that a scenario names: a case of the same file, or a scenario of another one."""
    try:
        if not isinstance(given, str):
            raise BadInput(f"{given!r}; allowed is the name of a scenario")
        names = case_names(place.path)
        if given in names:
            return ScenarioLocation(place.path, given)
        if "/" not in given and ".toml" not in given:
            raise BadInput(
                unknown_name_message("scenario", given, [*names, *all_content_names("scenario")])
            )
        return find_scenario(given, place.path.parent)
    except BadInput as error:
        raise BadInput(f"{place.label}: base: {error}") from None


def _make_paths_absolute(value: Value, folder: Path, key: str = "") -> Value:
    """Content of a file with absolute paths in the keys `vessel` and `use`."""
    if isinstance(value, dict):
        return {k: _make_paths_absolute(v, folder, k) for k, v in value.items()}
    if isinstance(value, list):
        return [_make_paths_absolute(v, folder) for v in value]
    if key in ("vessel", "use") and isinstance(value, str) and ("/" in value or "." in value):
        if (folder / value).exists():
            return str((folder / value).resolve())
    return value
