"""Learning curves of the policies in examples/policies: `python docs/_ext/learning_chart.py`.

It draws the tables that `boatsim.learn.train` wrote there to `docs/learning_curve.svg`.
"""

from pathlib import Path

import charts
import numpy as np

DOCS = Path(__file__).parents[1]
FOLDER = DOCS.parent / "examples" / "policies"
FILE = DOCS / "learning_curve.svg"
PANELS = (("berth", "hold_station"), ("follow_path", "joystick"))


def draw() -> str:
    """Return the learning curves of all tasks as SVG."""
    panels = []
    for names in PANELS:
        curves = []
        for name in names:
            table = np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True)
            steps = table["control_steps"] / 1e6
            curves.append(charts.Curve(name, steps, 100.0 * table["success"]))
        panels.append(charts.Axes("success [%]", curves, (0.0, 100.0)))
    about = "Share of successful episodes over the control steps of all boats, for four tasks"
    return charts.line_chart(panels, "control steps of all boats [million]", about, in_file=True)


if __name__ == "__main__":
    FILE.write_text(draw() + "\n", encoding="utf-8")
