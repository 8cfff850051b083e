"""Content by name: vessels, controllers, scenarios and effects are files with their names.

A name is searched for in the library, then in the folder of the file that uses it, then in the
folders of the user's own content. Content is data, which is read, or a Python file, which `trust`
must allow to run.
"""

import hashlib
import importlib
import importlib.util
import re
import sys
import traceback
from contextlib import suppress
from functools import cache
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import array_of_tables, read_toml
from boatsim.physics import trust

# Kinds of content that are modules of this package, one per file
PACKAGES = {
    "kind": "physics.kinds",
    "effect": "physics.effects",
    "measure": "metrics",
    "sensor": "simulate.sensors",
    "reader": "recordings.readers",
    "log": "recordings.logs",
}
# Class statement or preset of an effect
EFFECT_CLASS = re.compile(r"^(?:class (?=\w+\()|(?=\w+ = preset_effect\())([A-Z]\w*)", re.MULTILINE)
KINDS = {"vessel": "models", "controller": "controllers", "scenario": "scenarios"}
# Ending of the file of a trained policy, and the controller that runs it
POLICY, POLICY_CONTROLLER = ".onnx", "learned_policy"
# Folders of a user's own content
USER_FOLDERS = {
    **KINDS,
    "effect": "effects",
    "measure": "measures",
    "sensor": "sensors",
}


@cache
def content_root() -> Path:
    """Return the folder that contains the shipped models/, controllers/ and scenarios/."""
    package = Path(__file__).parents[1]
    packed = package / "_content"
    return packed if packed.is_dir() else package.parent


def shipped_content_names(kind: str) -> list[str]:
    """Return the names of all shipped vessels, or of all shipped content of another kind.

    Kinds are, for example, "vessel", "controller", "scenario" and "effect". Scenarios have names of
    the form folder/file or folder/case.
    """
    if kind == "effect":
        return sorted(_effect_files())
    if kind in PACKAGES:
        return list(_module_names(kind))
    folder = content_root() / KINDS[kind]
    if kind == "vessel":
        return sorted(p.parent.name for p in folder.glob("*/vessel.toml"))
    if kind == "controller":
        return sorted(p.stem for p in folder.glob("[!_]*.py"))
    return sorted(_scenarios(content_root()))


def _package(kind: str) -> Path:
    """Folder of the modules of a kind."""
    return Path(__file__).parents[1].joinpath(*PACKAGES[kind].split("."))


@cache
def _module_names(kind: str) -> list[str]:
    """Names of the modules of a kind."""
    return sorted(p.stem for p in _package(kind).glob("[!_]*.py"))


@cache
def _effect_files() -> dict[str, str]:
    """Name of every effect of the library -> its file.

    The names are read from the text, so that none of the files is imported.
    """
    files: dict[str, str] = {}
    for file in sorted(_package("effect").glob("[!_]*.py")):
        for name in EFFECT_CLASS.findall(file.read_text(encoding="utf-8")):
            files[snake_case(name)] = file.stem
    return files


def user_content_names(kind: str) -> list[str]:
    """Return the names of vessels, effects, controllers or scenarios in the user's own folders."""
    found: set[str] = set()
    for folder in trust.user_content_folders() if kind in USER_FOLDERS else ():
        inside = folder / USER_FOLDERS[kind]
        if kind == "scenario":
            found.update(_scenarios(folder))
        elif kind == "vessel":
            files = (*inside.glob("*/vessel.toml"), *folder.glob("*/vessel.toml"))
            found.update(file.parent.name for file in files)
        else:
            found.update(file.stem for file in inside.glob("[!_]*.py"))
    return sorted(found - set(shipped_content_names(kind)))


def all_content_names(kind: str) -> list[str]:
    """Return the names of all vessels, or of all content of another kind.

    Both shipped content and that of the user's own folders count.
    """
    return sorted([*shipped_content_names(kind), *user_content_names(kind)])


def full_scenario_name(kind: str, name: str) -> str:
    """Return the full name folder/name of a scenario that is given by its bare name.

    Any other name is returned unchanged.

    Raises:
        BadInput: If several scenarios have the name.
    """
    if kind != "scenario" or not name or "/" in name or name.endswith(".toml"):
        return name
    found = [n for n in all_content_names(kind) if n.rpartition("/")[2] == name]
    if len(found) > 1:
        raise BadInput(f"several scenarios are called {name}; give one of {', '.join(found)}")
    return found[0] if found else name


def find_content_file(kind: str, name: str, base_folder: Path | None = None) -> Path:
    """Return the path of the file that defines a vessel, a controller or a scenario.

    It is a vessel.toml, a controller's .py, the .onnx of a trained policy or a scenario's .toml.

    Args:
        kind: "vessel", "controller" or "scenario".
        name: Name or path.
        base_folder: Folder of the file that names the content; relative paths start there. Without
            one the user names it, and paths start from the working directory.

    Raises:
        BadInput: If there is none, with the nearest valid name.
    """
    if base_folder is None:
        name = full_scenario_name(kind, name)
    for search in (_by_path, _in_library, _in_user_content, _in_working_directory):
        with suppress(OSError):  # a text that is too long for the name of a file
            if (found := search(kind, name, base_folder)) is not None:
                return found
    if name.endswith((".py", POLICY, ".toml")):
        raise BadInput(f"{name}: no such file")
    raise BadInput(unknown_name_message(kind, name, all_content_names(kind)))


