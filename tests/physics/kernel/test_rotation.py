"""Cosine and sine of actuators that are angles: within a rounding error of the exact values."""

from decimal import Decimal, getcontext

import numpy as np
import pytest

from boatsim.physics.debugging import python_function
from boatsim.physics.kernel.rotation import SMALL, cosine_and_sine

getcontext().prec = 40
ULP = 2.0**-52


def exact_series(x: Decimal, first: int) -> Decimal:
    """Sum of the alternating series of cosine (from power 0) or sine (from power 1)."""
    term = x if first else Decimal(1)
    total, n = term, first
    while abs(term) > Decimal("1e-35"):
        term *= -x * x / ((n + 1) * (n + 2))
        total, n = total + term, n + 2
    return total


@pytest.mark.parametrize("x", [*np.linspace(-SMALL, SMALL, 41), 1e-300, -1e-9, 0.1, 2.5, -40.0])
def test_cosine_and_sine_are_exact_to_a_rounding_error(x: float) -> None:
    cosine, sine = python_function(cosine_and_sine)(float(x))
    exact = Decimal(float(x))
    assert abs(Decimal(cosine) - exact_series(exact, 0)) <= Decimal(ULP) * abs(Decimal(cosine))
    assert abs(Decimal(sine) - exact_series(exact, 1)) <= Decimal(ULP) * abs(Decimal(sine))


def test_compiled_values_are_those_of_python() -> None:
    for x in np.random.default_rng(0).uniform(-2.0, 2.0, 200).tolist():
        assert cosine_and_sine(x) == python_function(cosine_and_sine)(x)
