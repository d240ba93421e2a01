"""An emulated Elmo SimplIQ drive that moves a simulated joint, with the same frames, limits and refusals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from jointid.hardware.can import canopen_frames as canopen
from jointid.hardware.elmo.emulated_interpreter import Interpreter
from jointid.hardware.elmo.emulated_motor import ElmoMotor
from jointid.hardware.elmo.emulated_network import MOTOR_EVENT, ElmoNetwork
from jointid.hardware.elmo.emulated_objects import ElmoObjects
from jointid.hardware.elmo.emulated_settings import ElmoSettings
from jointid.hardware.emulated.faults import drive_failure, error_register

if TYPE_CHECKING:
    import can

    from jointid._core import SteppedJoint
    from jointid.hardware.emulated.device import DeviceBus

__all__ = ["ElmoSettings", "EmulatedElmo"]

_PERIOD_OF_GUARDS = 0.5e-3  # [s] between two checks of speed and heartbeat


class EmulatedElmo(ElmoMotor):
    """An emulated drive with its motor, gear, joint and encoder.

    Parameters
    ----------
    joint : SteppedJoint
        Joint that the motor moves.
    settings : ElmoSettings
    """

    def __init__(self, joint: SteppedJoint, settings: ElmoSettings | None = None) -> None:
        super().__init__(joint, settings if settings is not None else ElmoSettings())
        self._interpreter = Interpreter(
            self,
            lambda subindex: self.objects.number(0x1018, subindex),
            lambda payload: self.reply(payload),  # faults replace `reply`
        )
        self.objects = ElmoObjects(self, self._interpreter)
        self._network = ElmoNetwork(self, self.objects, self._interpreter, self._reset)

    @property
    def state(self) -> str:
        """Network state: "pre-operational", "operational" or "stopped"."""
        return self._network.state

    @state.setter
    def state(self, state: str) -> None:
        self._network.state = state

    def attach(self, bus: DeviceBus) -> None:
        """Power up: send the boot-up message, then check speed and heartbeat regularly."""
        self._bus = bus
        self._network.boot()
        bus.at(bus.now() + _PERIOD_OF_GUARDS, self._guard)

    def receive(self, message: can.Message) -> None:
        """Take a frame from the bus."""
        self.advance()
        self._network.receive(message)

    def condition(self) -> dict[str, Any]:
        """Return the condition for a `Journal`: state, motor and failure (MF) as events, and the joint's position."""
        return {
            "events": {
                "state": self.state,
                "motor_on": self.motor_on,
                "failure": self.failure,
            },
            "current": self.current,
            "position": self.joint.position,
            "velocity": self.joint.velocity,
            "commands": len(self.torque_commands),
        }

    def acknowledge(self) -> None:
        """Clear the failure that switched the motor off, and report that it is gone."""
        super().acknowledge()
        self._network.emergencies.vanish()

    def fail(self, kind: str) -> None:
        """Switch the motor off, with a failure in MF. Send an emergency if 2F21h requests it.

        Parameters
        ----------
        kind : str
            One of `faults.DRIVE_FAILURES`.
        """
        self.advance()
        failure, emergency = drive_failure(kind)
        self.switch(on=False)
        self.failure = failure
        self.problem = failure >> 13 & 0x7 if failure & 0x1000 else 0
        told = self.objects.emergency_wanted(MOTOR_EVENT)
        self._network.emergencies.appear(emergency, error_register(emergency), told=told)

    def restart(self) -> None:
        """Restart as after a short power failure."""
        self.advance()
        self.failure = self.problem = 0
        self._network.command(canopen.RESET_NODE)

    def reply(self, payload: bytes) -> None:
        """Publish a result of the interpreter."""
        self._network.reply(payload)

    def _reset(self, application: bool) -> None:
        self.objects.reset()
        self._interpreter.forget()
        if application:
            self.switch(on=False)
            self.power.forget()
            self.unit_mode = 5

    def _guard(self) -> None:
        self.advance()
        now = self.bus.now()
        low, high = self.speed_bounds
        limit = self.settings.speed_limit
        least, most = -limit if low is None else low, limit if high is None else high
        if self.motor_on and not least <= self.speed() <= most:
            self.fail("speed limit")
        self._network.look(now)
        self.bus.at(now + _PERIOD_OF_GUARDS, self._guard)
