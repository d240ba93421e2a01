"""Bench certificate: results of a first motion, in a file next to the joint file, void when the bench changes."""

from __future__ import annotations

import json
import math
import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.files import write_whole
from jointid.base.schema import ListOf, Number, Plain, Record, TableOf, Text
from jointid.base.toml_file import read_toml
from jointid.hardware.bench.bench import Bench, drive_type
from jointid.hardware.proof.certified_limits import limits_facts, notes, widened
from jointid.hardware.proof.result import FirstMotion
from jointid.hardware.session.watchdog import Watchdog

SCHEMA = 1
VALID = timedelta(days=30)
_CLOCK = timedelta(minutes=5)  # by which this machine's clock may have been ahead

_LIMITS = Record(
    {},
    {
        "position": ListOf(Number(), 2, 2),
        **dict.fromkeys(("velocity", "torque", "current", "position_offset"), Number()),
    },
    other=Plain(),
)
_TABLES = ("joint", "wiring", "drive", "found", "limits", "watchdog", "versions")
_SAME = 1e-9  # relative, of the watchdog's time, which is written with all its digits
_SCHEMA = Record(
    {
        "schema": Number(low=SCHEMA, high=SCHEMA, whole=True),
        "date": Text(longest=100),
        **{name: TableOf(Plain()) for name in _TABLES if name != "watchdog"},
        "limits": _LIMITS,
    },
    {"watchdog": TableOf(Plain())},
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """Record of a passed first motion and of its bench.

    Attributes
    ----------
    date : datetime
        Date of the first motion, with time zone.
    joint : mapping
        Facts of the joint file: gear ratio, torque constant, rotor inertia, sign of the sensor's gain.
    wiring : mapping
        Options of the drive that set signs and scales, see `DriveType.wiring`.
    drive : mapping
        Identity of the drive, including its serial number.
    found : mapping
        Signs, breakaway torque in both directions, travel, largest torque, inertia and unchecked items. If the
        watchdog was tested: also the time until the drive stopped the motor [s].
    limits : mapping
        Limits of the session during the first motion, the joint's largest current and the encoder's offset.
    watchdog : mapping
        Watchdog that the drive declared: "time" [s], "fed_by", "then", "read_back".
    versions : mapping
        Versions of jointid and Python.
    """

    date: datetime
    joint: Mapping[str, Any]
    wiring: Mapping[str, Any]
    drive: Mapping[str, Any]
    found: Mapping[str, Any] = field(default_factory=dict)
    limits: Mapping[str, Any] = field(default_factory=dict)
    watchdog: Mapping[str, Any] = field(default_factory=dict)
    versions: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, bench: Bench, result: FirstMotion, date: datetime | None = None) -> Certificate:
        """Return the certificate of a passed first motion.

        Parameters
        ----------
        bench : Bench
        result : FirstMotion
        date : datetime, optional
            Default: now.

        Raises
        ------
        InputError
            The first motion was not passed, or the drive's watchdog is not known.
        """
        if not result.passed:
            raise InputError(
                "only a first motion that passed is certified", argument="first motion"
            )
        if result.drive_watchdog is None or result.uncertified:
            raise InputError(result.uncertified, argument="first motion")
        found = {
            **result.to_dict(),
            "watchdog": result.watchdog,
            "inertia": result.inertia,
            "sensor_zero": result.sensor_zero,
            "duration": result.duration,
        }
        return cls(
            date=(date or datetime.now(UTC)).astimezone(UTC),
            joint=joint_facts(bench),
            wiring=_plain(drive_type(bench.drive_type).wiring(bench.drive)),
            drive=_plain(identity_facts(result.identity)),
            found=_plain({name: value for name, value in found.items() if name != "passed"}),
            limits=_plain(limits_facts(bench)),
            watchdog=asdict(result.drive_watchdog),
            versions={"jointid": _core.__version__, "python": platform.python_version()},
        )

    def save(self, path: str | Path) -> None:
        """Write the certificate as TOML, completely or not at all."""
        lines = [
            "# Written by `jointid first-motion`; `jointid run` on a real joint requires this certificate. Do not "
            "edit this file.",
            f"schema = {SCHEMA}",
            f'date = "{self.date.isoformat(timespec="seconds")}"',
        ]
        for name in _TABLES:
            lines += ["", f"[{name}]"]
            lines += [
                f"{json.dumps(key)} = {_toml(value)}" for key, value in getattr(self, name).items()
            ]
        write_whole(Path(path), ("\n".join(lines) + "\n").encode())

    @classmethod
    def load(cls, path: str | Path) -> Certificate:
        """Read a certificate.

        Raises
        ------
        InputError
            The file cannot be read or is not a certificate. The error names the file.
        """
        source = Path(path)
        try:
            table = _SCHEMA.read(read_toml(source), "")
        except InputError as error:
            raise (
                error if error.place.startswith(str(source)) else error.at(str(source))
            ) from None
        try:
            date = datetime.fromisoformat(table["date"])
        except ValueError:
            raise _no_date(table["date"], source) from None
        if date.tzinfo is None:
            raise _no_date(table["date"], source)
        return cls(date=date, **{name: table.get(name, {}) for name in _TABLES})

    def objections(
        self,
        bench: Bench,
        identity: Mapping[str, Any] | None = None,
        now: datetime | None = None,
        *,
        watchdog: Watchdog | None = None,
    ) -> list[str]:
        """Return the reasons why the certificate is not valid for a bench; empty if it is valid.

        Parameters
        ----------
        bench : Bench
        identity : mapping, optional
            Identity that the connected drive reports. Default: not compared.
        now : datetime, optional
            Default: now.
        watchdog : Watchdog, optional
            Watchdog that the connected drive declares. Default: not compared.
        """
        age = (now or datetime.now(UTC)) - self.date
        found = []
        if age > VALID:
            found.append(
                f"the certificate is {age.days} days old; it is valid for {VALID.days} days"
            )
        if age < -_CLOCK:
            found.append(
                f"the certificate's date, {self.date.isoformat(timespec='minutes')}, is in the future"
            )
        found += _changes("joint", "the joint file's", self.joint, joint_facts(bench))
        wiring = _plain(drive_type(bench.drive_type).wiring(bench.drive))
        found += _changes("wiring", "the joint file's", self.wiring, wiring)
        found += widened(self.limits, bench)
        if watchdog is not None:
            found += _slower(self.watchdog, watchdog)
        if identity is not None:
            facts = _plain(identity_facts(identity))
            found += _changes("drive", "the drive's", self.drive, facts)
        return found

    def notes(self, bench: Bench, identity: Mapping[str, Any] | None = None) -> list[str]:
        """Return facts that a valid certificate does not cover, such as a changed offset or a missing serial number.

        Parameters
        ----------
        bench : Bench
        identity : mapping, optional
            Identity that the connected drive reports. Default: not compared.
        """
        return notes(self.limits, bench, identity)


