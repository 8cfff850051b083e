"""What makes commands start faster leaves pandas usable."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from boatsim.physics.content import content_root

pytest.importorskip("pandas")

# A user's file that imports pandas, after pyarrow has looked for it in vain
LATER = """
import sys
from pathlib import Path
from boatsim.cli.fast_start import keep_arrow_from_importing_pandas
from boatsim.physics.content import import_module_file
keep_arrow_from_importing_pandas()
assert "pandas" not in sys.modules
import_module_file(Path(sys.argv[1]), "uses_pandas")
import pandas, pyarrow
whole = pyarrow.array(pandas.Series([1.0, None]))
print(whole.null_count)
"""
# Another thread imports pandas while this one must not
THREAD = """
import importlib.util, sys, threading
from boatsim.cli.fast_start import _NoPandas
sys.meta_path.insert(0, _NoPandas())
found = []
other = threading.Thread(target=lambda: found.append(importlib.util.find_spec("pandas")))
other.start(); other.join()
try:
    import pandas
except ModuleNotFoundError:
    print(found[0] is not None)
"""


def printed(program: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        env=os.environ | {"PYTHONPATH": str(content_root())},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_a_series_is_one_for_pyarrow_in_a_file_that_imports_pandas(tmp_path: Path) -> None:
    file = tmp_path / "uses_pandas.py"
    file.write_text("import pandas\n")
    assert printed(LATER, str(file)) == "1"


def test_another_thread_can_import_pandas() -> None:
    assert printed(THREAD) == "True"
