"""Translated C computes what the Python function computes."""

import ctypes
from collections.abc import Callable
from math import copysign, floor, hypot, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from boatsim.physics.debugging import DEBUG
from boatsim.physics.native.build import NoCompiler, compile_library, compiler_path
from boatsim.physics.native.calls import NativeFunction
from boatsim.physics.native.declarations import NotTranslatable
from boatsim.physics.native.entries import Entry, tuple_of_numbers
from boatsim.physics.native.exports import export_function
from boatsim.physics.native.kinds import MATRIX, REAL, TRUTH, VECTOR, WHOLE
from boatsim.physics.native.translate import Translation

pytestmark = pytest.mark.skipif(DEBUG, reason="nothing is compiled")
TABLE = ((1, 2.0, 3), (4, 5.0, 6))
PLACES = (2, 0, 1)
SIZE = np.int64(3)


class Pair(NamedTuple):
    """Two numbers."""

    a: float
    b: float = 2.0


def command() -> str:
    try:
        return compiler_path()
    except NoCompiler as reason:
        pytest.skip(str(reason))


@pytest.fixture(scope="module")
def native(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Any]:
    """Returns a function that compiles a Python function to C."""
    folder: Path = tmp_path_factory.mktemp("libraries")

    def compiled(function: Callable[..., Any], entry: Entry) -> Callable[..., Any]:
        program = Translation()
        export_function(program, "called", function, entry.arguments)
        path = folder / f"{function.__name__}.so"
        compile_library(program.source_text, path, command())
        return NativeFunction(ctypes.CDLL(str(path)).called, entry)

    return compiled


def arithmetic(x: float, y: float, n: int) -> tuple[float, ...]:
    whole = n * 3 - 7
    return (
        whole % 5 + whole // 4 + abs(whole),
        min(x, y, 1.0) + max(n, 2),
        np.sign(x) * hypot(x, y),
        copysign(sqrt(abs(y)), x),
        floor(x) + int(y),
        (n << 2) ^ (n >> 1),
        1.0 * ((x > 0.0) & (y < 1.0)),
        -x + (+y),
        n / 2,
        x % 3.0,
    )


NUMBER = st.floats(-1e6, 1e6)


@settings(max_examples=200, deadline=None, derandomize=True, database=None)
@given(x=NUMBER, y=NUMBER, n=st.integers(-1000, 1000))
def test_arithmetic_is_that_of_python(
    native: Callable[..., Any], x: float, y: float, n: int
) -> None:
    call = _once(native, arithmetic, Entry((REAL, REAL, WHOLE), tuple_of_numbers))
    assert call(x, y, n) == pytest.approx(arithmetic(x, y, n), rel=1e-15)  # math.hypot has its own


def powers(x: float, y: float) -> tuple[float, ...]:
    return x**2, x**3, x**4, abs(x) ** y, x**2.0


@pytest.mark.parametrize("x", [-3.1, 0.0, 0.7, 1e5])
def test_small_integer_powers_are_products(x: float, native: Callable[..., Any]) -> None:
    found = _once(native, powers, Entry((REAL, REAL), tuple_of_numbers))(x, 0.3)
    assert found[:3] == (x * x, x * (x * x), (x * x) * (x * x))
    assert found == pytest.approx(powers(x, 0.3), rel=1e-15)


_COMPILED: dict[Any, Callable[..., Any]] = {}


def _once(native: Callable[..., Any], function: Any, entry: Entry) -> Callable[..., Any]:
    if function not in _COMPILED:
        _COMPILED[function] = native(function, entry)
    return _COMPILED[function]


def branches(n: int, fine: bool) -> float:
    total = 0
    for i in range(n):
        if i == 3:
            continue
        if i > 8 and not fine:
            break
        total += i * (2 if i % 2 else 1)
    for j in range(n, -1, -2):
        total += 0.5 * j
    k = 0
    while k < n or (k < 2 and fine):
        k, total = k + 1, total + k
    return total if fine else -total


