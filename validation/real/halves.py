"""Whether two halves of a set give the same answer: `python -m validation.real.halves NAME`.

The runs of a set, in the order of their names, are dealt alternately to two halves, and each half
is diagnosed alone. Printed are the effects that each half names with their parameters, the distance
of two values in standard deviations, and the share of names that the other half gives too.
"""

from argparse import ArgumentParser
from math import hypot, nan

from boatsim.diagnosis import pipeline
from boatsim.diagnosis.answer.schema import EffectEntry
from validation.real.common import effects_of, print_table, runs_of
from validation.real.floor import SPLITS

NEAR = 2.0  # [sd] distance up to which two values agree: 95 % of normally distributed errors
TEXT = "{:.3g} +- {:.2g}"
Effects = dict[str, EffectEntry]


def diagnosed_halves(name: str) -> tuple[Effects, Effects]:
    """Diagnose the halves of a set and return the effects that each names.

    Args:
        name: Name of the set.
    """
    runs = list(runs_of(name).values())
    found = []
    for half in (runs[::2], runs[1::2]):
        diagnosis = pipeline.diagnose(half, horizon=SPLITS[name].horizon)
        print(diagnosis.findings.answer["sentence"])
        found.append({effect["name"]: effect for effect in effects_of(diagnosis)})
    return found[0], found[1]


def distances(first: Effects, second: Effects) -> dict[tuple[str, str], float]:
    """Return how far the parameters of common names are apart, in standard deviations.

    Args:
        first: Effects of one half by name.
        second: Effects of the other half.
    """
    found = {}
    for name in sorted(set(first) & set(second)):
        for parameter, one in first[name]["parameters"].items():
            other = second[name]["parameters"].get(parameter)
            if other is None:
                continue
            sd = hypot(one["sd"], other["sd"])
            apart = abs(one["value"] - other["value"])
            found[name, parameter] = apart / sd if sd > 0.0 else nan
    return found


def print_halves(name: str) -> None:
    """Diagnose the halves of a set and print what they have in common.

    Args:
        name: Name of the set.
    """
    halves = diagnosed_halves(name)
    apart = distances(*halves)
    rows = []
    for effect in sorted({*halves[0], *halves[1]}):
        parameters = sorted(
            {p for half in halves if effect in half for p in half[effect]["parameters"]}
        )
        for parameter in parameters:
            cells = []
            for half in halves:
                given = half[effect]["parameters"].get(parameter) if effect in half else None
                cells.append(TEXT.format(given["value"], given["sd"]) if given else "-")
            distance = apart.get((effect, parameter))
            cells.append("-" if distance is None else f"{distance:.1f}")
            rows.append([f"{effect} {parameter}", *cells])
    print_table(name, ["effect and parameter", "first half", "second half", "apart [sd]"], rows)
    common = len(set(halves[0]) & set(halves[1]))
    print(f"names of the first half that the second gives too: {common} of {len(halves[0])}")
    print(f"names of the second half that the first gives too: {common} of {len(halves[1])}")
    near = sum(distance <= NEAR for distance in apart.values())
    print(f"parameters of common names within {NEAR:g} sd: {near} of {len(apart)}")


def main() -> None:
    """Read the arguments and print."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=sorted(SPLITS), help="set of recordings")
    print_halves(parser.parse_args().name)


if __name__ == "__main__":
    main()
