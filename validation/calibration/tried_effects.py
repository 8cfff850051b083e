"""Which effects of the library a diagnosis tries on the bodies of the false-name campaign."""

import tempfile
from collections.abc import Collection, Mapping
from pathlib import Path

import numpy as np

from boatsim.diagnosis.candidates import candidate_library, has_fittable_parameter
from boatsim.diagnosis.config import DEFAULT
from boatsim.diagnosis.loading import Request, load_recordings
from boatsim.diagnosis.question import set_up_estimation_problem
from boatsim.physics.base import Effect
from boatsim.physics.content import load_class, shipped_content_names
from boatsim.physics.vessel import load_vessel
from validation.calibration.abilities import BODIES, write_trial
from validation.calibration.bodies.body import Body

# Effects that no diagnosis of a body tries, and the reason
ON_REQUEST: Mapping[str, str] = {
    "bilge_keels": "recordings cannot distinguish it from quadratic_damping; only on request",
    "shallow_water": "recordings cannot distinguish it from added_mass_error; only on request",
    "weight_on_arm": "recordings cannot distinguish it from load_gain_error; only on request",
    "current_table": "needs a file with the current; only on request",
}
# Effects tried on the logs without a cause of `python -m validation.calibration`, with the vessel
OTHER_CAMPAIGN: Mapping[str, str] = {
    "gust_off_centre": "catamaran",
    "metacentric_height_error": "eastward_ho",
    "righting_arm_stiffening": "eastward_ho",
}


def candidate_effects() -> set[str]:
    """Return the names of all effects of the library that have a parameter to fit."""
    found = set()
    for name in shipped_content_names("effect"):
        kind: type[Effect] = load_class("effect", name)
        if has_fittable_parameter(kind):
            found.add(name)
    return found


def effects_tried_on(body: Body) -> set[str]:
    """Return the names of the effects that a diagnosis of a trial of a body tries.

    They include those that it tries only where a force stays unexplained (`tried_last`).

    Args:
        body: A body of the campaign.
    """
    with tempfile.TemporaryDirectory() as name:
        files = write_trial(body, np.random.default_rng(1), Path(name))
        loaded = load_recordings(Request(files[:2], files[2:]), config=DEFAULT)
        library = set_up_estimation_problem(loaded, with_candidates=False).library
    return names_of_kinds(library.entries, library.excluded) | set(library.tried_last)


def effects_tried_on_vessel(name: str) -> set[str]:
    """Return the names of the effects that a diagnosis of a shipped vessel tries.

    Args:
        name: Name of the vessel.
    """
    library = candidate_library(load_vessel(name))
    return names_of_kinds(library.entries, library.excluded)


def names_of_kinds(effects: Collection[Effect], excluded: Collection[str]) -> set[str]:
    """Return the names of the classes of effects, without those that are excluded."""
    return {type(effect).type_name() for effect in effects if effect.name not in excluded}


def print_tried_effects() -> None:
    """Print how many effects are tried on each body, and which effects are tried on none."""
    known, tried = candidate_effects(), set[str]()
    for name, make in BODIES.items():
        own = effects_tried_on(make()) & known
        tried |= own
        print(f"{name}: {len(own)} effects; with the bodies above {len(tried)}")
    print(f"all: {len(tried)} of {len(known)} effects with a parameter to fit")
    for name in sorted(known - tried):
        reason = ON_REQUEST.get(name, "")
        if name in OTHER_CAMPAIGN:
            reason = f"tried on the logs of {OTHER_CAMPAIGN[name]} by validation.calibration"
        print(f"  never: {name}: {reason or 'no reason stated'}")


if __name__ == "__main__":
    print_tried_effects()
