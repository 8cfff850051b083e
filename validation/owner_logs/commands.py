"""The commands of a user, run in this process: exit code and printed output."""

import contextlib
import io
import json
import re
import time
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class CommandResult:
    """Result of a command."""

    code: int
    out: str
    err: str
    seconds: float

    @property
    def last(self) -> str:
        """The last line of the error output."""
        lines = [line for line in self.err.splitlines() if line.strip()]
        if lines:
            return lines[-1]
        return ""


def run_boatsim(*arguments: str | Path) -> CommandResult:
    """Run a command; a crash gives exit code 99."""
    from boatsim.cli.commands import app

    out, err, begin = io.StringIO(), io.StringIO(), time.time()
    code: Any = 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            app([str(a) for a in arguments])
        except SystemExit as left:
            code = left.code
        except BaseException as crash:  # a user would get a traceback
            if isinstance(crash, KeyboardInterrupt):
                raise
            code = 99
            err.write(f"traceback: {type(crash).__name__}: {crash}\n")
    return CommandResult(int(code or 0), out.getvalue(), err.getvalue(), time.time() - begin)


@dataclass(frozen=True)
class Finding:
    """A fault that `boatsim check` reported."""

    name: str
    sure: float
    lines: tuple[str, ...] = ()
    allowed: bool = False  # a diagnosis accounts for it without advice


FOUND = re.compile(r"^  (?P<name>[a-z][a-z _]*) \(probability (?P<sure>[\d.]+) %\)")
ALLOWED = "a diagnosis allows for it"
WRITE = "    write into recording.toml: "
LIMIT = "  cannot be identified: "


def parse_findings(result: CommandResult) -> list[Finding]:
    """Parse the findings in the printed text."""
    found: list[Finding] = []
    for line in result.out.splitlines():
        if match := FOUND.match(line):
            found.append(
                Finding(match["name"].strip().replace(" ", "_"), float(match["sure"]) / 100.0)
            )
        elif line.startswith(WRITE) and found:
            found[-1] = replace(found[-1], lines=tuple(line.removeprefix(WRITE).split(" / ")))
        elif line.strip() == ALLOWED and found:
            found[-1] = replace(found[-1], allowed=True)
    return found


def parse_limits(result: CommandResult) -> list[str]:
    """Return what `boatsim check` says cannot be identified, without the title of each line."""
    return [line.removeprefix(LIMIT) for line in result.out.splitlines() if line.startswith(LIMIT)]


def add_to_notes(file: Path, lines: Sequence[str]) -> None:
    """Follow the advice of `boatsim check`: add the lines to a recording.toml."""
    table = tomllib.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    file.write_text(
        "\n".join(_text(_merge_tables(table, tomllib.loads("\n".join(lines))))) + "\n",
        encoding="utf-8",
    )


def _merge_tables(table: dict[str, Any], more: dict[str, Any]) -> dict[str, Any]:
    merged = {}
    for k, v in more.items():
        merged[k] = _merge_tables(table.get(k, {}), v) if isinstance(v, dict) else v
    return {**table, **merged}


def _text(table: dict[str, Any], above: str = "") -> list[str]:
    """Return the TOML lines of a table, its own keys before nested tables."""
    own = [f"{_key(k)} = {json.dumps(v)}" for k, v in table.items() if not isinstance(v, dict)]
    head = [f"[{above}]"] if above and own else []
    inner = [
        line
        for k, v in table.items()
        if isinstance(v, dict)
        for line in _text(v, f"{above}.{_key(k)}" if above else _key(k))
    ]
    return [*head, *own, *inner]


def _key(name: str) -> str:
    if re.fullmatch(r"[A-Za-z0-9_-]+", name):
        return name
    return json.dumps(name)
