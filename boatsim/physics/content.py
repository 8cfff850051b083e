"""Finds content by name: vessels, controllers and scenarios are files, and a file's name is its name everywhere.

A name stands for what the library has, else for what lies beside the file that says it, else for what lies in a folder
of the user's own content. What is found may be data, which are read, or a Python file, which `trust` has to allow.
"""

import hashlib
import importlib
import importlib.util
import re
import sys
import traceback
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

from boatsim.errors import BadInput, unknown_name
from boatsim.files import read_toml, tables
from boatsim.physics import trust

PACKAGES = {  # kinds that are modules of ours, one a file
    "kind": "physics.kinds",
    "effect": "physics.effects",
    "measure": "metrics",
    "sensor": "simulate.sensors",
    "reader": "recordings.readers",
    "log": "recordings.logs",
}
ENTRY = re.compile(
    r"^(?:class (?=\w+\()|(?=\w+ = preset\())([A-Z]\w*)", re.MULTILINE
)  # of the shelf of effects
KINDS = {"vessel": "models", "controller": "controllers", "scenario": "scenarios"}
OWN = {
    **KINDS,
    "effect": "effects",
    "measure": "measures",
    "sensor": "sensors",
}  # folders of a user's own content


@cache
def root() -> Path:
    """Folder that holds models/, controllers/ and scenarios/: inside an installed package, or the repository."""
    package = Path(__file__).parents[1]
    packed = package / "_content"
    return packed if packed.is_dir() else package.parent


def names(kind: str) -> list[str]:
    """Every vessel, controller, effect, measure or scenario (folder/file, folder/case) of the library."""
    if kind == "effect":
        return sorted(_shelf())
    if kind in PACKAGES:
        return sorted(p.stem for p in _package(kind).glob("[!_]*.py"))
    folder = root() / KINDS[kind]
    if kind == "vessel":
        return sorted(p.parent.name for p in folder.glob("*/vessel.toml"))
    if kind == "controller":
        return sorted(p.stem for p in folder.glob("[!_]*.py"))
    return sorted(_scenarios(root()))


def _package(kind: str) -> Path:
    """Folder of the modules of a kind."""
    return Path(__file__).parents[1].joinpath(*PACKAGES[kind].split("."))


@cache
def _shelf() -> dict[str, str]:
    """Every entry of the shelf of effects -> its file: a file may hold several over one law.

    Read from the text, so that looking for one imports no other.
    """
    files = sorted(_package("effect").glob("[!_]*.py"))
    return {
        snake_case(name): file.stem
        for file in files
        for name in ENTRY.findall(file.read_text(encoding="utf-8"))
    }


def own_names(kind: str) -> list[str]:
    """What the folders of the user's own content add to `names`."""
    found: set[str] = set()
    for folder in trust.content() if kind in OWN else ():
        inside = folder / OWN[kind]
        if kind == "scenario":
            found |= _scenarios(folder).keys()
        elif kind == "vessel":
            found |= {
                p.parent.name for place in (inside, folder) for p in place.glob("*/vessel.toml")
            }
        else:
            found |= {p.stem for p in inside.glob("[!_]*.py")}
    return sorted(found - set(names(kind)))


def known(kind: str) -> list[str]:
    """All names that stand for something of a kind."""
    return sorted([*names(kind), *own_names(kind)])


def whole(kind: str, name: str) -> str:
    """A scenario's folder/name where its bare name says which, else the name. Raises BadInput where several do."""
    if kind != "scenario" or not name or "/" in name or name.endswith(".toml"):
        return name
    found = [n for n in known(kind) if n.rpartition("/")[2] == name]
    if len(found) > 1:
        raise BadInput(f"several scenarios are called {name}; say which: {', '.join(found)}")
    return found[0] if found else name


def find(kind: str, name: str, beside: Path | None = None) -> Path:
    """Path of a vessel.toml, controller .py or scenario .toml, given by name or by a path.

    A relative path starts from `beside`, the folder of the file that says it; without one a user says it, and it starts
    from the working directory. Raises BadInput.
    """
    name = whole(kind, name) if beside is None else name
    found = (
        _by_path(kind, name, beside)
        or _shipped(kind, name)
        or _in_content(kind, name)
        or _here(kind, name, beside)
    )
    if found is not None:
        return found
    if name.endswith((".py", ".toml")):
        raise BadInput(f"{name}: no such file")
    raise BadInput(unknown_name(kind, name, known(kind)))


def _by_path(kind: str, name: str, beside: Path | None) -> Path | None:
    """The file of a path, or of the bare name of a controller beside the file that says it."""
    suffix, own = ".py" if kind == "controller" else ".toml", (beside or Path()) / name
    if own.suffix == suffix and own.is_file():
        return own.resolve()
    if (
        beside
        and kind == "controller"
        and name not in names(kind)
        and (beside / f"{name}{suffix}").is_file()
    ):
        return (beside / f"{name}{suffix}").resolve()
    if kind == "vessel" and "/" in name and (own / "vessel.toml").is_file():
        return (own / "vessel.toml").resolve()
    return None


def _here(kind: str, name: str, beside: Path | None) -> Path | None:
    """The vessel of a folder in the working directory, where it is the user who names it and no file does."""
    own = Path(name) / "vessel.toml"
    return own.resolve() if kind == "vessel" and beside is None and name and own.is_file() else None


