"""Columns of the log with what a controller receives and estimates."""

from collections.abc import Mapping
from math import nan
from operator import attrgetter

import numpy as np

from boatsim.control.base import Estimate, Sense
from boatsim.control.compiled import SENSE_FIELDS
from boatsim.physics.signals import Array
from boatsim.simulate.scenario import Scenario

SENSED = ("psi_rad", "r_radps", "ax_mps2", "ay_mps2", "u_mps", "x_m", "y_m")
FIELDS = ("psi", "r", "ax", "ay", "u", "x", "y")  # of a Sense, in the same order
SENSED_PLACES = [SENSE_FIELDS.index(name) for name in FIELDS]
SENSE_VALUES = attrgetter(*FIELDS)
REFERENCE = "reference_"  # prefix of estimates that are reference signals of a controller


class ControlColumns:
    """Columns of the log with sensor readings and with estimates of a controller.

    Attributes:
        sensed: Names of the columns with sensor readings.
        estimated: Names of the columns with estimates and reference signals.
    """

    def __init__(self, scenario: Scenario, estimates: Mapping[str, Estimate]) -> None:
        """Name the columns.

        Args:
            scenario: The scenario.
            estimates: Estimates of the controller, of which the names count.
        """
        self._readings: list[str] = []  # of further sensors
        columns = list(SENSED)
        for sensor in scenario.additional_sensors:
            for reading, column in type(sensor).columns.items():
                if column not in SENSED:  # logged already
                    self._readings.append(reading)
                    columns.append(column)
        self.sensed = [f"sensed_{column}" for column in columns]
        self._references = [name for name in estimates if name.startswith(REFERENCE)]
        self._estimates = [name for name in estimates if not name.startswith(REFERENCE)]
        self.estimated: list[str] = []
        for name in self._estimates:
            self.estimated += [f"estimate_{name}", f"estimate_{name}_low", f"estimate_{name}_high"]
        self.estimated += self._references

    def sensed_values(self, sense: Sense) -> list[float]:
        """Return the values of the columns `sensed` for a sample of the sensors."""
        return [*SENSE_VALUES(sense), *map(sense.more.__getitem__, self._readings)]

    def estimated_values(self, estimates: Mapping[str, Estimate]) -> list[float]:
        """Return the values of the columns `estimated` for estimates of the controller."""
        values: list[float] = []
        for name in self._estimates:
            values += estimates[name]
        values += [estimates[name].value for name in self._references]
        return values

    def estimated_rows(self, estimates: Mapping[str, Estimate], count: int) -> Array:
        """Return values (N, E) of the columns `estimated`.

        Args:
            estimates: Estimates of the controller, of which the entries are numbers or arrays (N,).
            count: Number of rows N.
        """
        rows = np.empty((count, len(self.estimated)))
        for column, values in enumerate(self.estimated_values(estimates)):
            rows[:, column] = values
        return rows

    def no_estimates(self) -> list[float]:
        """Return values of the columns `estimated` where no row of the log needs them."""
        return [nan] * len(self.estimated)
