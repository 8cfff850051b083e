"""Mutations of a tree of tables and lists: values of other types and sizes, keys dropped, renamed,
wrapped and exchanged, so that a changed file gets past its parser."""

import json
import tomllib
from collections.abc import Callable, Iterator
from copy import deepcopy
from dataclasses import dataclass
from datetime import date, time
from math import inf, isinf, isnan, nan
from typing import Any

from hypothesis import strategies as st

ANY: list[Any] = [
    None,
    True,
    False,
    0,
    3,
    -1,
    0.0,
    1.5,
    1e308,
    1e-308,
    nan,
    inf,
    -inf,
    2**62,
    -(2**63),
    10**400,
    "",
    "x",
    "surge",
    "x_m",
    "current",
    "/",
    "../x.py",
    "a" * 400,
    "9" * 400,
    "nan",
    "\0",
    "\u202e",
    "ü",
    [],
    [1, 2],
    ["a"],
    [[]],
    [{}],
    [{"a": 1}],
    [True],
    [1e308, 1],
    {},
    {"a": 1},
    {"use": "wind"},
    {"": {"": []}},
    date(1979, 5, 27),
    time(7, 32),
]
OBJECTS = [  # of `tests.fuzz.calls`
    f"{{{name}}}"
    for name in (
        "object",
        "bytes",
        "set",
        "array",
        "complex",
        "type",
        "function",
        "generator",
        "numpy int",
        "numpy float",
        "numpy bool",
        "circle",
        "mixed keys",
        "vessel",
        "scenario",
        "body",
        "log",
    )
]
ANY += OBJECTS
KINDS = ["value", "value", "value", "value", "scale", "drop", "copy", "key", "list", "table", "add"]
FACTORS = (-1.0, 0.0, 1e-9, 1e9, 1e300)
Path = tuple[str | int, ...]


@dataclass(frozen=True)
class TableEdit:
    """One change of a tree: what it does, at which of its nodes, and what it puts there.

    Attributes:
        kind: One of KINDS.
        at: Node, as a share of all.
        to: Another node, or which factor.
        value: Index into ANY.
    """

    kind: str
    at: float
    to: float
    value: int

    def of(self, tree: Any) -> Any:
        """The tree, changed; the given one stays as it is."""
        tree = deepcopy(tree)
        places = list(_places(tree))
        if not places:
            return tree
        place = _pick(places, self.at)
        *above, last = place
        holder = _find(tree, tuple(above))
        old, other = holder[last], deepcopy(_find(tree, _pick(places, self.to)))
        new = deepcopy(ANY[self.value])
        if self.kind == "drop":
            del holder[last]
        elif self.kind == "key" and isinstance(holder, dict):
            holder[new if isinstance(new, str) else "name"] = holder.pop(last)
        elif self.kind == "add" and isinstance(old, dict):
            old[_key(_pick(places, self.to))] = new
        elif self.kind == "add" and isinstance(old, list):
            old.append(new)
        elif self.kind == "scale" and isinstance(old, int | float) and abs(old) < 1e308:
            holder[last] = old * _pick(FACTORS, self.to)
        else:
            made = {"copy": other, "list": [old], "table": {_key(place): old}}
            holder[last] = made.get(self.kind, new)
        return tree


def _pick(among: Any, share: float) -> Any:
    return among[min(int(share * len(among)), len(among) - 1)]


def _key(place: Path) -> str:
    return str(place[-1])


def _find(tree: Any, place: Path) -> Any:
    for step in place:
        tree = tree[step]
    return tree


def _places(tree: Any, place: Path = ()) -> Iterator[Path]:
    """All nodes below the root."""
    pairs: Any = ()
    if isinstance(tree, dict):
        pairs = tree.items()
    elif isinstance(tree, list):
        pairs = enumerate(tree)
    for key, inner in pairs:
        yield (*place, key)
        yield from _places(inner, (*place, key))


@dataclass(frozen=True)
class Edits:
    """Changes of the tree in a file of a format.

    Attributes:
        changes: The changes.
        parse: Reads the tree of a whole file.
        dump: Writes one.
    """

    changes: tuple[TableEdit, ...]
    parse: Callable[[bytes], Any]
    dump: Callable[[Any], str]

    def of(self, file: bytes) -> bytes:
        """The file, changed."""
        tree = self.parse(file)
        for change in self.changes:
            tree = change.of(tree)
        return self.dump(tree).encode("utf-8", "surrogatepass")


def table_edits(
    parse: Callable[[bytes], Any],
    dump: Callable[[Any], str],
    most: int = 3,
    *,
    calls: bool = False,
) -> st.SearchStrategy[list[Edits]]:
    """A few changes of a tree, with objects of Python in arguments of calls."""
    share = st.floats(0.0, 1.0, allow_nan=False)
    values = list(range(len(ANY) - len(OBJECTS)))
    if calls:
        values = list(range(len(ANY)))
        values.remove(ANY.index("/"))  # a call may write there
    one = st.builds(TableEdit, st.sampled_from(KINDS), share, share, st.sampled_from(values))
    several = st.lists(one, min_size=1, max_size=most).map(tuple)
    return several.map(lambda changes: [Edits(changes, parse, dump)])


def toml_edits() -> st.SearchStrategy[list[Edits]]:
    """Changes of a TOML file."""
    return table_edits(lambda file: tomllib.loads(file.decode()), toml)


def json_edits() -> st.SearchStrategy[list[Edits]]:
    """Changes of a JSON text."""
    return table_edits(json.loads, lambda tree: json.dumps(tree, default=str))


def lines_edits() -> st.SearchStrategy[list[Edits]]:
    """Changes of a file of JSON texts, one a line."""
    return table_edits(
        lambda file: [json.loads(line) for line in file.decode().splitlines()],
        lambda tree: "".join(f"{json.dumps(line, default=str)}\n" for line in tree),
    )


def call_edits() -> st.SearchStrategy[list[Edits]]:
    """Changes of the arguments of a call; objects that JSON lacks are texts in braces."""
    return table_edits(json.loads, lambda tree: json.dumps(tree, default=str), 2, calls=True)


def toml(tree: Any) -> str:
    """A tree as TOML, each key of the root in a line."""
    if not isinstance(tree, dict):
        return f"x = {_inline(tree)}\n"
    return "".join(f"{_text(key)} = {_inline(value)}\n" for key, value in tree.items())


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{{', '.join(f'{_text(k)} = {_inline(v)}' for k, v in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    if isinstance(value, float) and (isnan(value) or isinf(value)):
        return str(value)
    if isinstance(value, date | time):
        return value.isoformat()
    if value is None:
        return '"none"'
    return json.dumps(value) if not isinstance(value, str) else _text(value)


def _text(value: Any) -> str:
    """A text or key in quotation marks."""
    return json.dumps(str(value)).replace("\x7f", "\\u007f")
