"""Compiles freestanding C to WebAssembly, with the clang of the system, Zig, or PyPI's ziglang."""

import os
import shutil
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from boatsim.errors import BadInput
from boatsim.physics.native.build import EXACT, LONGEST

# As the C libraries of a program, without a C library of the target: the numbers stay those of
# numba, except for functions such as cos, which the browser computes.
FLAGS = ("-std=gnu11", "-O2", "-ffreestanding", "-fno-builtin", "-fvisibility=hidden", "-w", *EXACT)
LINK = ("--no-entry", "--strip-all", "--gc-sections", "-z", "stack-size=262144")
HEADERS = Path(__file__).parent / "c"
TRIVIAL = '__attribute__((export_name("one"))) int one(void) { return 1; }'


class NoWasmCompiler(BadInput):
    """Raised where no compiler can make WebAssembly."""


class WasmCompiler(NamedTuple):
    """Commands that compile C to an object file of WebAssembly, and that link it."""

    compile: tuple[str, ...]
    link: tuple[str, ...]


def find_compiler() -> WasmCompiler:
    """Return the first compiler of this computer that makes WebAssembly.

    In this order: `clang` with `wasm-ld`, `zig`, and the package `ziglang`. Each is tried on a
    small function, as a clang may lack this target.

    Raises:
        NoWasmCompiler: There is none.
    """
    for compiler in _candidates():
        try:
            _build(compiler, TRIVIAL)
        except NoWasmCompiler:
            continue
        return compiler
    raise NoWasmCompiler(
        "no compiler for WebAssembly: install boatsim[wasm], or clang with wasm-ld, or zig"
    )


def _candidates() -> list[WasmCompiler]:
    """Commands of the compilers that are installed."""
    found = []
    clang, linker, zig = map(shutil.which, ("clang", "wasm-ld", "zig"))
    if clang and linker:
        found.append(WasmCompiler((clang, "--target=wasm32-unknown-unknown"), (linker,)))
    package = find_spec("ziglang")
    if package is not None and package.origin is not None:
        bundled = shutil.which("zig", path=str(Path(package.origin).parent))
    else:
        bundled = None
    for program in (zig, bundled):
        if program:
            compile_ = (program, "cc", "-target", "wasm32-freestanding")
            found.append(WasmCompiler(compile_, (program, "wasm-ld")))
    return found


def compile_to_wasm(source: str, compiler: WasmCompiler) -> bytes:
    """Compile C source to a WebAssembly module; equal sources give equal bytes.

    Args:
        source: The C source, which includes no file but those of `boatsim/webassembly/c` and the
            headers that a freestanding compiler has.
        compiler: The compiler, from `find_compiler`.

    Returns:
        The binary module.

    Raises:
        NoWasmCompiler: The compiler cannot be run, or refuses the source.
    """
    return _build(compiler, source)


def _build(compiler: WasmCompiler, source: str) -> bytes:
    with tempfile.TemporaryDirectory(prefix="boatsim_wasm_") as folder:
        place = Path(folder)
        text, object_file, module = (place / f"program.{end}" for end in ("c", "o", "wasm"))
        text.write_text(source, encoding="utf-8")
        # Zig stores files, which go into this folder too.
        cache = {"ZIG_GLOBAL_CACHE_DIR": folder, "ZIG_LOCAL_CACHE_DIR": folder}
        include = ("-isystem", str(HEADERS))
        _run([*compiler.compile, *FLAGS, *include, "-c", str(text), "-o", str(object_file)], cache)
        _run([*compiler.link, *LINK, "-o", str(module), str(object_file)], cache)
        return module.read_bytes()


def _run(command: list[str], variables: dict[str, str]) -> None:
    """Run a command of a compiler. Raises NoWasmCompiler."""
    environment = {**os.environ, **variables}
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=LONGEST, env=environment
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoWasmCompiler(f"{command[0]}: {error}") from None
    if done.returncode:
        raise NoWasmCompiler(f"{command[0]}: {' '.join(done.stderr.split())[:200]}")
