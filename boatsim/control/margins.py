"""Robustness table of a controller: L1 norm, crossover, phase and delay margin of each loop."""

from dataclasses import dataclass
from math import degrees

from boatsim.control.adaptive import LoopChannel, SampledLoop, l1_condition_value, loop_margins
from boatsim.errors import BadInput
from boatsim.physics.content import load_class, shipped_content_names, snake_case

HEADINGS = (
    "channel",
    "input gain",
    "L1 norm s",
    "slope 1/s",
    "crossover rad/s",
    "phase deg",
    "extra delay s",
)


@dataclass(frozen=True)
class Row:
    """Stability margins of one feedback loop at one ratio of true to assumed input gain."""

    channel: str
    input_gain: float
    # [s] L1 norm of the part the low-pass does not cancel; None if the controller is not L1
    norm: float | None
    slope: float | None  # [1/s] largest slope of the uncertainty that the norm covers
    needed: (
        float | None
    )  # [1/s] slope of the uncertainty: pole of the predictor less damping of the boat
    crossover: float  # [rad/s]
    phase_deg: float  # [deg] phase margin
    delay_s: float  # [s] extra-delay margin
    stable: bool


def stability_margins(controller: object) -> list[Row]:
    """Return the stability margins of a controller's loops, for several true input gains each.

    Args:
        controller: Object with `feedback_loops`.

    Raises:
        BadInput: The controller has no `feedback_loops`.
    """
    describe = getattr(controller, "feedback_loops", None)
    if describe is None:
        asked = snake_case(type(controller).__name__)
        able = [
            name
            for name in shipped_content_names("controller")
            if hasattr(load_class("controller", name), "feedback_loops")
        ]
        raise BadInput(
            f"controller {asked!r} describes no feedback_loops (these do: "
            f"{', '.join(able) or 'none'})"
        )
    rows = []
    for channel in describe():
        rows += [_margin_row(channel, gain) for gain in channel.input_gain]
    return rows


def _margin_row(channel: LoopChannel | SampledLoop, gain: float) -> Row:
    norm, found = (
        channel.l1_norm(gain),
        loop_margins(channel.open_loop_response(gain), high=channel.highest_frequency),
    )
    return Row(
        channel=channel.name,
        input_gain=gain,
        norm=norm,
        slope=None if norm is None else 1.0 / norm,
        needed=None if norm is None else abs(channel.pole - channel.damping),
        crossover=found.crossover,
        phase_deg=degrees(found.phase),
        delay_s=found.delay,
        stable=found.stable,
    )


def format_margins(rows: list[Row]) -> str:
    """Return a table of stability margins as text, with the L1-norm condition of each L1 loop.

    Args:
        rows: Rows of `stability_margins`.
    """
    lines = ["  ".join((f"{HEADINGS[0]:10}", *HEADINGS[1:]))]
    lines += ["  ".join(_format_row(row)).rstrip() for row in rows]
    return "\n".join(lines + [_format_l1_condition(name, rows) for name in _l1_channels(rows)])


def _format_row(row: Row) -> list[str]:
    """Return one line of the table, each number under its heading."""
    values = [
        f"{row.input_gain:.2f}",
        "-" if row.norm is None else f"{row.norm:.3f}",
        "-" if row.slope is None else f"{row.slope:.2f}",
        f"{row.crossover:.1f}",
        f"{row.phase_deg:.0f}" if row.stable else "unstable",
        f"{row.delay_s:.2f}",
    ]
    return [
        f"{row.channel:10}",
        *(f"{v:>{len(h)}}" for v, h in zip(values, HEADINGS[1:], strict=True)),
    ]


def _l1_channels(rows: list[Row]) -> list[str]:
    return list(dict.fromkeys(row.channel for row in rows if row.norm is not None))


def _format_l1_condition(name: str, rows: list[Row]) -> str:
    """Return the L1-norm condition of one channel at its worst input gain, in words."""
    norm, needed = max(
        (row.norm, row.needed) for row in rows if row.channel == name and row.norm and row.needed
    )
    value = l1_condition_value(norm, needed)
    verdict = "met" if value < 1.0 else "not met (it is sufficient, not necessary)"
    return (
        f"{name}: L1 norm {norm:.3f} s covers uncertainty slopes below {1.0 / norm:.2f} 1/s; "
        f"{needed:.2f} 1/s needed "
        f"(norm x slope {value:.2f}): condition {verdict}"
    )
