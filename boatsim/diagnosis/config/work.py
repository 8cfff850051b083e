"""Settings of the computing work of a whole diagnosis."""

from dataclasses import dataclass

from boatsim.diagnosis.config.setting import setting


@dataclass(frozen=True)
class WorkConfig:
    """Limit of the computing work of a diagnosis, and the parts that are kept for its last stages.

    Each long stage also has a budget of its own, such as `select.budget`. It gets less where later
    stages would get nothing.
    """

    total: int = setting(
        6_500_000_000,
        "steps x dof",
        "Work of a whole diagnosis. One that uses it up takes about ten minutes of CPU on a slow "
        "processor. Each long stage then ends early and states what it has not tried.",
        low=1,
    )
    for_description: int = setting(
        150_000_000,
        "steps x dof",
        "Work that the searches leave to the description of an unexplained force: enough for its "
        "first term where the recordings are long.",
        low=0,
    )
    for_simulations: int = setting(
        2_300_000_000,
        "steps x dof",
        "Work that the searches and the description leave to the fit to free runs, which decides "
        "how well the corrected vessel predicts.",
        low=0,
    )
