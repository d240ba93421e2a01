"""Command `info`: the signals of a recording, and properties that the data show."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.cli.reading import how_to_read, joints_wanted, load_all
from jointid.cli.robot_contents import several_of, show_robot
from jointid.cli.wording import Wording

if TYPE_CHECKING:
    from jointid.identification.warnings.inspection import Inspected
    from jointid.recording.recording import Recording

_SLOW = 0.01  # share of the peak speed
_IN_HEADLINE = ("name", "kind", "samples", "duration [s]", "sample period [s]", "gaps", "velocity")
_LESS = (  # shown with -v
    "fingerprint",
    "stamps scatter by [s]",
    "slower than 1 % of the peak speed [%]",
    "velocity later than the position by [s]",
)


def info(arguments: argparse.Namespace) -> None:
    """Show what a recording holds."""
    import json

    if several_of(arguments):
        show_robot(arguments)
        return
    try:
        (recording,) = load_all([arguments.recording], arguments)
    except InputError as error:
        from jointid.cli.friction_map import printed_map

        printed_map([arguments.recording], arguments, error)
        return
    contents = _contents(recording, Wording.of(arguments))
    if names := _unrecognised(arguments):
        contents["columns not recognised"] = names
    if arguments.json:
        print(json.dumps(contents, indent=1, ensure_ascii=False))
        return
    print(_headline(recording))
    print(*map(_signal_line, contents["signals"].items()), sep="\n")
    for label, value in contents.items():
        if label not in (*_IN_HEADLINE, "signals") and (arguments.verbose or label not in _LESS):
            print(f"{label}: {value}")


def _headline(recording: Recording) -> str:
    """Return a summary in one line."""
    velocity = "derived from the position" if recording.velocity_derived else "recorded"
    gaps = f", {len(recording.gaps)} gaps" if recording.gaps else ""
    return (
        f"{recording.name or 'recording'}: {recording.kind}, {len(recording)} rows over {recording.duration:.6g} s, "
        f"one every {1e3 * recording.sample_period:.4g} ms{gaps}; velocity {velocity}"
    )


def _signal_line(signal: tuple[str, Mapping[str, Any]]) -> str:
    name, facts = signal
    line = f"  {name:14s} {facts['min']:12.6g} … {facts['max']:<12.6g} {facts['unit']:9s}"
    step = facts.get("smallest step")
    return line.rstrip() if step is None else f"{line} smallest step {step:.3g}"


def _unrecognised(arguments: argparse.Namespace) -> str:
    """Return the first twelve columns that were not read and have an unknown header."""
    from jointid.recording.headers import understood
    from jointid.recording.readers.loading import table_of
    from jointid.recording.readers.read_columns import columns_read

    reading = how_to_read(arguments)
    table = table_of(
        arguments.recording,
        topic=arguments.topic,
        group=arguments.group,
        unpacked=arguments.unpacked,
    )
    if table.saved is not None:
        return ""
    joints = joints_wanted(arguments)
    read = columns_read(table, joints[0] if joints else None, reading)
    names = [
        header
        for k, header in enumerate(table.headers)
        if k not in read and understood(header).meaning is None
    ]
    more = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return ", ".join(names[:12]) + more


def _contents(recording: Recording, wording: Wording) -> dict[str, Any]:
    from jointid.identification.warnings.inspection import inspect
    from jointid.recording.file_remarks import remarks
    from jointid.recording.plausibility import slow_stamps
    from jointid.recording.plausible_units import proposed_units

    seen = inspect(recording)
    contents = _facts(recording, seen) | _measured(recording, seen)
    if (slow := slow_stamps(recording.sample_period)) is not None:
        cause, unit = slow
        advice = wording.of_action(Action("call", {"units": {"time": unit}}, function="load"))
        contents["warning"] = f"{cause}; {advice}"
    if proposed := proposed_units(recording):
        doubt = "; ".join(
            f"{name} in {each.unit}: {each.reason}" for name, each in proposed.items()
        )
        contents["units in doubt"] = doubt
    assumed, left_out = (recording.metadata.get(key) for key in ("assumed_units", "left_out"))
    if assumed and isinstance(assumed, list | tuple):
        contents["SI units assumed"] = ", ".join(map(str, assumed))
    recognised = recording.metadata.get("recognised_units")
    if recognised and isinstance(recognised, Mapping):
        contents["units recognised"] = ", ".join(f"{k} in {v}" for k, v in recognised.items())
    if left_out and isinstance(left_out, list | tuple):
        columns = [each for each in left_out if isinstance(each, Mapping)]
        contents["not read"] = "; ".join(f"{x.get('column')} ({x.get('reason')})" for x in columns)
    interpolated = recording.metadata.get("interpolated")
    if interpolated and isinstance(interpolated, Mapping):
        contents["interpolated"] = ", ".join(f"{k} (every {v})" for k, v in interpolated.items())
    if recording.metadata.get("topic"):
        contents["topic"] = recording.metadata["topic"]
    stated = recording.metadata.get("stated")
    if stated and isinstance(stated, Mapping):
        contents["stated in the file"] = ", ".join(f"{k} {v}" for k, v in stated.items())
        contents |= _pendulum(stated)
    runs = recording.metadata.get("runs")
    if runs and isinstance(runs, list | tuple):
        contents["runs, one after the other"] = ", ".join(map(str, runs))
    if said := remarks(recording.metadata):
        contents["read"] = "; ".join(said)
    return contents


def _pendulum(stated: Mapping[str, Any]) -> dict[str, str]:
    """Return a joint file's [link] for a load on an arm, from BAM's logs: it hangs down at position 0."""
    mass, arm, length = (stated.get(name) for name in ("mass", "arm_mass", "length"))
    known = [each for each in (mass, arm or 0.0, length) if isinstance(each, int | float)]
    if len(known) < 3 or min(known) < 0.0 or known[0] + known[1] == 0.0:
        return {}
    load, rod, reach = known
    link = {
        "mass": load + rod,
        "centre_of_mass": reach * (load + rod / 2.0) / (load + rod),
        "inertia": reach**2 * (load + rod / 3.0),
    }
    lines = "; ".join(f"{name} = {value:.6g}" for name, value in link.items())
    return {"as a joint file's [link]": f'{lines}; angle = "-90deg"'}


def _facts(recording: Recording, seen: Inspected) -> dict[str, Any]:
    return {
        "name": recording.name,
        "kind": recording.kind,
        "samples": len(recording),
        "duration [s]": round(recording.duration, 9),
        "sample period [s]": round(recording.sample_period, 9),
        "gaps": len(recording.gaps),
        "velocity": "derived from the position" if recording.velocity_derived else "recorded",
        "fingerprint": recording.fingerprint,
        "signals": {
            signal: {
                "min": float(getattr(recording, signal).min()),
                "max": float(getattr(recording, signal).max()),
                "unit": recording.unit(signal),
                **_step(seen, signal),
            }
            for signal in recording.signals
        }
        | {
            name: {
                "min": float(values.min()),
                "max": float(values.max()),
                "unit": recording.unit(name),
            }
            for name, values in recording.extra.items()
        },
    }


def _step(seen: Inspected, signal: str) -> dict[str, float]:
    """Return the smallest change of a signal between two rows: its resolution, if that is coarse."""
    if signal not in seen.channels:
        return {}
    smallest = seen.counts(signal).smallest
    return {"smallest step": smallest} if math.isfinite(smallest) else {}


def _measured(recording: Recording, seen: Inspected) -> dict[str, Any]:
    """Return properties from the data: jitter of the time stamps, share at rest, agreement of velocity and position."""
    found: dict[str, Any] = {"stamps scatter by [s]": float(f"{seen.found.timing_errors[0]:.3g}")}
    if (speed := seen.found.peak_speed) > 0.0:
        slow = abs(recording.velocity) < _SLOW * speed
        found["slower than 1 % of the peak speed [%]"] = round(100.0 * float(slow.mean()), 2)
    if (stale := seen.stale_share("position")) > 0.0:
        found["rows that repeat the position [%]"] = round(100.0 * stale, 2)
    if (agreement := seen.found.agreement) is not None:
        found["position's rate over the velocity"] = float(f"{agreement.scale:.5g}")
        found["velocity later than the position by [s]"] = float(f"{agreement.lag:.3g}")
    return found
