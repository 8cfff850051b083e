"""Imports between our own modules point down the layers, never round in a ring, and heavy libraries stay in place."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from boatsim.physics.cache import KERNEL, WRITTEN

LAYERS = (  # a module may import from its own folder and from those in the lines above it
    "__init__ errors files",
    "physics",
    "recordings control",
    "simulate",
    "measures",
    "view",
    "diagnose",
    "cli __main__",
)
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names.split()}
FOR_CONTROLLERS = set(  # plain laws, ready to move to a boat
    "errors physics.base control.base control.adaptive control.adaptive_loop control.allocation "
    "control.identification control.helm".split()
)
HEAVY = {  # library -> the only modules that may import it
    "mujoco": {f"simulate.{name}" for name in ("world", "native", "engine", "env")},
    "dm_control": {"simulate.env"},
    "dm_env": {"simulate.env"},
    "rerun": {"view.rerun_log", "view.blueprint", "recordings.readers.rrd"},
    "jinja2": {"diagnose.report.page"},
}
DYNAMIC = ("import_module", "__import__", "spec_from_file_location", "exec_module", "run_path", "run_module")
BY_ANY_NAME = {"physics.content", "physics.cache"}  # what files name, and programs composed on the spot
ROOT = Path(__file__).parents[1]
CONTROLLERS = sorted((ROOT / "controllers").glob("*.py"))
OURS = {  # "physics.effects.fan_wind" -> its file; "physics.effects" is the package itself
    ".".join(path.relative_to(ROOT / "boatsim").with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted((ROOT / "boatsim").rglob("*.py"))
}


def imported(path: Path) -> set[str]:
    """Full names of all a file imports, inside functions and by `import_module("name")` too."""
    names = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level:
            assert path.parent == KERNEL, f"{path}:{node.lineno}: write the full name, so that this test can see it"
            names.add("boatsim.physics.kernel" + ("" if f"{node.module}.py" in WRITTEN else f".{node.module}"))
        elif isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif (name := by_name(node)) is not None:
            names.add(name)
    return names


def by_name(node: ast.AST) -> str | None:
    """What a call imports by its name, "" where only a run would tell; None if it imports nothing so."""
    if not isinstance(node, ast.Call) or ast.unparse(node.func).split(".")[-1] not in DYNAMIC:
        return None
    first = node.args[0] if node.args else None
    return first.value if isinstance(first, ast.Constant) and isinstance(first.value, str) else ""


def own(path: Path) -> set[str]:
    """Our modules among them: boatsim.physics.effects.fan_wind.law is `physics.effects.fan_wind`."""
    names = [name.split(".")[1:] for name in imported(path) if name.split(".")[0] == "boatsim"]
    parts = [[".".join(name[:n]) for n in range(len(name), 0, -1)] for name in names]
    return {next((part for part in longest_first if part in OURS), "__init__") for longest_first in parts}


def level(name: str) -> int:
    first = name.split(".")[0]
    assert first in LEVEL, f"boatsim/{first} stands in no layer: add it to LAYERS in tests/test_arrows.py"
    return LEVEL[first]


@pytest.mark.parametrize("name", OURS)
def test_a_module_imports_from_its_own_layer_and_lower_ones_only(name: str) -> None:
    above = [other for other in own(OURS[name]) if level(other) > level(name)]
    assert not above, f"{name} imports {above} from a layer above its own"


@pytest.mark.parametrize("name", OURS)
def test_only_content_and_programs_are_imported_by_a_name_that_is_found_in_a_run(name: str) -> None:
    assert name in BY_ANY_NAME or "" not in imported(OURS[name])


def test_an_import_by_name_counts_as_one(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text('from importlib import import_module\nimport_module("boatsim.view.scene")\n')
    assert own(tmp_path / "a.py") == {"view.scene"}


def test_no_imports_form_a_ring() -> None:
    order = TopologicalSorter({name: own(path) - {name} for name, path in OURS.items()})
    assert set(order.static_order()) >= set(OURS)  # raises CycleError, which names the ring


@pytest.mark.parametrize("path", CONTROLLERS, ids=lambda path: path.stem)
def test_a_controller_knows_nothing_of_the_simulator(path: Path) -> None:
    assert own(path) <= FOR_CONTROLLERS


@pytest.mark.parametrize("library", HEAVY)
def test_a_heavy_library_is_imported_in_its_place_only(library: str) -> None:
    files = OURS | {f"controllers/{path.stem}": path for path in CONTROLLERS}
    users = {name for name, path in files.items() if library in {full.split(".")[0] for full in imported(path)}}
    assert users <= HEAVY[library]
