"""Imports between our own modules point down the layers, never round in a ring, and heavy libraries stay in place."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

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
ROOT = Path(__file__).parents[1]
CONTROLLERS = sorted((ROOT / "controllers").glob("*.py"))
OURS = {  # "effects.fan_wind" -> its file; "effects" is the package itself
    ".".join(path.relative_to(ROOT / "boatsim").with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted((ROOT / "boatsim").rglob("*.py"))
}


def imported(path: Path) -> set[str]:
    """Full names of all a file imports, inside functions too."""
    names = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}:{node.lineno}: write the full name, so that this test can see it"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def own(path: Path) -> set[str]:
    """Our modules among them: boatsim.physics.effects.fan_wind.law is `effects.fan_wind`."""
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
