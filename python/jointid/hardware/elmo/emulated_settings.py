"""Properties and stored settings of an emulated Elmo drive."""

from __future__ import annotations

from dataclasses import dataclass, field

from jointid.hardware.elmo.torque_source import SensorScaling


@dataclass(frozen=True, slots=True, kw_only=True)
class ElmoSettings:
    """Properties and settings of an emulated drive.

    The settings after a reset are a worst case: no watchdog is armed.

    Attributes
    ----------
    node : int
    counts_per_turn : int
        Encoder counts per motor revolution.
    gear_ratio, torque_constant : float
        Motor angle per joint angle; torque constant [N·m/A].
    peak_current, continuous_current : float
        PL[1], CL[1] [A].
    rated_current : float, optional
        Current that scales 6077h [A]; object 6075h. Default: CL[1].
    speed_limit : float
        HL[2], and LL[2] with the other sign [motor counts/s]. Above it the drive switches off.
    idle_loop, idle_jitter : float
        Time between two interpreter commands, and its largest random addition [s].
    enable_time : float
        Time from MO=1 until the motor reports that it is on [s], for brake release and commutation.
    mantissa_bits : int
        Significant bits of the current command: 24 for a float, 4 for the thesis's link.
    position_offset : float
        Joint angle at count 0 [rad].
    analog : SensorScaling
        Relation between the torque sensor's reading and the voltage at the analog input.
    cob_command, cob_reply : int, optional
        COB-IDs of interpreter commands and replies. Default: 0x300 and 0x280 plus the node.
    brake : float
        Torque at the joint of a brake that closes when the motor is off [N·m]; 0: no brake, and a load falls.
    serial : int
        Serial number, 1018h:4.
    abort_option, error_behaviour, emergency_events : int
        6007h, 1029h:1 and 2F21h after a reset of the communication. Default 0: a lost heartbeat does not stop
        the motor, the drive leaves the state operational, and it sends no emergency.
    modulo : tuple of int
        XM[1], XM[2]: range in which the counts wrap. Equal values: they wrap at 32 bits.
    supply, temperature : float
        Supply voltage [V], temperature [°C].
    """

    node: int = 127
    counts_per_turn: int = 8000
    gear_ratio: float = 101.0
    torque_constant: float = 0.198
    peak_current: float = 8.0
    continuous_current: float = 8.0
    rated_current: float | None = None
    speed_limit: float = 1e9
    idle_loop: float = 0.3e-3
    idle_jitter: float = 0.0
    enable_time: float = 0.0
    mantissa_bits: int = 24
    position_offset: float = 0.0
    analog: SensorScaling = field(default_factory=SensorScaling)
    cob_command: int | None = None
    cob_reply: int | None = None
    brake: float = 0.0
    serial: int = 0x0BAD5EED
    abort_option: int = 0
    error_behaviour: int = 0
    emergency_events: int = 0
    modulo: tuple[int, int] = (0, 0)
    supply: float = 48.0
    temperature: float = 30.0

    @property
    def command_id(self) -> int:
        """COB-ID of interpreter commands."""
        return self.cob_command if self.cob_command is not None else 0x300 + self.node

    @property
    def reply_id(self) -> int:
        """COB-ID of interpreter replies."""
        return self.cob_reply if self.cob_reply is not None else 0x280 + self.node
