"""The table of calibration on the page of results is what the command prints of its records."""

import json
import re
from pathlib import Path

import pytest

from tests.pages import ROOT, results_charts
from validation.calibration import campaign, table

HEADING = "## Calibration of the stated probabilities"
PAGE = (ROOT / "docs" / "results.md").read_text(encoding="utf-8")
RECORDS = list(campaign.records(ROOT / "validation" / "calibration" / "seed_17.jsonl.gz"))
PRINTED = table.figures(RECORDS)
# row of the page -> figures that the command prints
ROWS = {
    "expected calibration error, where no true effect was removed from the candidates": (
        "the same where no true effect was removed",
    ),
    "the same with diagnoses whose true effect was removed": ("expected calibration error",),
    "names stated at 0.99 or more, right, with removed effects": (
        "names stated at 0.99 or more, right",
    ),
    "logs without a cause, with a name": ("logs without a cause, with a name",),
    "logs without a cause, called unknown": ("logs without a cause, called unknown",),
    "visible unknown causes flagged, steered by a pilot": (
        "visible unknown causes flagged, pilot",
    ),
    "visible unknown causes flagged, concealed by a controller": (
        "visible unknown causes flagged, concealed",
    ),
    "visible unknown causes given a name": ("visible unknown causes given a name",),
    "known causes called unknown": ("known causes called unknown",),
    "known causes, a wrong name": ("known causes, a wrong name",),
    "visible single causes exactly named": ("visible single causes, exactly named",),
    "visible pairs / three causes exactly named": (
        "visible pairs, exactly named",
        "three visible causes, exactly named",
    ),
    "true effect removed from the candidates: flagged / given a name": (
        "effect removed from the candidates, flagged",
        "effect removed from the candidates, given a name",
    ),
    "a known cause and an unknown one: known one named / flagged / wrong name": (
        "known cause beside an unknown one, named",
        "known cause beside an unknown one, flagged",
        "known cause beside an unknown one, a wrong name",
    ),
    "retuned vessel worse than the file on held-out data": (
        "logs whose recalibrated model is worse than the file",
    ),
}


def numbers(text: str) -> list[str]:
    """The numbers of a figure in their order; counts are written `a of b` or `a/b`."""
    return re.findall(r"[\d.]+", re.sub(r" = [\d.]+", "", text.replace(",", "")))


@pytest.mark.parametrize(
    "row", list(results_charts.table_below(PAGE, HEADING, "| figure | here |")), ids=lambda r: r[0]
)
def test_a_figure_is_the_printed_one(row: list[str]) -> None:
    words, here = row[:2]
    printed = " ".join(PRINTED[name] for name in ROWS[words])
    if "(" not in here:
        printed = re.sub(r"\(.*?\)", "", printed)
    if here == "none is stated":
        assert printed == "none"
    assert numbers(here) == numbers(printed)


def test_the_reliability_is_the_printed_one() -> None:
    page = list(results_charts.table_below(PAGE, HEADING, "| stated probability | names |"))
    rows = []
    for one in table.reliability(table.statements(RECORDS)):
        interval = f"{one.low:.2f} to {one.high:.2f}"
        rows.append([interval, str(one.count), f"{one.stated:.3f}", f"{one.right:.3f}"])
    assert page == rows


def test_the_page_states_how_many_logs_there_are() -> None:
    logs = len({record["trial"] for record in RECORDS})
    assert f"{logs} logs of seed 17" in PAGE


def test_a_packed_campaign_has_the_records_of_its_folder(tmp_path: Path) -> None:
    for number, found in ((1, RECORDS[:2]), (2, []), (3, RECORDS[2:3])):
        (tmp_path / f"S1_T{number:05d}.json").write_text(json.dumps(found))
    packed = tmp_path / "packed.jsonl.gz"
    campaign.pack(tmp_path, packed)
    assert list(campaign.records(packed)) == list(campaign.records(tmp_path))
    assert [one["trial"] for one in campaign.records(packed)] == [r["trial"] for r in RECORDS[:3]]
    before = packed.read_bytes()
    campaign.pack(tmp_path, packed)
    assert packed.read_bytes() == before
