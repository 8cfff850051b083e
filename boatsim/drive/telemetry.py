"""Data of the page: first the vessel, its basin and its dials, then a state for each frame."""

from collections.abc import Mapping
from math import isfinite

from boatsim.control.base import wrap
from boatsim.drive.clock import Clock
from boatsim.drive.driver_input import DriverInput
from boatsim.drive.stick_mapping import HEADING, StickMappings
from boatsim.physics.signals import measured_column_for_goal
from boatsim.recordings.notes import unit_of
from boatsim.recordings.table import Recording
from boatsim.simulate.scenario import Scenario
from boatsim.simulate.tracking_errors import error_units
from boatsim.view.content_names import plain_name
from boatsim.view.scene import Scene

# [s] which the compilation of a vessel usually takes, the first time only: 9 to 14 s were measured
# for the shipped vessels on two busy cores. The page shows its progress by it.
COMPILING = 12.0
MOTION = ("x_m", "y_m", "psi_rad", "u_mps", "v_mps", "r_radps")


class PageData:
    """Converts rows of a run's log into the data that the driver's page shows."""

    def __init__(self, scene: Scene, dials: StickMappings, scenario: Scenario) -> None:
        """Create a painter.

        Args:
            scene: Shape of the vessel, and the water.
            dials: Goals or channels that the sticks set.
            scenario: The scenario.
        """
        self._scene, self._dials, self._scenario = scene, dials, scenario

    def initial_data(self, ready: bool) -> dict[str, object]:
        """Return the page's data that do not change during the run: vessel, basin and dials.

        Args:
            ready: Whether the boat can be driven; False while it is still being compiled.
        """
        scene, file = self._scene, self._scenario.file
        return {
            "vessel": scene.vessel,
            "controller": plain_name(str(file.controller["use"])),
            "ready": ready,
            "usual_s": COMPILING,
            "about": file.about,
            "length": scene.length,
            "reach": scene.reach,
            "outline": [[round(float(x), 4), round(-float(y), 4)] for x, y in scene.hull_outline()],
            "tank": None if scene.open else list(scene.tank),
            "start": [file.start.x, file.start.y, file.start.psi],
            "thrusters": [{"name": t.name, "x": t.x, "y": t.y} for t in scene.thrusters],
            "period": self._scenario.controller.period,
            "dials": [self._dial_entry(key) for key in self._dials.keys],
            "units": error_units(self._dials.keys),
        }

    def _dial_entry(self, key: str) -> dict[str, object]:
        """A goal or channel with its range, its unit and the sticks that set it."""
        own = [d for d in self._dials.dials if d.key == key]
        ends = [self._dials.neutral[key] + x for d in own for x in (d.low, d.high)]
        follows = measured_column_for_goal(key)
        channel = key in self._scenario.vessel.commands
        low, high = self._dials.limits.get(key, (min(ends), max(ends)))
        return {
            "key": key,
            "low": low,
            "high": high,
            "unit": unit_of(key),
            "channel": channel,
            "turning": follows == HEADING,
            "sticks": sorted({d.stick for d in own}),
        }

    def frame_data(
        self,
        rows: Recording,
        norms: Mapping[str, float],
        clock: Clock,
        hands: DriverInput,
        latency: float | None,
    ) -> dict[str, object]:
        """Return the data of the driver's page for the last of some rows of the run's log.

        Args:
            rows: Rows of the log.
            norms: Errors of the goals so far.
            clock: Clock of the run.
            hands: Stick positions.
            latency: Delay from the last stick movement to the log [s]; None if unknown.
        """
        now = {name: float(values[-1]) for name, values in rows.signals.items()}
        return {
            "t": round(float(rows.t[-1]), 3),
            **{name.partition("_")[0]: now.get(name, 0.0) for name in MOTION},
            "goals": [self._goal_entry(key, now) for key in self._dials.keys],
            "thrusts": [
                [now.get(t.thrust, 0.0), now.get(t.steer, 0.0)] for t in self._scene.thrusters
            ],
            "wind": [now["wind_X_N"], now.get("wind_Y_N", 0.0)] if "wind_X_N" in now else None,
            "contacts": now.get("contacts", 0.0),
            "norms": {name: float(f"{value:.4g}") for name, value in norms.items()},
            "late": clock.late,
            "worst": round(1e3 * clock.worst, 1),  # [ms]
            "latency": None if latency is None else round(1e3 * latency, 1),  # [ms]
            "away": hands.release_reason,
            "moved": hands.last_moved_time,
        }

    def _goal_entry(self, key: str, now: Mapping[str, float]) -> list[float | None]:
        """Goal and value reached; of a channel the command sent and the command that acts."""
        if key in self._scenario.vessel.commands:
            wanted, reached = now.get(f"sent_{key}"), now.get(key)
        else:
            wanted, reached = now.get(f"goal_{key}"), now.get(measured_column_for_goal(key) or "")
        if reached is not None and measured_column_for_goal(key) == HEADING:
            reached = wrap(reached)
        return [_finite_or_none(wanted), _finite_or_none(reached)]


def _finite_or_none(value: float | None) -> float | None:
    return value if value is not None and isfinite(value) else None
