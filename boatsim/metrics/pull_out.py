"""Pull-out: what rate of turn is left after the helm was put midships; of a course-stable ship the same both ways."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from boatsim.recordings.table import Recording
from boatsim.simulate.metric import MetricSet

PARTS = ("first_turn", "after_first", "second_turn", "after_second")


@dataclass(frozen=True)
class PullOut(MetricSet):
    """Rates of turn at the end of each of the four parts, positive to starboard."""

    words: ClassVar[str] = "rates of turn before and after the helm is put midships, both ways"
    units: ClassVar = {
        **{f"rate_{part}": "deg/s" for part in PARTS},
        "residual_difference": "deg/s",
    }

    def why(self, metric: str, log: Recording) -> str:
        """How many parts there were."""
        helm = log["reference_helm_rad"]
        return (
            f"the helm changed {int(np.count_nonzero(np.diff(helm)))} times; all four parts take 4"
        )

    def values(self, log: Recording) -> dict[str, float]:
        """Of the parts there were."""
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