def certificate_path(joint_file: str | Path) -> Path:
    """Return the path of a joint file's certificate: `joint.certificate.toml` for `joint.toml`."""
    return Path(joint_file).with_suffix(".certificate.toml")


def joint_facts(bench: Bench) -> dict[str, Any]:
    """Return the joint file's values that the first motion was compared with."""
    joint = bench.joint
    gain = joint.parameters.get("sensor_gain")
    value = None if gain is None else gain.value
    return _plain(
        {
            "drive_type": bench.drive_type,
            "gear_ratio": joint.gear_ratio,
            "torque_constant": joint.torque_constant,
            "rotor_inertia": joint.rotor_inertia,
            "sensor_sign": math.copysign(1.0, value) if value and joint.sensor else None,
        }
    )


def identity_facts(identity: Mapping[str, Any]) -> dict[str, Any]:
    """Return a drive's own part of its identity: its texts, node and serial number."""
    return {
        name: value
        for name, value in identity.items()
        if isinstance(value, str) or (name in ("node", "serial") and value is not None)
    }


def _no_date(text: str, source: Path) -> InputError:
    return InputError(
        'a date such as "2026-01-31T12:00:00+00:00" is expected',
        argument="date",
        value=text,
        place=str(source),
    )


def _slower(before: Mapping[str, Any], now: Watchdog) -> list[str]:
    """Return how a watchdog differs from the certified one. A shorter time is no objection."""
    after = asdict(now)
    time = before.get("time")
    if isinstance(time, int | float) and now.time <= time * (1.0 + _SAME):
        after["time"] = time
    return _changes("watchdog", "the watchdog's", before, after)


def _changes(
    table: str, whose: str, before: Mapping[str, Any], after: Mapping[str, Any]
) -> list[str]:
    if after and not before:
        return [f"the certificate has no table [{table}], but the bench states these facts"]
    return [
        f"{whose} {name} was {before.get(name, 'not there')} and is {after.get(name, 'not there')}"
        for name in dict.fromkeys((*before, *after))
        if before.get(name) != after.get(name)
    ]


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values for TOML: without None and numbers that are not finite, with nested tables as text."""
    kept: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, Mapping):
            kept |= {f"{name}.{key}": each for key, each in _plain(value).items()}
        elif isinstance(value, list | tuple):
            kept[name] = [each for each in value if each is not None]
        elif value is not None and not (isinstance(value, float) and not math.isfinite(value)):
            kept[name] = value
    return kept


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(each) for each in value) + "]"
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, int):
        return str(value)
    return json.dumps(str(value), ensure_ascii=True)
