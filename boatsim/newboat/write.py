"""The files of a new boat, as texts by name."""

from boatsim.newboat.hull_drawing import hull_xml
from boatsim.newboat.particulars import Particulars
from boatsim.newboat.turn_text import turn_text
from boatsim.newboat.vessel_text import vessel_text

VESSEL = "vessel.toml"


def files(boat: Particulars) -> dict[str, str]:
    """File name -> content of a boat's folder."""
    return {VESSEL: vessel_text(boat), "hull.xml": hull_xml(boat), "turn.toml": turn_text(boat)}
