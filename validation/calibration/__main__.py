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

from validation.calibration import campaign, table, weights
from validation.calibration.curve import reliability_curve
from validation.calibration.owner_records import owner_records


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--out",
        type=Path,
        required=True,
        help="folder of the records; with --tables also a file written by --pack",
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--trials", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument(
        "--unstated",
        action="store_true",
        help="with a disturbance that is larger than usual and not stated, and laws with errors",
    )
    parser.add_argument("--tables", action="store_true", help="only print the tables")
    parser.add_argument("--pack", type=Path, help="write all records into this compressed file")
    parser.add_argument(
        "--weights", action="store_true", help="print the weights of the signs that fit best"
    )
    parser.add_argument(
        "--new", nargs="*", default=(), help="with --weights: signs that are new or defined anew"
    )
    parser.add_argument(
        "--owners",
        type=Path,
        nargs="*",
        default=(),
        help="with --weights: also folders of validation.owner_logs (boats from particulars)",
    )
    parser.add_argument("--curve", type=Path, help="write the reliability curve to this SVG file")
    parser.add_argument(
        "--beside-unknown",
        type=float,
        metavar="NATS",
        help="log odds added to an effect beside an unknown cause (default: those in use)",
    )
    args = parser.parse_args()
    if not args.tables:
        campaign.run(args.out, args.seed, args.trials, args.jobs, args.unstated)
    if args.pack:
        campaign.pack(args.out, args.pack)
    records = list(campaign.records(args.out, args.beside_unknown))
    table.print_tables(records)
    if args.weights:
        for folder in args.owners:
            records += owner_records(folder)
        weights.print_weights(records, args.new)
    if args.curve:
        rows = table.reliability(table.statements(records))
        args.curve.write_text(reliability_curve(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
