"""Warning about a vessel whose wave excitation and radiation belong to different speeds."""

import warnings
from collections.abc import Iterable

from boatsim.errors import BoatsimWarning
from boatsim.physics.kinds.effect import Effect


class ExcitationSpeedWarning(BoatsimWarning):
    """Warning that the excitation is that at a forward speed, but not the radiation."""


def warn_of_excitation_speed(name: str, effects: Iterable[Effect]) -> None:
    """Warn if wave loads at a forward speed act on a vessel whose radiation has no terms of speed.

    The moments of scattered and of radiated waves at speed belong together: in long waves, in which
    a hull follows the surface, they cancel. Loads at rest cause no warning, because a vessel may
    move at many speeds.

    Args:
        name: Name of the vessel.
        effects: Its effects, completed.
    """
    own = list(effects)
    radiation = [effect.name for effect in own if effect.radiates_as_at_rest()]
    for effect in own:
        speed = effect.excitation_speed()
        if speed > 0.0 and radiation:
            warnings.warn(
                f"{name}: the loads of {effect.name} are those at {speed:g} m/s, but "
                f"{radiation[0]} has no terms of forward speed; set its forward_speed = 1.0, or "
                "take loads at rest",
                ExcitationSpeedWarning,
                stacklevel=2,
            )
