"""Reading of TOML files with checks by pydantic models, and atomic writing of files."""

import csv
import json
import os
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import date, time
from functools import lru_cache
from itertools import repeat
from pathlib import Path
from typing import IO, TYPE_CHECKING, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from boatsim.arguments import short_repr
from boatsim.errors import BadInput, unknown_name_message

# A value of TOML or JSON, as tomllib and json read it; a datetime is a date
Value: TypeAlias = (
    "None | str | bool | int | float | date | time | Sequence[Value] | Mapping[str, Value]"
)

MAX_TOML_BYTES = 1 << 20
# Contents of files kept after parsing: a scenario file with many cases is read once per case, and
# several vessels and scenarios may be based on it
PARSED_FILES = 64
MAX_DEPTH = 32  # of tables and lists within each other
INTEGER_LIMIT = 1 << 63  # TOML guarantees integers of 64 bits only
DOTTED = re.compile(
    r"""(?<![\w-])(?:(?:[\w-]{1,200}+|"[^"\n]{0,200}"|'[^'\n]{0,200}')[ \t]{0,9}\.[ \t]{0,9}){32}"""
)

# pydantic adds the kind of value that it tried to the place of a mistake, if several are allowed
KINDS_OF_VALUE = ("float", "bool", "str", "int")


if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass as TableType
else:

    class TableType(type(BaseModel)):
        """Class of the models of TOML tables: those built in Python raise BadInput for mistakes."""

        def __call__(cls, *args: object, **values: object) -> object:
            """Return a table with these values.

            Raises:
                BadInput: With the name of the first value that is not allowed.
            """
            try:
                return super().__call__(*args, **values)
            except ValidationError as error:
                raise BadInput(f"{cls.__name__}: {_first_mistake(cls, error)}") from None