@pytest.mark.parametrize("n", [0, 1, 5, 20])
@pytest.mark.parametrize("fine", [True, False])
def test_loops_and_branches_are_those_of_python(
    n: int, fine: bool, native: Callable[..., Any]
) -> None:
    assert _once(native, branches, Entry((WHOLE, TRUTH), float))(n, fine) == branches(n, fine)


def swap(p: Pair, factor: float) -> Pair:
    return Pair(p.b, factor * p.a)


def tuples(x: float, k: int) -> tuple[float, ...]:
    a, b = x, 2.0 * x
    a, b = b, a
    p = swap(Pair(a), 3.0)
    q = (p.a, p.b, a)
    (i, y, _), last = TABLE[k], TABLE[1][2]
    return a, b, p.a, p.b, q[PLACES[k]], i * y, last, len(TABLE), p[1]


@pytest.mark.parametrize("k", [0, 1])
def test_tuples_and_named_tuples_are_those_of_python(k: int, native: Callable[..., Any]) -> None:
    call = _once(native, tuples, Entry((REAL, WHOLE), tuple_of_numbers))
    assert call(1.5, k) == tuple(map(float, tuples(1.5, k)))


def arrays(v: Any, A: Any, n: int) -> float:
    rows, columns = A.shape[0], A.shape[1]
    work = np.zeros((rows, columns))
    part = v[1:n]
    for i in range(rows):
        for j in range(columns):
            work[i, j] = A[rows - 1 - i, j] + v[j]
        A[i] = work[i]
    A[0, 0] = A[0, 1] = 7.0
    A[1] = 0.25
    part[0] += 10.0
    v[:2] = 1.0
    total = 0.0
    for row in range(len(work)):
        total += work[row][-1] if not np.isnan(work[row, 0]) else 100.0
    return total + part.size + v[-1]


def test_arrays_are_changed_in_place_as_in_python(native: Callable[..., Any]) -> None:
    call = _once(native, arrays, Entry((VECTOR, MATRIX, WHOLE), float))
    v, A = np.arange(4.0), np.arange(12.0).reshape(3, 4)
    A[2, 0] = np.nan
    v2, A2 = v.copy(), A.copy()
    assert call(v, A, 3) == arrays(v2, A2, 3)
    assert np.array_equal(v, v2) and np.array_equal(A, A2, equal_nan=True)


def shifts(v: Any, n: int) -> float:
    v[1:n] = v[: n - 1]
    v[-3:] = v[-4:-1]
    return v[2:50].size + v[n:1].size + v[-50:2].size


@pytest.mark.parametrize("n", [4, 6])
def test_slices_end_with_the_array_and_may_overlap(n: int, native: Callable[..., Any]) -> None:
    call = _once(native, shifts, Entry((VECTOR, WHOLE), float))
    v = np.arange(6.0)
    v2 = v.copy()
    assert call(v, n) == shifts(v2, n)
    assert np.array_equal(v, v2)


def test_arrays_of_another_type_or_shape_are_refused(native: Callable[..., Any]) -> None:
    call = _once(native, arrays, Entry((VECTOR, MATRIX, WHOLE), float))
    A = np.zeros((3, 4))
    for v in (np.zeros(4, dtype=int), np.zeros((4, 1)), np.zeros(8)[::2]):
        with pytest.raises(TypeError, match="contiguous"):
            call(v, A, 3)


def makes_a_list(x: float) -> float:
    return sum([x, x])


def changes_kind(x: float) -> float:
    y = 1.0
    if x > 0.0:
        y = (x, x)
    return y[0]


@pytest.mark.parametrize("function", [makes_a_list, changes_kind])
def test_what_has_no_c_form_is_refused_with_file_and_line(function: Callable[..., Any]) -> None:
    with pytest.raises(NotTranslatable, match=r"test_translate\.py:\d+: .* has"):
        export_function(Translation(), "called", function, (REAL,))
