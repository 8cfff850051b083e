"""Files of one run whose clocks differ by whole or half hours, because of their time zones."""

from collections.abc import Mapping
from typing import NamedTuple

from boatsim.recordings.importing.several_logs import MIN_OVERLAP, ZERO, Span

HALF_HOUR = 1800.0  # [s]
MAX_HALF_HOURS = 28  # the zones reach from UTC - 12 h to UTC + 14 h
# [s] by which a begin by the motion may differ from one by whole or half hours: the course of a
# vessel turns later than her bow, and clocks are set to a second or two
NEAR = 3.0


class ZoneShift(NamedTuple):
    """Difference of the clock of a file from that of the first file of a run.

    Attributes:
        hours: Hours by which the clock is ahead.
        seconds: Begin of the file after that of the first file, without this difference [s].
    """

    hours: float
    seconds: float

    def in_words(self) -> str:
        """Return the difference in words."""
        way = "ahead" if self.hours > 0.0 else "behind"
        return f"its clock is {abs(self.hours):g} h {way}, as that of another time zone"


def shifts_of_zones(
    spans: Mapping[str, Span], by_motion: Mapping[str, float] | None = None
) -> dict[str, ZoneShift]:
    """Return the whole or half hours by which clocks of a run's files differ.

    A file has another zone if it has no time in common with the first file, and after a shift by
    whole or half hours overlaps it for most of its time. Of several such shifts the one with the
    longest overlap is taken, or that which agrees with the motion.

    Args:
        spans: Name of a file -> its time span; the first file is first.
        by_motion: Name of a file -> begin after that of the first file by the motion [s], where it
            is known.

    Returns:
        Name of a further file -> its shift; without files whose clocks do not differ so.
    """
    first, *others = spans
    found = {}
    for name in others:
        reference, own = spans[first], spans[name]
        have_dates = reference.is_utc and own.is_utc
        count_on = not (reference.is_utc or own.is_utc) and min(reference.begin, own.begin) > ZERO
        if not (have_dates or count_on) or _overlap(reference, own, 0.0) > 0.0:
            continue
        apart = own.begin - reference.begin
        steps = _best_half_hours(reference, own)
        if by_motion and name in by_motion:
            steps = round((apart - by_motion[name]) / HALF_HOUR)
            if abs(apart - by_motion[name] - steps * HALF_HOUR) > NEAR:
                steps = 0
        if steps:
            found[name] = ZoneShift(0.5 * steps, round(apart - steps * HALF_HOUR, 6))
    return found


def _best_half_hours(reference: Span, own: Span) -> int:
    """Half hours by which the clock of a file is ahead, with the longest overlap; 0 for none."""
    shorter = min(reference.duration, own.duration)
    best, longest = 0, MIN_OVERLAP * shorter
    for steps in sorted(range(-MAX_HALF_HOURS, MAX_HALF_HOURS + 1), key=abs):
        overlap = _overlap(reference, own, steps * HALF_HOUR)
        if overlap > longest:
            best, longest = steps, overlap
    return best


def _overlap(reference: Span, own: Span, ahead: float) -> float:
    """Time that two spans have in common if the clock of the second is ahead [s]."""
    end = min(reference.end, own.end - ahead)
    return end - max(reference.begin, own.begin - ahead)
