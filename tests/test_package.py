"""What is shipped: a light import, a lock that names no host, one version, one test command."""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import boatsim

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LOCK = (ROOT / "requirements.lock").read_text(encoding="utf-8")
LOCKED = re.findall(r"^([a-z0-9-]+)==\S+( ; [^\\]+)?", LOCK, re.M)  # name, environment marker
TEST_COMMAND = "./setup.sh && .venv/bin/python -m pytest"


def test_importing_boatsim_imports_nothing_heavy() -> None:
    heavy = {
        "mujoco",
        "numba",
        "scipy",
        "rerun",
        "pyarrow",
        "dm_control",
        "pydantic",
        "jinja2",
        "typer",
    }
    code = "import sys, boatsim; print(*{name.partition('.')[0] for name in sys.modules})"
    loaded = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert "boatsim" in loaded.split()
    assert not heavy & set(loaded.split())


def test_every_locked_requirement_has_a_hash_and_no_address() -> None:
    assert LOCKED and len(LOCKED) == len(set(LOCKED))  # one version for each environment
    entry = re.compile(
        r"[a-z0-9-]+==[\w.]+( ; [\w '=!<>.]+)?( \\\n    --hash=sha256:[0-9a-f]{64})+"
    )
    for text in re.split(r"\n(?=\S)", LOCK.strip()):
        assert entry.fullmatch(text), text


def test_the_lock_has_every_direct_dependency() -> None:
    extras = PROJECT["optional-dependencies"]
    direct = [*PROJECT["dependencies"], *extras["test"], *extras["docs"]]
    assert {re.split(r"[<>=\[ ]", line)[0] for line in direct} <= {name for name, _ in LOCKED}


def test_one_version_in_the_project_the_package_and_the_changelog() -> None:
    assert boatsim.__version__ == version("boatsim") == PROJECT["version"]
    assert PROJECT["version"] in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_readme_and_ci_run_the_same_test_command() -> None:
    for file in ("README.md", ".ci/run"):
        assert TEST_COMMAND in (ROOT / file).read_text(encoding="utf-8"), file