def _by_path(kind: str, name: str, base_folder: Path | None) -> Path | None:
    """The file of a path, or of a controller's name in the folder of the naming file."""
    suffixes = (".py", POLICY) if kind == "controller" else (".toml",)
    path = (base_folder or Path()) / name
    if path.suffix in suffixes and path.is_file():
        return path.resolve()
    if base_folder and kind == "controller" and name not in shipped_content_names(kind):
        controller = base_folder / f"{name}.py"
        if controller.is_file():
            return controller.resolve()
    if kind == "vessel" and "/" in name and (path / "vessel.toml").is_file():
        return (path / "vessel.toml").resolve()
    return None


def _in_library(kind: str, name: str, base_folder: Path | None) -> Path | None:
    if kind == "scenario":
        return _scenario_file(content_root(), name)
    if name not in shipped_content_names(kind):
        return None
    folder = content_root() / KINDS[kind]
    return folder / name / "vessel.toml" if kind == "vessel" else folder / f"{name}.py"


def _in_user_content(kind: str, name: str, base_folder: Path | None = None) -> Path | None:
    if kind == "scenario":
        for folder in trust.user_content_folders():
            if (path := _scenario_file(folder, name)) is not None:
                return path
        return None
    file = name if name.endswith(".py") else f"{name}.py"
    if kind == "vessel":
        file = f"{name}/vessel.toml"
    for folder in trust.user_content_folders():
        for path in (folder / USER_FOLDERS[kind] / file, folder / file):
            if path.is_file():
                return path.resolve()
    return None


def _in_working_directory(kind: str, name: str, base_folder: Path | None) -> Path | None:
    """The vessel of a folder in the working directory, if the user names it and not a file."""
    if kind != "vessel" or base_folder is not None or not name:
        return None
    file = Path(name) / "vessel.toml"
    return file.resolve() if file.is_file() else None


def is_scenario_name(name: str) -> bool:
    """Return whether a scenario, shipped or of the user, has the full name folder/file or case.

    Args:
        name: Any text.
    """
    homes = (content_root(), *trust.user_content_folders())
    return any(_scenario_file(home, name) is not None for home in homes)


def _scenario_file(home: Path, name: str) -> Path | None:
    """The file of a scenario by its full name; only files in its folder are read."""
    folder, _, case = name.partition("/")
    if folder in ("", ".", "..") or not case:
        return None
    with suppress(OSError):  # a text that is too long for the name of a file
        return _scenarios(home, folder).get(name)
    return None


def _scenarios(home: Path, folder: str = "*") -> dict[str, Path]:
    """Name of every scenario in a folder of content, folder/file or folder/case -> its file.

    With `folder`, only of that one. Raises BadInput.
    """
    found: dict[str, Path] = {}
    scenarios = home / KINDS["scenario"]
    if folder == "*":
        files = scenarios.glob("*/[!_]*.toml")
    else:
        files = (scenarios / folder).glob("[!_]*.toml")
    for path in sorted(files):
        for case in _cases(path, path.stat().st_mtime_ns) or (path.stem,):
            name = f"{path.parent.name}/{case}"
            if name in found:
                raise BadInput(f"scenario {name} is in both {found[name].name} and {path.name}")
            found[name] = path
    return found


@cache
def _cases(path: Path, _modified_ns: int) -> tuple[str, ...]:
    """Names of the cases of a scenario file in one state of the file."""
    return tuple(str(case.get("name")) for case in array_of_tables(read_toml(path).get("case")))


class _UncachedLoader(SourceFileLoader):
    """Loader of a user's Python file that always compiles its present text.

    Python takes the bytecode of a file edited within the same second, with the same size, for that
    of the new text.

    Attributes:
        text: Text of the file that was compiled.
    """

    text: bytes | None = None

    def get_code(self, fullname: str) -> CodeType:
        """Return the compiled text of the file."""
        self.text = self.get_data(self.path)
        return self.source_to_code(self.text, self.path)


def import_module_file(path: Path, name: str) -> ModuleType:
    """Import a Python file as a module of a given name; a module imported before is returned.

    Args:
        path: The Python file.
        name: Name of the module.

    Raises:
        BadInput: If the file raises an exception, with its line.
    """
    if name in sys.modules:
        return sys.modules[name]
    loader = _UncachedLoader(name, str(path))
    spec = importlib.util.spec_from_file_location(name, path, loader=loader)
    if spec is None or spec.loader is None:
        raise BadInput(f"{path}: cannot be imported")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
        _show_pandas_to_arrow()
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        message = f"{path}:{_line_of(error, path)} {type(error).__name__}: {error}"
        raise BadInput(message.replace("\n", " ")) from error
    return module


