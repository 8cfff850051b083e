"""Error that a model without a form leaves: `python -m validation.real.floor NAME`.

For a set of real recordings it prints the errors of free runs over held-out runs: of the retuned
vessel, of the corrected one, and of the retuned one with a Gaussian process for the missing force
(`validation.real.flexible_model`), and the ratio of the corrected model to this one. A ratio of one
or less means that the remaining error is not a missing law of velocities and commands.
"""

from argparse import ArgumentParser
from typing import NamedTuple

from boatsim.diagnosis import loading, pipeline, priors
from boatsim.diagnosis.evaluation import compared_fits
from boatsim.diagnosis.free_runs import rms_errors
from validation.real import blueboat_lake, kvlcc2_hsva_zigzag, kvlcc2_marin_free
from validation.real.common import format_fixed, print_table, runs_except, runs_named, runs_of
from validation.real.flexible_model import FLEXIBLE, compared_free_runs, tuned_flexible_model


class Split(NamedTuple):
    """How a set of recordings is judged: its held-out runs, and the length of free runs."""

    held_out: tuple[str, ...]
    horizon: float  # [s]


SPLITS = {
    blueboat_lake.NAME: Split(blueboat_lake.HELD_OUT, blueboat_lake.HORIZON),
    kvlcc2_hsva_zigzag.NAME: Split(kvlcc2_hsva_zigzag.HELD_OUT, kvlcc2_hsva_zigzag.HORIZON),
    kvlcc2_marin_free.NAME: Split((kvlcc2_marin_free.HELD_OUT,), kvlcc2_marin_free.HORIZON),
}


def print_floor(name: str) -> None:
    """Diagnose a set and print the errors of all models on its held-out runs.

    Args:
        name: Name of the set.
    """
    split, runs = SPLITS[name], runs_of(name)
    unseen = runs_named(runs, split.held_out)
    fitted = runs_except(runs, split.held_out)
    diagnosis = pipeline.diagnose(fitted, unseen, horizon=split.horizon)
    problem, fits = diagnosis.problem, compared_fits(diagnosis.ranking)
    held_out = []
    for path in unseen:
        recording, vessel = loading.open_recording(path, None, ())
        thinned = recording.thinned(priors.downsampling_rate(vessel))
        held_out.append(diagnosis.map_recording(thinned))
    retuned = diagnosis.ranking.recalibrated
    flexible = tuned_flexible_model(problem, retuned, split.horizon)
    errors = rms_errors(compared_free_runs(problem, fits, flexible, held_out, split.horizon))
    rows = []
    for family, off in errors.items():
        before, corrected, floor = off["recalibrated"], off["patched"], off[FLEXIBLE]
        ratios = format_fixed(2, corrected / before, floor / before, corrected / floor)
        rows.append([family, *format_fixed(4, before, corrected, floor), *ratios])
    head = ["error", "retuned", "corrected", "flexible"]
    head += ["corrected / retuned", "flexible / retuned", "corrected / flexible"]
    title = f"{name}: free runs of {split.horizon:g} s, held out {', '.join(split.held_out)}"
    print_table(title, head, rows)
    print(f"(lengths of the Gaussian process: {flexible.smoothing:g} times the likely ones)")


def main() -> None:
    """Read the arguments and print."""
    parser = ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=sorted(SPLITS), help="set of recordings")
    print_floor(parser.parse_args().name)


if __name__ == "__main__":
    main()
