"""Rail friction: dry friction of level rails, along which a rig lets the hull move."""

from boatsim.physics.base import preset_effect
from boatsim.physics.effects.dry_friction import DryFriction

RailFriction = preset_effect(
    DryFriction,
    "RailFriction",
    formula=(
        r"X = -F_u \tanh\frac{u}{e}, \quad Y = -F_v \tanh\frac{v}{e}, \quad N = -F_r "
        r"\tanh\frac{r}{e}"
    ),
    symbols={"surge": "F_u", "sway": "F_v", "yaw": "F_r"},
    words="level rails oppose the motion along them with dry friction",
    shown_by="small forces that do not move the hull along the rails",
    source=DryFriction.source,
    tied_to="rails fixed to the ground",
    frees={
        "surge": {"spread": 2.0, "words": "sliding friction along surge"},
        "sway": {"spread": 2.0, "words": "sliding friction along sway"},
        "yaw": {"spread": 2.0, "words": "sliding friction of a turntable"},
    },
)
