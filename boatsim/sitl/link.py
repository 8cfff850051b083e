"""UDP link to one autopilot in lock step: receives servo outputs, answers with sensor readings.

The autopilot sends a frame and waits for the answer before it sends the next one, whose counter is
larger by one. It repeats a frame that is not answered, and begins with a small counter after a
restart.
"""

import os
import socket
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import Any, NamedTuple, Self

from boatsim.errors import BadInput
from boatsim.sitl.servo_packet import LARGEST, ServoFrame, parse_servo_packet

LOOPBACK = "127.0.0.1"
POLL = 0.1  # [s] between two questions whether the run is interrupted
COUNTERS = 1 << 32  # a frame counter is a number modulo this
# [s] of silence after which another sender on the port replaces the autopilot; an autopilot that is
# restarted sends from another port
TAKEOVER = 1.0
MOST_WAITING = 256  # packets that are read at once; an autopilot in lock step has one under way


class ReceivedFrame(NamedTuple):
    """A frame of the autopilot, and whether it is the first one after a start of the autopilot."""

    frame: ServoFrame
    restarted: bool


class AutopilotLink:
    """UDP socket on which one autopilot exchanges frames with a simulation.

    Attributes:
        address: Address of this machine on which frames are received.
        port: Port of the socket.
        peer: Address and port of the autopilot; None before its first frame.
        repeated: Number of frames that were received again.
        missed: Number of frames that the counter shows but that were not received.
        malformed: Number of packets that are no servo outputs.
        foreign: Number of packets of another sender while the autopilot was active.
    """

    def __init__(self, address: str, port: int, silence: float) -> None:
        """Bind the socket.

        Args:
            address: Address on which frames are received; "127.0.0.1" for this machine only.
            port: Port; 0 for any free one.
            silence: Longest time to wait for a frame [s].

        Raises:
            BadInput: The address or the port cannot be used.
        """
        self.silence = silence
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((address, port))
        except OSError as error:
            self._socket.close()
            reason = error.strerror or os.strerror(error.errno or 0)
            raise BadInput(f"{address}, port {port}: {reason}") from None
        self.address = address
        self.port: int = self._socket.getsockname()[1]
        self.peer: Any = None
        self.repeated = self.missed = self.malformed = self.foreign = 0
        self._counter: int | None = None  # of the last frame
        self._answer = b""  # to the last frame; empty before it was sent
        self._heard = 0.0  # monotonic time of the last packet of the autopilot
        self._waiting: deque[tuple[bytes, Any]] = deque()  # packets that have been read already

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def next_frame(self, stop: Callable[[], bool] = bool) -> ReceivedFrame | None:
        """Wait for the next frame; answer repeated ones with the last answer.

        Args:
            stop: Ends the wait when it returns True.

        Returns:
            The frame; None if `stop` ended the wait or no frame has arrived for `silence` seconds.
        """
        deadline = monotonic() + self.silence
        while not stop() and monotonic() < deadline:
            packet = self._read_packet(POLL)
            if packet is None:
                continue
            frame = self._frame_of_autopilot(packet)
            if frame is None:
                continue
            found = self._accept(frame, packet[1])
            if found is not None:
                return found
            deadline = monotonic() + self.silence
        return None

    def answer(self, message: bytes) -> None:
        """Send the answer to the last frame.

        Copies of that frame that have arrived in the meantime are dropped: an answer to each of
        them would put the autopilot behind the simulation.

        Args:
            message: The message.
        """
        self._drop_copies()
        self._answer = message
        self._send()

    def _send(self) -> None:
        with suppress(OSError):  # the autopilot has gone; it is silent from now on
            self._socket.sendto(self._answer, self.peer)

    def _read_packet(self, seconds: float) -> tuple[bytes, Any] | None:
        """Return the next packet and its sender, or None if none arrives within some seconds."""
        if self._waiting:
            return self._waiting.popleft()
        self._socket.settimeout(seconds)
        try:
            return self._socket.recvfrom(LARGEST + 1)
        except (TimeoutError, BlockingIOError, ConnectionError):
            return None

    def _frame_of_autopilot(self, packet: tuple[bytes, Any]) -> ServoFrame | None:
        """Return the frame in a packet, unless it is malformed or of another sender."""
        data, sender = packet
        frame = parse_servo_packet(data)
        if frame is None:
            self.malformed += 1
            return None
        if self.peer not in (None, sender) and monotonic() - self._heard < TAKEOVER:
            self.foreign += 1
            return None
        return frame

    def _accept(self, frame: ServoFrame, sender: Any) -> ReceivedFrame | None:
        """Count a frame of the autopilot; None for one that has been received already."""
        self._heard = monotonic()
        first = self._counter is None
        ahead = (frame.counter - (self._counter or 0)) % COUNTERS
        restarted = first or sender != self.peer or ahead >= COUNTERS // 2
        self.peer = sender
        if not restarted and ahead == 0:
            self.repeated += 1
            if self._answer:
                self._send()
            return None
        if not restarted:
            self.missed += ahead - 1
        self._counter, self._answer = frame.counter, b""
        return ReceivedFrame(frame, restarted)

    def _drop_copies(self) -> None:
        """Drop copies of the last frame among the packets that have arrived; keep the others."""
        kept: deque[tuple[bytes, Any]] = deque()
        for _ in range(MOST_WAITING):
            packet = self._read_packet(0.0)
            if packet is None:
                break
            frame = parse_servo_packet(packet[0])
            if frame is not None and packet[1] == self.peer and frame.counter == self._counter:
                self.repeated += 1
            else:
                kept.append(packet)
        self._waiting.extend(kept)
