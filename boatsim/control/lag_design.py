"""Design of a controller's gains by the known lag and delay of the vessel's actuators."""

from dataclasses import dataclass

from boatsim.control.base import Controller
from boatsim.physics.base import UNSET, param

# [s] delay or lag that a boat may have in addition to the known ones. With it, 95 % of randomly
# drawn scale boats survive an additional delay of 0.4 s under `l1_joystick` (docs/robustness.md).
RESERVE = 0.33
POLE_SHARE = 0.5  # of the bandwidth: pole of the response to a set point
HEADING_SHARE = 0.2  # of the bandwidth: a fifth separates heading from rate
# [s] lag of the motors of the scale boat in Bayless (2017), for a controller without a vessel
ASSUMED_LAG = 0.15


def bandwidth_for_delay(delay: float) -> float:
    """Return the bandwidth [rad/s] that rejects disturbances of an axis with an effective delay.

    It is 1 / (2 theta), that of the SIMC rule for an integrating process (S. Skogestad, Journal of
    Process Control 13, 2003).

    Args:
        delay: Effective delay theta: half a period, lags and delays of the loop [s].
    """
    return 0.5 / delay


@dataclass
class LagBasedController(Controller):
    """Base of controllers whose gains follow from the lag of the vessel's actuators.

    Parameters that are not given are derived for the scale boat, and anew when `use_command_lag`
    tells the lag of the vessel.
    """

    motor_lag: float = param(
        UNSET,
        low=0.0,
        high=10.0,
        unit="s",
        words="known lag of the actuators; default: that of the vessel, its delays included",
    )
    command_delay: float = param(
        0.0, low=0.0, high=10.0, unit="s", words="known further delay of all commands"
    )

    def __post_init__(self) -> None:
        """Derive the parameters that are not given, for the lag of the scale boat.

        Raises:
            BadInput: A parameter is out of bounds.
        """
        self._derived = [name for name in type(self).params() if getattr(self, name) is UNSET]
        self._design(ASSUMED_LAG)

    def use_command_lag(self, lag: float) -> None:
        """Derive the parameters that are not given for the lag of a vessel.

        Args:
            lag: Longest sum of lags and delays between a command and its actuator [s].

        Raises:
            BadInput: The lag, or a parameter that follows from it, is out of bounds.
        """
        for name in self._derived:
            setattr(self, name, UNSET)
        self._design(lag)

    def _design(self, lag: float) -> None:
        """Derive the parameters that are not given, check all of them and start anew."""
        if self.motor_lag is UNSET:
            self.motor_lag = lag
        self.derive_gains()
        super().__post_init__()

    def derive_gains(self) -> None:
        """Set the gains that are not given; the lag is known."""
        raise NotImplementedError

    def known_delay(self) -> float:
        """Return the known delay of the loops [s]: half a period and the lags of the vessel."""
        return 0.5 * self.period + self.command_delay + self.motor_lag

    def effective_delay(self) -> float:
        """Return the effective delay of the loops [s]: the known one and a reserve."""
        return self.known_delay() + RESERVE
