"""The reason for doubt about an effect is a sign that speaks against it."""

from types import SimpleNamespace
from typing import Any

import pytest

from boatsim.diagnosis.answer.signs import reason_for_doubt
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.open_set.consistency import Consistency, Factor, Variation

SAME = Variation(0.0, 1.0, 1)


def reason(held_out: Factor) -> str:
    signs = Consistency((), held_out, SAME, SAME, "", 1.0, 0.0, (), 0.0, 0.0, False)
    judged: Any = SimpleNamespace(signs=signs, stochastic=False, probability=0.01)
    log = SimpleNamespace(unexplained=2.0 * DEFAULT.decide.clear_rest)
    decision: Any = SimpleNamespace(
        problem=SimpleNamespace(config=DEFAULT), log=log, beside_unknown=True
    )
    return reason_for_doubt(judged, decision)


def test_a_size_that_held_out_recordings_require_within_the_tolerance_is_no_doubt() -> None:
    assert reason(Factor(0.99, 0.002)).startswith("much of the missing force remains")


@pytest.mark.parametrize("held_out", [Factor(0.6, 0.002), Factor(1.7, 0.2)])
def test_another_size_on_held_out_recordings_is_a_doubt(held_out: Factor) -> None:
    assert f"{held_out.value:.2f} ± {held_out.sd:.2f} times" in reason(held_out)
