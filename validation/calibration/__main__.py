"""Measure how often stated names are right: `python -m validation.calibration --out DIR`.

The campaign makes trials over several vessels: logs without a cause, with one or two causes of the
library, and with causes outside it; with a pilot or under a controller that conceals the cause;
with an exact vessel file or a rough one. Every single effect that is named is diagnosed again with
that effect and its look-alikes removed from the candidates. The campaign writes one JSON file for
each trial, may be interrupted at any time, and goes on where it stopped. In the end, or with
`--tables`, it prints how often names with a stated probability are right.
"""

import argparse
import os
from pathlib import Path

from validation.calibration import campaign, table


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the records")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--tables", action="store_true", help="only print the tables")
    args = parser.parse_args()
    if not args.tables:
        campaign.run(args.out, args.seed, args.trials, args.jobs)
    table.print_tables(list(campaign.records(args.out)))


if __name__ == "__main__":
    main()
