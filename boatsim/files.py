"""Files in and out: TOML checked against a pydantic model, each mistake one clear line; writing all or nothing."""

import os
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import date, time
from pathlib import Path
from typing import IO, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from boatsim.errors import BadInput, unknown_name

# What TOML and JSON say, as tomllib and json read it; a point in time is a date
Value: TypeAlias = (
    "None | str | bool | int | float | date | time | Sequence[Value] | Mapping[str, Value]"
)

LARGEST = 1 << 20  # bytes of a TOML file
DEEPEST = 32  # tables and lists within each other
WHOLE = 1 << 63  # beyond all integers that TOML promises to read
DOTTED = re.compile(
    r"""(?<![\w-])(?:(?:[\w-]{1,200}+|"[^"\n]{0,200}"|'[^'\n]{0,200}')[ \t]{0,9}\.[ \t]{0,9}){32}"""
)


class Table(BaseModel):
    """A table of a file: unknown keys are refused, numbers must be finite."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


T = TypeVar("T", bound=Table)


def read_toml(path: Path) -> dict[str, Value]:
    """Raw content; raises BadInput with the parser's own line and column, or for what is no honest size."""
    try:
        with path.open("rb") as file:
            raw = file.read(LARGEST + 1)
        if len(raw) > LARGEST:
            raise BadInput(f"{path}: more than {LARGEST} bytes; no file of ours is that large")
        text = raw.decode("utf-8-sig")
        if DOTTED.search(text):  # the parser's time grows with the square of their number
            raise RecursionError
        found: dict[str, Value] = tomllib.loads(text)
        _check_sizes(found)
        return found
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file") from None
    except RecursionError:
        raise BadInput(
            f"{path}: not a TOML file (tables or lists more than {DEEPEST} deep)"
        ) from None
    except (ValueError, OSError) as error:
        said = (
            error.strerror if isinstance(error, OSError) else str(error).partition("; use sys.")[0]
        )
        raise BadInput(f"{path}: not a TOML file ({said})".replace("\n", " ")) from None


def _check_sizes(content: Mapping[str, Value]) -> None:
    """Raises RecursionError for what is nested too deep, ValueError for an integer that TOML has no room for."""
    left: list[tuple[str, object, int]] = [("", content, 0)]
    while left:
        key, value, depth = left.pop()
        if depth > DEEPEST:
            raise RecursionError
        if isinstance(value, dict):
            left += [(str(k), v, depth + 1) for k, v in value.items()]
        elif isinstance(value, list):
            left += [(key, v, depth + 1) for v in value]
        elif isinstance(value, int) and abs(value) >= WHOLE:
            raise ValueError(
                f"{key} is an integer of {len(str(abs(value)))} digits; allowed are those of 64 bits"
            )


def checked(model: type[T], data: Mapping[str, object], file: str) -> T:
    """`data` as `model`; raises BadInput naming file, key, value found, what is allowed and the nearest valid key."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise BadInput(f"{file}: {_line(model, error)}") from None


def tables(value: object) -> list[dict[str, Value]]:
    """The tables of what may be a list of them: [[effect]], [[case]]."""
    return [table for table in value if isinstance(table, dict)] if isinstance(value, list) else []


def _line(model: type[BaseModel], error: ValidationError) -> str:
    """First mistake of a validation in words."""
    first = min(
        error.errors(), key=lambda e: e["type"] != "extra_forbidden"
    )  # a misspelt key is also a missing one
    place = ".".join(str(p) for p in first["loc"])
    if first["type"] == "extra_forbidden":
        table = ".".join(str(p) for p in first["loc"][:-1])
        return unknown_name(
            f"key{f' in [{table}]' if table else ''}",
            str(first["loc"][-1]),
            _keys(model, first["loc"]),
        )
    if first["type"] == "missing":
        return f"{place} is missing"
    said = first["msg"].removeprefix("Value error, ").lower()
    return f"{place} = {first['input']!r}; {said}" if place else said  # of the file as a whole


def _keys(model: type[BaseModel], place: tuple[int | str, ...]) -> list[str]:
    """Names allowed in the table a wrong key stands in."""
    for key in place[:-1]:
        if not isinstance(key, str) or key not in model.model_fields:
            continue
        kinds = [
            model.model_fields[key].annotation,
            *getattr(model.model_fields[key].annotation, "__args__", ()),
        ]
        model = next((k for k in kinds if isinstance(k, type) and issubclass(k, BaseModel)), model)
    return list(model.model_fields)


class Growing:
    """A file that grows by whole pieces: of one that can not be written, such as on a full disk, nothing stays."""

    def __init__(self, file: IO[bytes], path: Path, whole: int = 0) -> None:
        """`file` is open for writing and not buffered, its first `whole` bytes stay; errors name it by its `path`."""
        self._file, self._path, self._whole = file, path, whole

    def add(self, data: bytes) -> None:
        """One more piece. Raises OSError that names the file."""
        left = memoryview(data)
        try:
            self._file.seek(self._whole)
            while left:
                left = left[self._file.write(left) :]
        except BaseException as error:
            with suppress(OSError):
                self._file.truncate(self._whole)
            if isinstance(error, OSError):
                raise OSError(error.errno, error.strerror, str(self._path)) from error
            raise
        self._whole += len(data)

    def take_back(self, count: int) -> None:
        """The last `count` bytes do not count: what comes next is written over them."""
        self._whole -= count

    def close(self) -> None:
        """No more pieces."""
        self._file.close()


@contextmanager
def replacing(path: Path | str) -> Iterator[Path]:
    """A temporary name beside `path` to write to; it takes the place of `path` at the end if nothing was raised.

    Only a process that is killed leaves it behind, and it says what it is: `run.part-1234.csv`.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # keeps the ending, by which writers choose the format
    temporary = path.with_name(f"{path.stem}.part-{os.getpid()}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def home_folder() -> Path | None:
    """The user's home by its real place; None where nobody says which it is."""
    try:
        return Path.home().resolve()
    except (RuntimeError, OSError):
        return None
