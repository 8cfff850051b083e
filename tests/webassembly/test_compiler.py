"""The compilers for WebAssembly that are found, and what a user reads where there is none."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from boatsim.cli.commands import app
from boatsim.webassembly import compiler
from boatsim.webassembly.compiler import NoWasmCompiler, WasmCompiler, compile_to_wasm

MAGIC = b"\x00asm\x01\x00\x00\x00"  # the first bytes of a WebAssembly module of version 1


def test_without_a_compiler_the_command_ends_in_one_line_before_it_reads_a_recording(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(compiler, "_candidates", list)
    for command in (
        ["diagnose", str(tmp_path / "none.csv"), "--what-if", "--out", str(tmp_path / "out")],
        ["demo", "--what-if", "--out", str(tmp_path / "out")],
    ):
        done = CliRunner().invoke(app, command)
        assert done.exit_code == 2
        assert done.stderr.count("\n") == 1 and "boatsim[wasm]" in done.stderr
    assert not (tmp_path / "out").exists()


def test_sliders_do_not_apply_to_a_table_of_many_diagnoses(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["diagnose", str(tmp_path), "--each", "--what-if"])
    assert done.exit_code == 2 and "--what-if does not apply with --each" in done.stderr


def test_a_compiler_that_lacks_the_target_is_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    missing = WasmCompiler(("/no/such/clang",), ("/no/such/wasm-ld",))
    failing = WasmCompiler(("false",), ("false",))
    monkeypatch.setattr(compiler, "_candidates", lambda: [missing, failing])
    with pytest.raises(NoWasmCompiler, match="clang with wasm-ld"):
        compiler.find_compiler()
    with pytest.raises(NoWasmCompiler, match="/no/such/clang"):
        compile_to_wasm(compiler.TRIVIAL, missing)


def test_equal_sources_give_equal_modules() -> None:
    try:
        found = compiler.find_compiler()
    except NoWasmCompiler as error:
        pytest.skip(str(error))
    first, again = (compile_to_wasm(compiler.TRIVIAL, found) for _ in range(2))
    assert first == again and first.startswith(MAGIC) and len(first) < 200
    with pytest.raises(NoWasmCompiler, match="error"):
        compile_to_wasm("int main(", found)
