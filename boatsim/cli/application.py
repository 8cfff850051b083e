"""The command line itself: its groups, exit codes and errors in one line."""

import atexit
import functools
import os
import re
import sys
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, NoReturn, ParamSpec

import typer
from typer.core import TyperGroup

from boatsim.cli.exits import (
    FAULTS,
    Exit,
    escape_unencodable,
    one_line,
    print_error,
    print_warnings_as_notes,
)
from boatsim.errors import nearest_hint
from boatsim.interruption import raise_on_signals, signal_received
from boatsim.quiet import exit_on_signals
from boatsim.version import version as installed

P = ParamSpec("P")


# Base class of all command-line errors; Typer exports only its subclass BadParameter.
UsageError: Any = typer.BadParameter.__base__


# Headings of the help text with their commands; a test checks that none is missing
COMMAND_GROUPS = {
    "Start here": ("demo",),
    "Simulate": (
        "run",
        "drive",
        "sitl",
        "sweep",
        "test",
        "manoeuvre",
        "linearise",
        "margins",
        "robustness",
        "tune",
        "capability",
    ),
    "Look at results": ("open",),
    "Learn from recordings": ("import", "check", "diagnose", "replay", "compare", "export"),
    "Vessels and content": ("new", "hydrostatics", "hydrodynamics", "spectrum", "list", "show"),
}


class OneLineGroup(TyperGroup):
    """Group of boatsim's commands; reports usage errors in one line, prints help by default."""

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        *_: object,
        **__: object,
    ) -> NoReturn:
        """Run the command line of boatsim and exit with its exit code.

        Args:
            args: Command-line arguments; None for those of the process.
            prog_name: Name of the program in the help texts.
        """
        if args is None:
            args = sys.argv[1:]
        escape_unencodable()
        try:
            code = super().main(list(args) or ["--help"], prog_name, standalone_mode=False)
        except UsageError as error:
            command = "boatsim"
            if error.ctx:
                command = error.ctx.command_path
            message = " ".join(error.format_message().split()).rstrip(".")
            see = " See" if message.endswith("?") else "; see"
            print_error(f"{message}{see} {command} --help")
            code = Exit.BAD_INPUT
        sys.exit(code)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command by its name.

        Args:
            ctx: Context of the command line.
            cmd_name: Name of the command.

        Raises:
            UsageError: There is no such command.
        """
        found = super().get_command(ctx, cmd_name)
        if found is None:
            hint = nearest_hint(cmd_name, self.commands)
            raise UsageError(f"command {cmd_name!r} does not exist{hint}", ctx)
        return found

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands into the help text, by purpose, with the first sentence of each.

        Args:
            ctx: Context of the command line.
            formatter: Formatter of the help text.
        """
        for heading, names in COMMAND_GROUPS.items():
            rows = []
            for name in names:
                sentence, _, _ = (self.commands[name].help or "").partition("\n\n")
                rows.append((name, " ".join(sentence.split())))
            with formatter.section(heading):
                formatter.write_dl(rows)


app = typer.Typer(
    name="boatsim",
    cls=OneLineGroup,
    help="Simulate small boats on MuJoCo, test controllers, find the physics that a model lacks.",
    add_completion=False,
    suggest_commands=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def exits_with_code(command: Callable[P, int | None]) -> Callable[P, None]:
    """Decorate a command so that it exits with the code it returns and prints errors in one line.

    Args:
        command: Function of a command; it returns its exit code, or None for 0.

    Returns:
        The function that Typer calls.
    """

    @functools.wraps(command)
    def wrapper(*args: P.args, **options: P.kwargs) -> None:
        raise typer.Exit(_exit_code(lambda: command(*args, **options) or 0))

    return wrapper


def _exit_code(command: Callable[[], int]) -> int:
    """Call a command; print its error, if any, and return the exit code."""
    try:
        return command()
    except FAULTS as error:
        print_error(one_line(error))
        return Exit.BAD_INPUT
    except KeyboardInterrupt:
        print_error("interrupted")
        return Exit.INTERRUPTED
    except MemoryError:
        print_error(
            "out of memory; use a shorter recording, a longer step or a longer interval `log`"
        )
        return Exit.BAD_INPUT
    except Exception as error:
        if (
            signal_received()
        ):  # The interruption came inside code that turns it into another error (numba).
            print_error("interrupted")
            return Exit.INTERRUPTED
        if not type(error).__module__.startswith("numba."):
            raise
        print_error(
            f"numba cannot compile an effect: {_numba_message(error)}; the function of an effect "
            "takes floats and allocates no memory"
        )
        return Exit.BAD_INPUT


def _numba_message(error: Exception) -> str:
    """The first source location in a numba error, and its first informative line."""
    message = type(error).__name__
    for line in str(error).splitlines():
        words = " ".join(line.split())
        if words and not words.startswith("Failed in"):
            message = words.rstrip(":")
            break
    location = re.search(r'File "([^"]+)", line (\d+)', str(error))
    if location:
        return f"{Path(location[1]).name}:{location[2]}: {message}"
    return message


def _print_version(requested: bool) -> None:
    if requested:
        print(f"boatsim {installed()}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version and exit."
        ),
    ] = False,
) -> None:
    """Options before the name of a command."""


def main() -> None:
    """Run the command line of boatsim and exit with its exit code.

    SIGTERM and SIGHUP end it in the same way as Ctrl-C.
    """
    raise_on_signals()
    print_warnings_as_notes()
    try:
        app()
    except SystemExit as error:
        exit_on_signals()
        _leave(int(error.code or 0))


def _leave(code: int) -> NoReturn:
    """End the process with an exit code after all clean-up that Python code has registered.

    The interpreter itself is not ended in its usual way: the threads of Arrow's pools are still
    alive then, which sometimes aborts the process ("terminate called without an active exception"),
    and after an interruption that Python code has handled it would exit with the code of an
    unhandled Ctrl-C.
    """
    # the steps of the interpreter itself when it ends: thread pools, then registered functions
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):  # a reader that has gone, a stream that is closed
            stream.flush()
    os._exit(code)
