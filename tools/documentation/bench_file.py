"""The reference page of the bench file: each key of `[session]`, from the options that declare it."""

from __future__ import annotations

import inspect
from collections.abc import Collection, Iterable, Iterator
from dataclasses import MISSING, fields
from typing import Any

import jointid as jid
from documentation.numpydoc import described
from documentation.wording import definition, kind_in_toml, markdown
from jointid.hardware.bench import bench_file
from jointid.hardware.bench.bus_options import BusOptions
from jointid.hardware.bench.emulation import Emulation
from jointid.hardware.bench.first_motion_options import FirstMotionOptions
from jointid.hardware.bench.table import type_name
from jointid.hardware.elmo.emulated_bench import ElmoEmulation
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.session.limits import SessionLimits
from jointid.hardware.session.options import SessionOptions
from jointid.hardware.session.realtime import RealTimeOptions

_HEAD = (
    "# Bench file",
    "",
    "A bench file is a [joint file](joint_file.md) with a table `[session]`. It describes drive, motion, controller "
    'and limits. An unknown key is an error that proposes the likely one. Angles may be texts: `"60deg"`. Written '
    "from the code that reads it. How to use it: [move a real joint](../hardware.md). A file with comments: "
    "[joint.toml](../repository/examples/hardware/joint.toml).",
    "",
)
_ESTIMATES = (
    *("inertia", "coulomb", "static", "stribeck", "viscous"),
    *("sensor_gain", "sensor_offset"),
)
# Heading, introduction, class that declares the keys, and fields that are no keys of this table.
_Part = tuple[str, str, Any, Collection[str]]
_WIRING: tuple[_Part, ...] = (
    ("## `[session]`", "Timing of the control loop.", SessionOptions, {"resolution"}),
    ("## `[session.bus]`", "The CAN bus.", BusOptions, ()),
    (
        "## `[session.drive]`",
        '`type` is the drive\'s type, by default `"elmo"`. The keys below belong to an Elmo drive; another type has '
        "[its own](../hardware.md#registering-a-drive-type).",
        ElmoOptions,
        {"torque", "bitrate"},
    ),
    (
        "## `[session.torque]`",
        'Where an Elmo drive\'s session reads the torque sensor: `source` is `"converter"` (default), `"analog"` or '
        '`"none"`.\n\n### `source = "converter"`',
        SyncedConverter,
        {"scaling"},
    ),
    ('### `source = "analog"`', "", AnalogInput, {"scaling"}),
    ("### Scaling of both", "", SensorScaling, ()),
)
_RUNNING: tuple[_Part, ...] = (
    (
        "## `[session.limits]`",
        "Each limit is a [stop](../safety.md#stops) with its name. `position`, `velocity` and `torque` override those "
        "of the joint's `[limits]`.",
        SessionLimits,
        (),
    ),
    (
        "## `[session.real_time]`",
        "Settings of Linux; the recording lists what is not granted.",
        RealTimeOptions,
        (),
    ),
    (
        "## `[session.first_motion]`",
        "For `jointid first-motion`.",
        FirstMotionOptions,
        (),
    ),
    (
        "## `[session.emulated]`",
        "The true joint and drive, read with `--emulate` only.",
        Emulation,
        {"truth", "sensors", "drive"},
    ),
    ("### Of an Elmo drive", "", ElmoEmulation, ()),
)


def bench_file_page() -> str:
    """Return every key of a bench file's table `[session]`."""
    lines = [*_HEAD, *_described(_WIRING), *_motions(), *_laws(), *_described(_RUNNING)]
    return "\n".join([*lines, *_emulated_joint()])


def _described(parts: Iterable[_Part]) -> Iterator[str]:
    for title, introduction, kind, others in parts:
        yield from (title, "", *([introduction, ""] if introduction else []))
        yield from _options(kind, others)


def _options(kind: Any, others: Collection[str]) -> Iterator[str]:
    """Return the fields of a dataclass as keys, with the defaults that their texts do not name."""
    texts = described(kind) | described(kind, "Attributes")
    for field in fields(kind):
        if field.name in others:
            continue
        entry = texts[field.name]
        default = "" if "Default" in entry.text else _default(field.default)
        yield from definition(
            field.name, f"{kind_in_toml(entry.kind)}{default}", markdown(entry.text)
        )


def _default(value: object) -> str:
    if value is MISSING or value is None:
        return ""
    return f", default {str(value).lower()}"


def _motions() -> Iterator[str]:
    """Return the forms of a motion with their keys."""
    yield from (
        "## `[session.trajectory]`",
        "",
        'Required. `form` is the motion\'s form, by default `"thesis"`. Or only `file`: a motion that `jointid design` '
        "wrote, named from the bench file's folder.",
        "",
    )
    for form in bench_file._TRAJECTORIES:
        make = getattr(jid.Trajectory, form)
        meaning = inspect.cleandoc(make.__doc__).partition("\n")[0].removeprefix("Return ")
        meaning = f"{meaning[:1].upper()}{meaning[1:]}"
        yield from (f'### `form = "{form}"`', "", markdown(meaning), "")
        texts = described(make)
        for name, parameter in inspect.signature(make).parameters.items():
            kind = kind_in_toml(type_name(parameter.annotation))
            required = ", required" if parameter.default is parameter.empty else ""
            text = markdown(texts[name].text) if name in texts else "See the line above."
            yield from definition(name, f"{kind}{required}", text)


def _laws() -> Iterator[str]:
    """Return the control laws with their gains."""
    overriding = ", ".join(f"`{name}`" for name in _ESTIMATES)
    yield from (
        "## `[session.controller]`",
        "",
        'Required. `law` is the control law, by default `"adaptive_robust"`. Estimates of the joint come from '
        f"`[parameters]`; these keys override them: {overriding}. If neither `bandwidth` nor `boundary` (for `pd`: "
        "`stiffness`, `damping`) is set, both follow from inertia and period; `jointid check` shows them.",
        "",
    )
    for name, law in bench_file._LAWS.items():
        meaning = inspect.cleandoc(law.__doc__ or "").partition("\n")[0]
        yield from (f'### `law = "{name}"`', "", markdown(meaning), "")
        defaults = law().asdict()
        for key, entry in described(law).items():
            if key in _ESTIMATES:
                continue
            kind = kind_in_toml(type(defaults[key]).__name__)
            yield from definition(key, kind, markdown(entry.text))


def _emulated_joint() -> Iterator[str]:
    """Return the true values and the sensor of an emulated joint."""
    yield from (
        "## `[session.emulated.truth]`",
        "",
        "True values of the parameters of the joint's model, by name, as in `[parameters]`: `coulomb = 25.0`. With "
        "`ripple_sin_2` and `ripple_cos_2` the gear itself ripples.",
        "",
        "## `[session.emulated.sensors]`",
        "",
        "The torque sensor. Encoder and converter are the drive's.",
        "",
    )
    defaults = jid.Sensors().asdict()
    for key, entry in described(jid.Sensors).items():
        if key not in bench_file._NOT_EMULATED:
            kind = kind_in_toml(type(defaults[key]).__name__)
            yield from definition(key, f"{kind}{_default(defaults[key])}", markdown(entry.text))
