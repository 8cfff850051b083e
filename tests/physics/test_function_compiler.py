"""What boatsim assumes of numba's compiler passes, and what its two forms of a function promise."""

import operator
from math import sin

import numpy as np
import pytest
from numba import types
from numba.core.registry import cpu_target
from numba.core.typing import Context

from boatsim.physics.debugging import DEBUG
from boatsim.physics.function_compiler import caching_typing_context, is_plain_type
from boatsim.physics.kernel.compiling import lean, njit_for_compiled_callers

pytestmark = pytest.mark.skipif(DEBUG, reason="nothing is compiled")
VECTOR = types.Array(types.float64, 1, "C")
PAIR = types.UniTuple(types.float64, 2)


def twice(x: float) -> float:
    """Return 2 x."""
    return 2.0 * x


def test_a_function_that_only_compiled_code_calls_gets_no_machine_code() -> None:
    inner = njit_for_compiled_callers()(twice)

    @njit_for_compiled_callers()
    def outer(x: float) -> float:
        return inner(x) + 1.0

    assert outer(1.5) == 4.0
    assert not inner.overloads  # no form for calls from Python
    assert len(inner.inner.overloads) == 1
    (found,) = inner.inner.overloads.values()
    with pytest.raises(Exception, match="no compiled object|not enabled"):
        found.library.serialize_using_object_code()


def test_both_forms_of_a_function_give_the_same_numbers() -> None:
    def law(x: float, a: object) -> float:
        total = 0.0
        for value in a:  # type: ignore[attr-defined]
            total += sin(value * x) / (1.0 + x)
        return total

    function = njit_for_compiled_callers()(law)

    @njit_for_compiled_callers()
    def caller(x: float, a: object) -> float:
        return float(function(x, a))

    values = np.linspace(0.0, 3.0, 17)
    for x in (0.0, 0.3, -7.0):
        assert function(x, values) == caller(x, values) == law(x, values)


def test_a_function_is_analysed_once_for_python_and_for_its_callers() -> None:
    function = njit_for_compiled_callers()(twice)

    @njit_for_compiled_callers()
    def caller(x: float) -> float:
        return float(function(x))

    assert caller(1.0) == function(1.0) == 2.0
    assert function(np.float64(3.0)) == 6.0
    (inner,) = function.inner.overloads.values()
    (outer,) = function.overloads.values()
    assert outer.type_annotation is inner.type_annotation


def test_functions_change_arrays_in_place_in_both_forms() -> None:
    @lean
    def fill(a: object, x: float) -> None:
        for i in range(len(a)):  # type: ignore[arg-type]
            a[i] += x  # type: ignore[index]

    @njit_for_compiled_callers()
    def fill_twice(a: object) -> None:
        fill(a, 1.0)
        fill(a, 2.0)

    values = np.zeros(3)
    fill(values, 0.5)
    fill_twice(values)
    assert values.tolist() == [3.5] * 3


def test_an_error_of_typing_names_the_function_and_leaves_it_usable() -> None:
    function = njit_for_compiled_callers()(twice)
    with pytest.raises(Exception, match="twice"):
        function("text and number do not multiply")
    assert function(2.0) == 4.0


@pytest.mark.parametrize("kinds", [(types.float64, types.int64), (types.int64, types.int64)])
@pytest.mark.parametrize(
    "function", [operator.add, operator.mul, operator.truediv, operator.pow, operator.lt, min]
)
def test_remembered_types_are_those_that_numba_infers(function: object, kinds: object) -> None:
    plain = cpu_target.typing_context
    for _ in range(2):  # looked up, then from memory
        found = caching_typing_context(plain).resolve_function_type(function, kinds, {})
        assert found == Context.resolve_function_type(plain, function, kinds, {})


def test_remembered_types_of_items_are_those_that_numba_infers() -> None:
    plain = cpu_target.typing_context
    for container in (VECTOR, PAIR):
        kinds = (container, types.int64)
        found = caching_typing_context(plain).resolve_function_type(operator.getitem, kinds, {})
        assert found == Context.resolve_function_type(plain, operator.getitem, kinds, {})


def test_only_types_whose_operators_never_change_are_remembered() -> None:
    assert is_plain_type(types.float64) and is_plain_type(VECTOR) and is_plain_type(PAIR)
    assert not is_plain_type(types.List(types.float64))
    assert not is_plain_type(types.Tuple((types.float64, types.unicode_type)))
