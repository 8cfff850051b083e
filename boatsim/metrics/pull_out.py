"""Pull-out test: residual rates of turn after the helm is put midships.

A ship with straight-line stability has the same residual rate after a turn to either side.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet

PARTS = ("first_turn", "after_first", "second_turn", "after_second")


@dataclass(frozen=True)
class PullOut(MetricSet):
    """Metric set of a pull-out test: rates of turn before and after the helm is put midships.

    The rate of turn is read at the end of each of the four parts of the test (a turn and the time
    after it, to one side and then to the other). It is positive to starboard.
    """

    words: ClassVar[str] = "rates of turn before and after the helm is put midships, both ways"
    units: ClassVar = {
        **{f"rate_{part}": "deg/s" for part in PARTS},
        "residual_difference": "deg/s",
    }

    def explain_missing_value(self, metric: str, log: Recording) -> str:
        """Explain in words that a pull-out test is incomplete: the helm changed too few times."""
        helm = log["reference_helm_rad"]
        changes = int(np.count_nonzero(np.diff(helm)))
        return f"the helm changed {changes} times; the four parts need 4 changes"

    def values(self, log: Recording) -> dict[str, float]:
        """Return the rate of turn at the end of each part of a pull-out test that the run reached.

        A complete test also gives the difference between the residual rates after the two turns.
        """
        helm = log["reference_helm_rad"]
        if not helm.any():
            return {}
        begin = int(np.argmax(helm != 0.0))
        ends = [*(begin + np.flatnonzero(np.diff(helm[begin:]))), len(helm) - 1]
        rates = np.degrees(log["r_radps"][ends])
        found = {f"rate_{part}": float(rate) for part, rate in zip(PARTS, rates, strict=False)}
        if len(found) == len(PARTS):
            found["residual_difference"] = abs(
                found["rate_after_first"] - found["rate_after_second"]
            )
        return found