def _shipped(kind: str, name: str) -> Path | None:
    """What the library has of that name."""
    if name not in names(kind):
        return None
    folder = root() / KINDS[kind]
    if kind == "scenario":
        return _scenarios(root())[name]
    return folder / name / "vessel.toml" if kind == "vessel" else folder / f"{name}.py"


def _in_content(kind: str, name: str) -> Path | None:
    """What the folders of the user's own content have of that name."""
    if kind == "scenario":
        return next(
            (found[name] for folder in trust.content() if name in (found := _scenarios(folder))),
            None,
        )
    file = (
        f"{name}/vessel.toml"
        if kind == "vessel"
        else name
        if name.endswith(".py")
        else f"{name}.py"
    )
    places = (place / file for folder in trust.content() for place in (folder / OWN[kind], folder))
    return next((p.resolve() for p in places if p.is_file()), None)


def _scenarios(home: Path) -> dict[str, Path]:
    """File of every scenario of the library, or of one's own content, by name: folder/file, or folder/case.

    Raises BadInput.
    """
    found: dict[str, Path] = {}
    for path in sorted((home / KINDS["scenario"]).glob("*/[!_]*.toml")):
        for name in _cases(path, path.stat().st_mtime_ns) or (path.stem,):
            full = f"{path.parent.name}/{name}"
            if full in found:
                raise BadInput(f"scenario {full} stands in {found[full].name} and in {path.name}")
            found[full] = path
    return found


@cache
def _cases(path: Path, _stamp: int) -> tuple[str, ...]:
    """Names of the cases in a scenario file, as long as it is the same file."""
    return tuple(str(case.get("name")) for case in tables(read_toml(path).get("case")))


def module_at(path: Path, name: str) -> ModuleType:
    """Import one file under a given module name, once."""
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise BadInput(f"{path}: can not be imported")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        row = next(
            (
                f" line {f.lineno}"
                for f in reversed(traceback.extract_tb(error.__traceback__))
                if f.filename == str(path)
            ),
            "",
        )
        raise BadInput(
            f"{path}:{row} {type(error).__name__}: {error}".replace("\n", " ")
        ) from error
    return module


def camel_case(name: str) -> str:
    """fan_wind -> FanWind."""
    return "".join(word.capitalize() for word in name.split("_"))


def snake_case(name: str) -> str:
    """FanWind -> fan_wind: the name of an entry in files."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def module_of(kind: str, name: str) -> ModuleType:
    """The module of ours that holds an effect, a measure or a reader."""
    name = _shelf()[name] if kind == "effect" else name
    return importlib.import_module(f"boatsim.{PACKAGES[kind]}.{name}")


def load_class(kind: str, name: str, beside: Path | None = None, named: bool = False) -> type[Any]:
    """The class of an effect, measure or controller: CamelCase of its file's name.

    `beside` is the folder of the file that says so. `named`: the user himself does, so that it may run wherever it is.
    Raises BadInput where not found, or where it is a Python file that nobody vouches for.
    """
    if kind in PACKAGES and name in names(kind):
        module = module_of(kind, name)
    else:
        path = (
            find("controller", name, beside)
            if kind == "controller"
            else _own_file(kind, name, beside)
        )
        shipped = path.parent == root() / KINDS["controller"]
        name = path.stem
        module = (
            module_at(path, f"boatsim.controllers.{name}") if shipped else _own_module(path, named)
        )
    found = getattr(module, camel_case(name), None)
    if not isinstance(found, type):
        raise BadInput(f"{module.__file__}: no class {camel_case(name)} in it")
    if not hasattr(found, "from_settings"):  # which each base of these classes has
        raise BadInput(
            f"{module.__file__}: class {camel_case(name)} is no {kind}; it must derive from one's base class"
        )
    return found


def _own_file(kind: str, name: str, beside: Path | None) -> Path:
    """Path of an effect, measure or sensor of one's own. Raises BadInput."""
    path = (beside or Path()) / (name if name.endswith(".py") else f"{name}.py")
    found = path if path.is_file() else _in_content(kind, name)
    if found is None:
        raise BadInput(unknown_name(kind, name, known(kind)))
    return found


def address(effect: type) -> str:
    """What an effect class is found by from anywhere: its name if it is on the shelf, else the path of its file."""
    if effect.__module__.startswith("boatsim.physics.effects."):
        return snake_case(effect.__name__)
    return str(Path(sys.modules[effect.__module__].__file__ or "").resolve())


def vessel_address(file: Path) -> str:
    """The name of a shipped vessel, else the path of its file."""
    return (
        file.parent.name if file.parent.parent == root() / KINDS["vessel"] else str(file.resolve())
    )


def _own_module(path: Path, named: bool) -> ModuleType:
    """A user's own file: two folders may each have a push.py, and it may be edited while we run."""
    path = path.resolve()
    stamp = hashlib.sha256(str(path).encode() + path.read_bytes()).hexdigest()[:16]
    name = f"boatsim_own_{path.stem}_{stamp}"
    if not named and name not in sys.modules:  # one that has run in this process was vouched for
        trust.check(path)
    return module_at(path, name)
