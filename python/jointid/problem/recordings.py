"""Checks of the recordings of a problem, and their torque at the output."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from jointid.base.advice import Action
from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.recording.plausibility import TIME_UNITS, slow_stamps, time_unit
from jointid.recording.recording import Recording

Array = NDArray[np.float64]

# Largest share of gaps among the intervals: above it, the median interval is not the sample period.
_MOST_GAPS = 0.1
# Largest share of the time within gaps, if there are this number of gaps.
_SOME_GAPS, _MOST_MISSING = 0.02, 0.5

# Sample period [s] above which stamps probably count a shorter unit than seconds; such samples are refused.
_SLOWEST = 50.0

# Largest magnitudes of signals: squares, and sums of squares, do not overflow.
_SMALLEST, _LARGEST = 1e-100, 1e100

_FEW = 0.01  # share of samples: fewer are single faults, more are a wrong scale

_RECORDING_EXPECTED = "a Recording is expected, or several; load reads a Recording from a file"


def listed(recordings: Recording | Sequence[Recording]) -> tuple[Recording, ...]:
    """Return one or several recordings as a checked tuple.

    Raises
    ------
    InputError
        There is no recording, an argument is not a recording, a recording is given twice, there are too many gaps,
        the square of a signal overflows, or revolute and prismatic recordings are mixed.
    """
    if isinstance(recordings, Recording):
        recordings = (recordings,)
    if isinstance(recordings, Mapping):  # a recording of several joints
        raise InputError(
            "a Recording of one joint is expected, or several of the same joint",
            argument="recordings",
            value=recordings,
            remedy="name a joint",
        )
    if hasattr(recordings, "columns") or hasattr(recordings, "data_vars"):
        raise InputError(
            "a Recording is expected, not a data frame",
            argument="recordings",
            value=type(recordings).__name__,
            remedy="jid.Recording.from_dataframe(frame) reads its columns",
        )
    if not isinstance(recordings, Iterable) or isinstance(recordings, str):
        raise InputError(_RECORDING_EXPECTED, argument="recordings", value=recordings)
    runs = tuple(recordings)
    if not runs:
        raise InputError("at least one recording is expected", argument="recordings", value=[])
    known: dict[object, list[int]] = {}  # ranges of the signals → recordings
    for number, run in enumerate(runs):
        place = f"recording {number}"
        if not isinstance(run, Recording):
            raise InputError(_RECORDING_EXPECTED, argument="recordings", value=run, place=place)
        if run.sample_period >= _SLOWEST:
            raise _of_stamps(run, number)
        lowest, highest = run.ranges["position"]
        travel = highest - lowest
        if not run.velocity_derived and run.ranges["velocity"] == (0.0, 0.0) and travel > 0.0:
            raise InputError(
                f"the velocity is always 0, but the position changes by {travel:.3g}; some drivers log 0 "
                "without a measurement",
                argument="velocity",
                place=place,
                remedy=Action(
                    "call",
                    {"columns": {"velocity": None}},
                    function="load",
                    text="the velocity is then derived from the position",
                ),
            )
        if _comes_in_bursts(run):
            period = float(f"{run.duration / (len(run) - 1):.6g}")
            raise InputError(
                f"{100 * len(run.gaps) / len(run):.0f} % of the sample intervals are gaps, probably because a bus "
                "delivers the samples in bursts",
                argument="time",
                place=place,
                remedy=(
                    "use the drive's time stamps instead of the host's",
                    Action("call", {"sample_period": period}, "if no sample is missing", "load"),
                ),
            )
        if run.kind != runs[0].kind:
            raise InputError(
                f"recording 0 is {runs[0].kind}",
                argument="kind",
                value=run.kind,
                place=place,
                remedy="identify them separately",
            )
        _check_magnitudes(run, place)
        alike = known.setdefault(tuple(run.ranges.items()), [])
        for earlier in alike:
            if _same(runs[earlier], run):
                raise InputError(
                    f"this recording is the same as recording {earlier}; the same samples must not be counted twice",
                    place=place,
                    remedy="give each recording once",
                )
        alike.append(number)
    return runs


def _comes_in_bursts(run: Recording) -> bool:
    """Whether gaps are so frequent or so long that the other intervals are not the sample period."""
    count = len(run.gaps)
    if count <= _SOME_GAPS * len(run):
        return False
    missing = sum(gap.duration for gap in run.gaps)
    return count > _MOST_GAPS * len(run) or missing > _MOST_MISSING * run.duration


def recording_names(recordings: Sequence[Recording]) -> tuple[str, ...]:
    """Return a unique name for each recording: its own name, or its number."""
    counted = Counter(each.name for each in recordings)
    return tuple(
        each.name if each.name and counted[each.name] == 1 else f"recording {number}"
        for number, each in enumerate(recordings)
    )


def _same(one: Recording, other: Recording) -> bool:
    """Whether two recordings of the same signals have the same values; names are ignored."""
    if one is other:
        return True
    if one.extra.keys() != other.extra.keys() or one.torque_hold != other.torque_hold:
        return False
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in one.ranges
    ) and all(np.array_equal(one.extra[name], other.extra[name]) for name in one.extra)


def _check_magnitudes(run: Recording, place: str) -> None:
    for name, (lowest, highest) in run.ranges.items():
        largest = max(highest, -lowest)
        if name == "time" or largest == 0.0 or _SMALLEST <= largest <= _LARGEST:
            continue
        values = getattr(run, name)
        beyond = np.flatnonzero(np.abs(values) > _LARGEST)
        if 0 < len(beyond) <= _FEW * len(values):
            index = int(beyond[0])
            rest = float(np.abs(np.delete(values, beyond)).max())
            raise InputError(
                f"{len(beyond)} sample(s) have this size, the first at {float(run.time[index]):.6g} s; all other "
                f"samples are at most {rest:.3g}, so these are not measured values",
                argument=name,
                value=float(values[index]),
                place=place,
                remedy="cut such samples out, and check the logger",
            )
        raise InputError(
            "a measured signal cannot have a value of this size",
            argument=name,
            value=largest,
            place=place,
            remedy="check unit and scale",
        )


def _conversions(recording: Recording, signal: str) -> tuple[Action, ...]:
    """Return the calls that load the torque at the output without a joint."""
    if signal == "motor_torque":
        text = "motor angle per joint angle"
        return (Action("call", {"gear_ratio": ...}, text, "load"),)
    header = recording.metadata.get("commanded_torque")
    if not isinstance(header, str):
        return ()
    return (Action("call", {"columns": {"torque": header}}, "a commanded torque", "load"),)


def raise_if_slowly_sampled(recordings: Sequence[Recording]) -> None:
    """Raise `InputError` for stamps that are probably not seconds, because other errors would follow from this."""
    for number, run in enumerate(recordings):
        if slow_stamps(run.sample_period) is not None:
            raise _of_stamps(run, number)


def _of_stamps(run: Recording, number: int) -> InputError:
    unit = time_unit(run.sample_period)
    return InputError(
        f"the samples are {run.sample_period:.3g} s apart: the time stamps are probably in {TIME_UNITS[unit]}",
        argument="time",
        place=run.name or f"recording {number}",
        remedy=Action("call", {"units": {"time": unit}}, function="load"),
    )


def output_torque(recording: Recording, joint: Joint | None) -> Array:
    """Return the drive's torque at the output [N·m or N].

    Raises
    ------
    InputError
        The recording has no torque, or only one on the motor side and there is no joint to convert it.
    """
    if joint is not None:
        return joint.output_torque(recording)
    if recording.torque is not None:
        return recording.torque
    facts = {"torque_constant": ..., "gear_ratio": ...}
    for signal, needs in (
        (
            "motor_torque",
            Action(
                "call", {"joint": ...}, "with the joint's gear_ratio, which converts the torque"
            ),
        ),
        ("current", Action("call", facts, "facts of motor and gear", "Joint")),
    ):
        if getattr(recording, signal) is not None:
            raise InputError(
                f"the recording has no torque at the output, only {signal} on the motor side",
                argument="torque",
                remedy=(*_conversions(recording, signal), needs),
            )
    raise InputError(
        "the recording has no signal torque",
        argument="torque",
        remedy=(
            Action("call", {"columns": {"torque": ...}}, function="load"),
            Action("call", {"columns": {"current": ...}}, "if the column is in amperes", "load"),
        ),
    )