def _show_pandas_to_arrow() -> None:
    """Make pyarrow recognise series of pandas, if both are imported.

    pyarrow looks for pandas once, at its first array, which may have been before this import (see
    `boatsim/cli/fast_start.py`). It looks again where one asks for its module of pandas.
    """
    arrow = sys.modules.get("pyarrow.lib")
    if arrow is not None and "pandas" in sys.modules:
        with suppress(AttributeError, ImportError):  # it is private to pyarrow
            arrow._pandas_api.pd  # noqa: B018


def _line_of(error: BaseException, path: Path) -> str:
    """Last line of a file in the traceback of an exception, as a text; "" where it has none."""
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if frame.filename == str(path):
            return f" line {frame.lineno}"
    return ""


def camel_case(name: str) -> str:
    """Return the Python class name that belongs to a file name: fan_wind -> FanWind."""
    return "".join(word.capitalize() for word in name.split("_"))


def snake_case(name: str) -> str:
    """Return the file name that belongs to a Python class name: FanWind -> fan_wind."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def import_library_module(kind: str, name: str) -> ModuleType:
    """Return the module of boatsim that defines an effect, sensor or other content by name."""
    file = _effect_files()[name] if kind == "effect" else name
    return importlib.import_module(f"boatsim.{PACKAGES[kind]}.{file}")


def load_class(
    kind: str, name: str, base_folder: Path | None = None, named: bool = False
) -> type[Any]:
    """Return the Python class of an effect, measure, sensor or controller with a given name.

    The name of the class is that of its file in CamelCase.

    Args:
        kind: "effect", "measure", "sensor" or "controller".
        name: Name, path of a .py file, or of a trained policy, which is data and needs no trust.
        base_folder: Folder of the file that names the class; relative paths start there.
        named: Whether the user gives the name directly; then a Python file outside trusted folders
            may run if the name is its path, and not one in the folders of the user's content.

    Raises:
        BadInput: If there is no such class, or its file is not trusted.
    """
    if kind in PACKAGES and name in shipped_content_names(kind):
        module = import_library_module(kind, name)
    else:
        if kind == "controller":
            path = find_content_file("controller", name, base_folder)
        else:
            path = _user_file(kind, name, base_folder)
        if path.suffix == POLICY:
            policy: type[Any] = load_class("controller", POLICY_CONTROLLER).from_file(path)
            return policy
        if path.parent == content_root() / KINDS["controller"]:
            module = import_module_file(path, f"boatsim.controllers.{path.stem}")
        else:
            module = _user_module(path, named and _is_named_file(path, name, base_folder))
        name = path.stem
    found = getattr(module, camel_case(name), None)
    if not isinstance(found, type):
        raise BadInput(f"{module.__file__}: no class {camel_case(name)} in it")
    # All base classes of content have this method
    if not hasattr(found, "from_settings"):
        raise BadInput(
            f"{module.__file__}: class {camel_case(name)} is no {kind}; it must be derived from "
            "the base class of one"
        )
    return found


def _user_file(kind: str, name: str, base_folder: Path | None) -> Path:
    """Path of a user's effect, measure or sensor. Raises BadInput."""
    path = (base_folder or Path()) / (name if name.endswith(".py") else f"{name}.py")
    found = path if path.is_file() else _in_user_content(kind, name)
    if found is None:
        raise BadInput(unknown_name_message(kind, name, all_content_names(kind)))
    return found


def _is_named_file(path: Path, name: str, base_folder: Path | None) -> bool:
    """Whether a name is the path of a file, so that no link in a content folder leads to it."""
    file = (base_folder or Path()) / (name if name.endswith(".py") else f"{name}.py")
    return file.is_file() and file.resolve() == path.resolve()


def effect_reference(effect: type) -> str:
    """Return the text by which a file refers to the class of an effect.

    It is the name of an effect of the library, or else the path of the file that defines the
    effect.
    """
    if effect.__module__.startswith("boatsim.physics.effects."):
        return snake_case(effect.__name__)
    return str(Path(sys.modules[effect.__module__].__file__ or "").resolve())


def vessel_reference(file: Path) -> str:
    """Return the text by which a saved file refers to a vessel.

    It is the name of a shipped vessel, or the absolute path of another vessel.toml.
    """
    if file.parent.parent == content_root() / KINDS["vessel"]:
        return file.parent.name
    return str(file.resolve())


def _user_module(path: Path, named: bool) -> ModuleType:
    """Import a user's file.

    Path and content make the module name, for the file may change while the program runs.
    """
    path = path.resolve()
    digest = hashlib.sha256(str(path).encode() + path.read_bytes()).hexdigest()[:16]
    name = f"boatsim_own_{path.stem}_{digest}"
    # A module that was imported before has been trusted before
    if not named and name not in sys.modules:
        trust.check_trusted(path)
    return import_module_file(path, name)