class Table(BaseModel, metaclass=TableType):
    """Base class of the models of TOML tables, which reject unknown keys and non-finite numbers."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


T = TypeVar("T", bound=Table)


def read_toml(path: Path) -> dict[str, Value]:
    """Read a TOML file and return its content.

    Raises:
        BadInput: With line and column of a syntax error, or for a file that is too large or too
            deeply nested.
    """
    try:
        with path.open("rb") as file:
            raw = file.read(MAX_TOML_BYTES + 1)
        if len(raw) > MAX_TOML_BYTES:
            raise BadInput(
                f"{path}: more than {MAX_TOML_BYTES} bytes; larger TOML files are not read"
            )
        return {key: _copied(value) for key, value in _parse_toml(raw).items()}
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file") from None
    except RecursionError:
        raise BadInput(
            f"{path}: not a TOML file (tables or lists more than {MAX_DEPTH} deep)"
        ) from None
    except (ValueError, OSError) as error:
        reason = str(error).partition("; use sys.")[0]
        if isinstance(error, OSError):
            reason = str(error.strerror)
        raise BadInput(f"{path}: not a TOML file ({reason})".replace("\n", " ")) from None


@lru_cache(maxsize=PARSED_FILES)
def _parse_toml(raw: bytes) -> dict[str, Value]:
    """Content of a TOML file, which callers must not change.

    Raises ValueError, or RecursionError for too deep nesting.
    """
    text = raw.decode("utf-8-sig")
    if DOTTED.search(text):  # the parser's time grows with the square of the dots
        raise RecursionError
    found: dict[str, Value] = tomllib.loads(text)
    _check_sizes(found)
    return found


def _copied(value: Value) -> Value:
    """A copy whose tables and lists a caller may change."""
    if isinstance(value, dict):
        return {key: _copied(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return list(map(_copied, value))
    return value


def _check_sizes(content: Mapping[str, Value]) -> None:
    """Raise RecursionError for too deep nesting, ValueError for integers beyond 64 bits."""
    pending: list[tuple[str, object, int]] = [("", content, 0)]
    while pending:
        key, value, depth = pending.pop()
        if depth > MAX_DEPTH:
            raise RecursionError
        if isinstance(value, dict):
            for inner_key, inner in value.items():
                pending.append((str(inner_key), inner, depth + 1))
        elif isinstance(value, list):
            pending += zip(repeat(key), value, repeat(depth + 1))
        elif isinstance(value, int) and abs(value) >= INTEGER_LIMIT:
            raise ValueError(
                f"{key} is an integer of {len(str(abs(value)))} digits; allowed are those of 64 "
                "bits"
            )


def validate_table(model: type[T], data: Mapping[str, object], file: str) -> T:
    """Check the content of a TOML file against a pydantic model; return the model's instance.

    Args:
        model: Pydantic model of the table.
        data: The table.
        file: Name of the file in messages.

    Raises:
        BadInput: With file, key, value found, what is allowed and the nearest valid key.
    """
    try:
        # strictly as JSON: a string or a truth value is no number, and a list may be a tuple
        return model.model_validate_json(json.dumps(data, default=_plain_value), strict=True)
    except ValidationError as error:
        raise BadInput(f"{file}: {_first_mistake(model, error)}") from None
    except (TypeError, ValueError, RecursionError) as error:  # of json: a key is no text, a circle
        raise BadInput(f"{file}: {' '.join(str(error).split())}") from None


def _plain_value(value: object) -> object:
    """A value that JSON lacks: a table that was checked before, an array as lists, or its text."""
    if isinstance(value, BaseModel):
        return value.model_dump()
    to_list = getattr(value, "tolist", None)
    return to_list() if to_list else str(value)


def array_of_tables(value: object) -> list[dict[str, Value]]:
    """Return the tables of a TOML array of tables such as [[effect]]; none if it is no array."""
    if not isinstance(value, list):
        return []
    return [table for table in value if isinstance(table, dict)]


def _first_mistake(model: type[BaseModel], error: ValidationError) -> str:
    """Message of the first mistake of a validation."""
    # A misspelt key is also a missing one
    first = min(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    place = ".".join(str(key) for key in first["loc"] if key not in KINDS_OF_VALUE)
    if first["type"] == "extra_forbidden":
        table = ".".join(map(str, first["loc"][:-1]))
        what = "key"
        if table:
            what = f"key in [{table}]"
        return unknown_name_message(what, str(first["loc"][-1]), _allowed_keys(model, first["loc"]))
    if first["type"] == "missing":
        return f"{place} is missing"
    message = first["msg"].removeprefix("Value error, ").lower()
    if not place:
        return message
    if message == "input should be an object":
        message = f"allowed is a table, [{place}]"
    return f"{place} = {short_repr(first['input'])}; {message}"


def _allowed_keys(model: type[BaseModel], place: tuple[int | str, ...]) -> list[str]:
    """Allowed keys of the table that has a wrong key."""
    for key in place[:-1]:
        if not isinstance(key, str) or key not in model.model_fields:
            continue
        kinds = [
            model.model_fields[key].annotation,
            *getattr(model.model_fields[key].annotation, "__args__", ()),
        ]
        for kind in kinds:
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                model = kind
                break
    return list(model.model_fields)


class AppendedFile:
    """A file to which pieces of data are appended, each of them completely or not at all.

    A piece that cannot be written, as on a full disk, leaves no trace.
    """

    def __init__(self, file: IO[bytes], path: Path, whole: int = 0) -> None:
        """Append to an open file.

        Args:
            file: Unbuffered file, open for writing.
            path: Name of the file in errors.
            whole: Number of bytes at the beginning that are kept.
        """
        self._file, self._path, self._whole = file, path, whole

    def append(self, data: bytes) -> None:
        """Append a piece of data to the file. Raises OSError with the name of the file."""
        rest = memoryview(data)
        try:
            self._file.seek(self._whole)
            while rest:
                rest = rest[self._file.write(rest) :]
        except BaseException as error:
            with suppress(OSError):
                self._file.truncate(self._whole)
            if isinstance(error, OSError):
                raise OSError(error.errno, error.strerror, str(self._path)) from error
            raise
        self._whole += len(data)

    def truncate_end(self, count: int) -> None:
        """Discard the last `count` bytes of the file: the next piece replaces them."""
        self._whole -= count

    def close(self) -> None:
        """Close the file to which data were appended."""
        self._file.close()


def read_csv(path: Path) -> list[list[str]]:
    """Return the rows of a CSV file in UTF-8, with or without a byte order mark.

    Args:
        path: The file.

    Raises:
        BadInput: The file cannot be read.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            return list(csv.reader(file))
    except (UnicodeDecodeError, csv.Error) as error:
        raise BadInput(f"{path}: no CSV file in UTF-8: {error}") from None
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None


def toml_value(value: object) -> str:
    """Return a text, number, truth value or list of these as TOML text.

    Args:
        value: The value; characters of a text that are not printable are escaped.
    """
    if isinstance(value, list):
        return f"[{', '.join(map(toml_value, value))}]"
    if not isinstance(value, str):
        return json.dumps(value)  # TOML has JSON's syntax for these
    text = ""
    for character in value.encode("utf-8", "backslashreplace").decode("utf-8"):
        if character in ('"', "\\"):
            character = f"\\{character}"
        elif not character.isprintable():
            character = f"\\U{ord(character):08x}"
        text += character
    return f'"{text}"'


def toml_key(name: str) -> str:
    """Return a key as TOML text, in quotation marks where it needs them."""
    if re.fullmatch(r"[A-Za-z0-9_-]+", name):
        return name
    return toml_value(name)


@contextmanager
def replace_file(path: Path | str) -> Iterator[Path]:
    """Replace a file only after its new content is completely written.

    Yields a temporary file, which replaces the file when the block ends, unless the block raises. A
    process that is killed may leave a temporary file such as `run.part-1234.csv`.

    Args:
        path: The file.

    Yields:
        Path of a temporary file in the same folder, to be written by the block.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    # The suffix is kept, for writers choose the format by it
    temporary = path.with_name(f"{path.stem}.part-{os.getpid()}{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def home_folder() -> Path | None:
    """Return the home folder of the user as an absolute path; None where it is unknown."""
    try:
        return Path.home().resolve()
    except (RuntimeError, OSError):
        return None
