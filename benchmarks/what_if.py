"""Measure the page of a diagnosis that repeats free runs while a slider moves.

    python -m benchmarks.what_if                      sizes, differences and times
    python -m benchmarks.what_if --picture FILE.png   a picture of its sliders as well

`boatsim demo --what-if` writes the report, which a headless Chromium opens. The position error of the
free runs in the page is compared with the one that Python computed. Then a slider is moved 300 times;
each time the longest recording is simulated and drawn. Other programs of the machine interrupt the
browser, so that the shortest time says more about the page than the median.
"""

import argparse
import json
import re
import zlib
from base64 import b64decode
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from boatsim.cli.demo import run_demo
from tests.chrome import Page, chromium

PLACE = "document.querySelector('#what-if')"
MOVES = 300
MOVE = """(() => {
  const section = %s, slider = [...section.querySelectorAll('.found input[type=range]')].pop(), taken = [];
  for (let i = 0; i < %d; i++) {
    const begin = performance.now();
    slider.value = 200 + i;
    slider.dispatchEvent(new Event('input'));
    section.whatIf.update();
    taken.push(performance.now() - begin);
  }
  return taken;
})()"""
CHOOSE = """(() => {
  const list = %s.querySelector('#what-if-recording');
  list.value = %d;
  list.dispatchEvent(new Event('change'));
  %s.whatIf.update();
})()"""
SUMS = """%s.whatIf.runs.flatMap(run => ['x_m', 'y_m'].map(name => {
  const recorded = %s.whatIf.simulations[%d].measured[name];
  return [...run.channels[name]].map((x, i) => x - recorded[run.first + i]);
}))"""


def print_sizes(page: Path) -> None:
    """Print the sizes of the report and of the program in it."""
    text = page.read_text(encoding="utf-8")
    content = re.search(r'<section id="what-if".*?</section>', text, re.S)
    assert content
    packed = re.search(r'<script type="text/plain">(.*?)</script>', content[0], re.S)
    numbers = re.search(r'<script type="application/json">(.*?)</script>', content[0], re.S)
    assert packed and numbers
    start, size = json.loads(numbers[1])["program"]
    program = zlib.decompress(b64decode(packed[1]))[start : start + size]
    print(f"report.html: {len(text.encode()):,} bytes, the section of these {len(content[0]):,}")
    print(f"WebAssembly: {size:,} bytes, compressed {len(zlib.compress(program, 9)):,}")


def print_errors(page: Page, folder: Path) -> None:
    """Print the rms position error of all recordings of the page, and that of diagnosis.json."""
    deviations = list[float]()
    for i in range(page.run(f"{PLACE}.whatIf.simulations.length")):
        page.run(CHOOSE % (PLACE, i, PLACE))
        for x in page.run(SUMS % (PLACE, PLACE, i)):
            deviations += [value for value in x if value is not None]
    in_page = float(np.sqrt(np.mean(np.square(deviations))))
    answer = json.loads((folder / "diagnosis.json").read_text(encoding="utf-8"))
    of_engine = answer["fit"]["position_rms_m"]["patched"]
    print(f"rms position error as found: {in_page:.9e} m in the page, {of_engine:.9e} m in Python")
    print(f"difference: {abs(in_page - of_engine):.1e} m")


def print_times(page: Page) -> None:
    """Print how long it takes to simulate and draw the longest recording."""
    rows = page.run(f"{PLACE}.whatIf.simulations.map(one => one.rows)")
    longest = rows.index(max(rows))
    page.run(CHOOSE % (PLACE, longest, PLACE))
    seconds = page.run(
        f"(t => t[t.length - 1] - t[0])({PLACE}.whatIf.simulations[{longest}].times)"
    )
    ms = np.array(page.run(MOVE % (PLACE, MOVES)))
    print(f"a move of a slider, {seconds:.0f} s in {max(rows)} rows, simulated and drawn, [ms]")
    print(f"shortest {ms.min():.1f}, median {np.median(ms):.1f}, 95 % {np.percentile(ms, 95):.1f}")


def main(given: Sequence[str] | None = None) -> None:
    """Measure, and save the picture if asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picture", type=Path)
    asked = parser.parse_args(given)
    with TemporaryDirectory() as name, chromium() as opened:
        folder = Path(name) / "demo"
        run_demo(folder, browser=False, what_if=True)
        print()
        print_sizes(folder / "report.html")
        page = opened((folder / "report.html").as_uri())
        page.until(f"{PLACE}.whatIf")
        print_errors(page, folder)
        print_times(page)
        if asked.picture:
            page.run(f"[...{PLACE}.querySelectorAll('button')].pop().click()")
            page.run(f"{PLACE}.scrollIntoView()")
            page.picture(asked.picture, 1120, 1010)


if __name__ == "__main__":
    main()
