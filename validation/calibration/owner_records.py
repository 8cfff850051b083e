"""Records of simulated owners' logs, for the weights: boats entered from their particulars."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

Record = dict[str, Any]


def owner_records(folder: Path) -> Iterator[Record]:
    """Yield records of the diagnoses in a folder of `validation.owner_logs`.

    A log with a fault that was not corrected yields none.

    Args:
        folder: Folder of the cases.
    """
    for file in sorted(folder.glob("case_*/diagnosis/diagnosis.json")):
        answer = json.loads(file.read_text(encoding="utf-8"))
        case = file.parent.parent
        result = json.loads((case / "result.json").read_text(encoding="utf-8"))
        if result["fault"] and not result["mended"]:
            continue
        yield {
            "trial": f"{folder.name}/{case.name}",
            "kind": "owner",
            "causes": result["right"],
            "equivalent": {},
            "signs": answer["signs"],
        }
