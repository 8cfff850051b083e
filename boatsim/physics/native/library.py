"""A vessel's program in C: translated, compiled, kept on disk and called from Python.

A C compiler makes the program of a diagnosis in about a tenth of the time that numba needs
(`python -m benchmarks.native`). Both compute the same numbers to the last bit. There are three
libraries, `entries.LIBRARIES`: a vessel is simulated with the first one, the steps of a run are
recorded with the second, and recordings are analysed with the third. Each is compiled when it is
first needed. numba compiles the program where there is no C compiler or it fails, which causes a
warning, where a law has no C form, and with `BOATSIM_NATIVE=0`.
"""

from functools import cache
from pathlib import Path
from typing import Any

from boatsim.physics.native.build import NoCompiler, load_library, warn_of_slow_compilation
from boatsim.physics.native.calls import NativeFunction, argument_kinds
from boatsim.physics.native.declarations import NotTranslatable
from boatsim.physics.native.entries import LIBRARIES, library_functions
from boatsim.physics.native.exports import export_function
from boatsim.physics.native.mujoco_callback import add_mujoco_callback, compiled_mujoco_callback
from boatsim.physics.native.translate import Translation

PREFIX = "boatsim_"  # of the functions of a library
CALLBACK = "compile_passive_callback"  # function of a program for which there is another in C


def translate_program(module: Any, library: str) -> str:
    """Translate functions of a program that Python calls, and all that they call, to C.

    Args:
        module: The program's package.
        library: Which functions: one of `LIBRARIES`.

    Raises:
        NotTranslatable: A law has no C form.
    """
    program = Translation()
    for name, entry in library_functions(module, library).items():
        kinds = argument_kinds(program, entry)
        export_function(program, PREFIX + name, getattr(module, name), kinds)
    if has_callback(module, library):
        add_mujoco_callback(program, module)
    return program.source_text


def has_callback(module: Any, library: str) -> bool:
    """Return whether a C library of a program contains MuJoCo's passive-force callback.

    Args:
        module: The program's package.
        library: One of `LIBRARIES`.
    """
    return library == "simulation" and not module.CANDIDATES


class NativeProgram:
    """A program whose functions come from its C libraries where these have them, else from numba.

    Attributes:
        module: The program's package.
    """

    def __init__(self, module: Any, library: str) -> None:
        """Load or build one of the libraries.

        Args:
            module: The program's package, for constants and all other functions.
            library: The library that is needed first; the others follow with their first call.

        Raises:
            NoCompiler: There is no C compiler, or it fails.
            NotTranslatable: A law has no C form.
        """
        self.module = module
        later = {name for every in LIBRARIES for name in library_functions(module, every)}
        for name, value in vars(module).items():
            if name not in later and name != CALLBACK:
                self.__dict__[name] = value
        self._load(library)

    def _load(self, library: str) -> None:
        folder = Path(self.module.__file__).parent
        loaded = load_library(folder, library, lambda: translate_program(self.module, library))
        for name, entry in library_functions(self.module, library).items():
            if name not in self.__dict__:
                self.__dict__[name] = NativeFunction(getattr(loaded, PREFIX + name), entry)
        if has_callback(self.module, library):
            self.__dict__[CALLBACK] = compiled_mujoco_callback(loaded)

    def __getattr__(self, name: str) -> Any:
        """Return what the loaded libraries do not have: from another one, else from the package."""
        for library in LIBRARIES:
            called_back = name == CALLBACK and has_callback(self.module, library)
            if called_back or name in library_functions(self.module, library):
                try:
                    self._load(library)
                except NotTranslatable:
                    break
                except NoCompiler as error:
                    warn_of_slow_compilation(error)
                    break
                return self.__dict__[name]
        return getattr(self.module, name)


@cache
def native_program(module: Any, library: str, command: str) -> NativeProgram:
    """Load the C library of a program; return the program with its functions from C.

    Args:
        module: The program's package.
        library: The library that is needed first.
        command: Path of the C compiler, `build.compiler_path()`.

    Raises:
        NoCompiler: The compiler fails.
        NotTranslatable: A law has no C form.
    """
    return NativeProgram(module, library)
