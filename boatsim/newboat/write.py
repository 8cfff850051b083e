"""The files of a new boat."""

from boatsim.newboat.hull_drawing import hull_xml
from boatsim.newboat.particulars import Particulars
from boatsim.newboat.turn_text import turn_scenario_text
from boatsim.newboat.vessel_text import vessel_text

VESSEL = "vessel.toml"


def boat_files(boat: Particulars) -> dict[str, str]:
    """Return the files of a new boat's folder: file name -> text.

    Args:
        boat: Particulars of the boat.
    """
    return {
        VESSEL: vessel_text(boat),
        "hull.xml": hull_xml(boat),
        "turn.toml": turn_scenario_text(boat),
    }
