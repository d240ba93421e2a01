"""Text logs as other programs write them: one joint among columns that nobody asked for."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

N = 600
TIME = np.arange(N) * 0.002
POSITION = np.round(0.8 * np.sin(5.0 * TIME) + 0.1, 9)
VELOCITY = np.round(4.0 * np.cos(5.0 * TIME), 9)
TORQUE = np.round(6.0 * np.tanh(20.0 * VELOCITY) + 2.0 * VELOCITY, 9)
_START = 1_729_990_799_999_000_123  # ns since 1970: a second ends soon after, and an hour


def _table(header: str, separator: str, row: Callable[[int], list[object]]) -> str:
    lines = [header] if header else []
    lines += [separator.join(map(str, row(k))) for k in range(N)]
    return "\n".join([*lines, ""])


def _plotjuggler() -> str:
    prefix = "/joint_states/elbow"
    header = (
        f"__time,/joint_states/header/frame_id,{prefix}/position,{prefix}/velocity,{prefix}/effort"
    )
    header += ",/controller/elbow/error,/diagnostics/level,/tool/temperature_raw"
    return _table(
        header,
        ",",
        lambda k: [
            f"{(_START + k * 2_000_000) / 1e9:.6f}",
            *("base", POSITION[k], VELOCITY[k], TORQUE[k], 0.001, "OK", ""),
        ],
    )


def _rostopic() -> str:
    header = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.name0"
    header += ",field.position0,field.velocity0,field.effort0"
    return _table(
        header,
        ",",
        lambda k: [
            *(_START + k * 2_000_000 + 777, k, _START + k * 2_000_000, "base", "elbow"),
            *(POSITION[k], VELOCITY[k], TORQUE[k]),
        ],
    )


def _controller_state() -> str:
    header = "header.stamp.sec,header.stamp.nanosec,joint_names[0],reference.positions[0]"
    header += ",feedback.positions[0],feedback.velocities[0],error.positions[0],feedback.effort[0],speed_scaling"
    return _table(
        header,
        ",",
        lambda k: [
            *divmod(_START + k * 2_000_000, 10**9),
            *("elbow", POSITION[k] + 0.01, POSITION[k], VELOCITY[k], 0.01, TORQUE[k], 1.0),
        ],
    )


def _robot_arm_controller() -> str:
    header = "timestamp target_q_2 actual_q_2 actual_qd_2 target_moment_2 actual_current_2 robot_mode safety"
    return _table(
        header,
        " ",
        lambda k: [
            f"{81532.0 + k * 0.002:.3f}",
            *(POSITION[k] + 0.01, POSITION[k], VELOCITY[k], TORQUE[k] - 1.0, TORQUE[k] / 10.0),
            *("RUNNING", 1),
        ],
    )


def _research_arm() -> str:
    header = (
        "time [s], q[3], q_d[3], dq[3], tau_J[3], tau_J_d[3], tau_ext_hat_filtered[3], robot_mode"
    )
    return _table(
        header,
        ", ",
        lambda k: [
            *(f"{k * 0.002:.3f}", POSITION[k], POSITION[k] + 0.01, VELOCITY[k], TORQUE[k]),
            *(TORQUE[k] - 1.0, 0.0, "Move"),
        ],
    )


def _scope() -> str:
    names = ("ActPos", "SetPos", "ActTorque", "State")
    units = ("°", "°", "%", "(None)")
    lines = [
        "Name\tFriction",
        "File\tC:\\runs\\a.svdx",
        "Starttime of export\t133964386997165000\tMontag",
        "",
    ]
    lines += ["\t".join(f"Name\t{name}" for name in names)]
    lines += ["\t".join(f"SymbolName\tAxes.Axis 1.{name}" for name in names)]
    lines += ["\t".join(["Data-Type\tREAL64"] * 4), "\t".join(["SampleTime[ms]\t2"] * 4)]
    lines += ["\t".join(f"Unit\t{unit}" for unit in units), ""]
    for k in range(N):
        angle = np.rad2deg(POSITION[k])
        cells = (angle, angle + 0.5, TORQUE[k], 4.0)
        lines.append(
            "\t".join(f"{2 * k}\t{cell!r}" for cell in map(float, cells)).replace(".", ",")
        )
    return "\r\n".join([*lines, "EOF", ""])


def _german_trace() -> str:
    lines = ["Trace;KRC4", "Datum;27.10.2024", "", "t;Istwinkel A1;Sollwinkel A1;Moment A1;Status"]
    lines += ["ms;°;°;Nm;-"]
    for k in range(N):
        cells = (2.0 * k, np.rad2deg(POSITION[k]), 0.0, TORQUE[k])
        lines.append(";".join(repr(float(cell)).replace(".", ",") for cell in cells) + ";OK")
    return "\n".join([*lines, ""])


def _small_drive() -> str:
    header = "datetime,pos_estimate [turns],vel_estimate [turns/s],torque_setpoint [Nm],torque_estimate [Nm]"
    header += ",Iq_measured [A],bus_voltage,axis_state,disarm_reason"

    def row(k: int) -> list[object]:
        stamp = np.datetime64(_START + k * 2_000_000, "ns")
        turns = 2.0 * np.pi
        return [
            *(f"{stamp}Z", POSITION[k] / turns, VELOCITY[k] / turns, TORQUE[k] - 1.0, TORQUE[k]),
            *(TORQUE[k] / 10.0, 48.1, "CLOSED_LOOP_CONTROL", ""),
        ]

    return _table(header, ",", row)


def _serial_port() -> str:
    return _table("", "\t", lambda k: [2 * k, POSITION[k], TORQUE[k]])


def _own_names() -> str:
    header = "% recorded by the test bench\n% bench_clock enc_link drive_trq ok"
    return _table(header, "  ", lambda k: [_START // 1000 + 2000 * k, POSITION[k], TORQUE[k], 1])


LOGS: dict[str, tuple[str, Callable[[], str], bool]] = {
    "plotjuggler": (".csv", _plotjuggler, False),
    "rostopic": (".csv", _rostopic, False),
    "controller_state": (".csv", _controller_state, False),
    "robot_arm_controller": (".csv", _robot_arm_controller, False),
    "research_arm": (".csv", _research_arm, False),
    "twincat_scope": (".csv", _scope, True),
    "german_trace": (".txt", _german_trace, True),
    "small_drive": (".csv", _small_drive, False),
    "serial_port": (".log", _serial_port, True),
    "own_names": (".dat", _own_names, True),
}
"""Name → ending, what writes it, and whether it needs a correction."""


def write_log(folder: Path, name: str) -> Path:
    """Write one of `LOGS`."""
    ending, text, _ = LOGS[name]
    path = folder / f"{name}{ending}"
    path.write_text(text(), encoding="utf-8")
    return path
