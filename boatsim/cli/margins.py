"""Command `boatsim margins`: stability margins of a controller, nominal and on a vessel."""

from collections.abc import Sequence

from boatsim.control.margins import format_margins, stability_margins
from boatsim.errors import BadInput
from boatsim.physics.content import load_class
from boatsim.physics.vessel import load_vessel
from boatsim.simulate.vessel_margins import format_vessel_margins, margins_on_vessel

HEADING = "Margins on a nominal boat with ideal actuators:"
HINT = (
    "Lags and delays of a boat reduce the delay margins: --vessel NAME computes those of a vessel."
)


def print_margins(controller: str, vessel: str | None, loads: Sequence[str]) -> None:
    """Print the margins of a controller on a nominal boat, and on a vessel if one is given.

    Args:
        controller: Name of a controller, or path of its .py.
        vessel: Name or path of a vessel.
        loads: Load conditions of the vessel.

    Raises:
        BadInput: The controller describes no loops, or vessel and controller do not fit.
    """
    made = load_class("controller", controller, named=True)()
    if vessel is None:
        if loads:
            raise BadInput("--load needs --vessel")
        if hasattr(made, "operating_points") and not hasattr(made, "feedback_loops"):
            raise BadInput(
                f"controller {controller!r} has margins on a vessel only; give it by --vessel NAME"
            )
        print(f"{HEADING}\n{format_margins(stability_margins(made))}\n{HINT}")
        return
    boat = load_vessel(vessel, loads)
    found = margins_on_vessel(made, boat)
    if hasattr(made, "feedback_loops"):
        print(f"{HEADING}\n{format_margins(stability_margins(made))}\n")
    print(format_vessel_margins(found, boat))
