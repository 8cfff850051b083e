"""The command line prints warnings of boatsim as notes of one line."""

import subprocess
import sys
import warnings

import pytest

from boatsim.cli import exits
from boatsim.physics.native.build import SlowCompilationWarning

COMMAND_LINE = """
import warnings
from boatsim.cli import application
from boatsim.physics.native.build import NoCompiler, warn_of_slow_compilation

def app():
    for _ in range(2):
        warn_of_slow_compilation(NoCompiler("no C\\ncompiler"))
    raise SystemExit(0)

application.app = app
application.main()
"""


def test_the_command_line_prints_a_warning_as_one_line_on_stderr() -> None:
    done = subprocess.run([sys.executable, "-c", COMMAND_LINE], capture_output=True, text=True)
    assert done.returncode == 0 and not done.stdout
    [line] = done.stderr.splitlines()
    assert line.startswith("note: numba compiles the vessel, which takes longer than a C compiler")
    assert "first used: no C compiler; BOATSIM_NATIVE=0" in line


def test_warnings_of_others_are_printed_as_python_prints_them(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    others = list[str]()
    monkeypatch.setattr(warnings, "showwarning", lambda *a: others.append(str(a[0])))
    exits.print_warnings_as_notes()
    warnings.showwarning(UserWarning("of others"), UserWarning, "file.py", 1)
    warnings.showwarning(SlowCompilationWarning("of boatsim"), SlowCompilationWarning, "file.py", 1)
    assert others == ["of others"]
    assert capsys.readouterr().err == "note: of boatsim\n"
