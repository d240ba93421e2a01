"""Remarks on how a file was read, from the recording's metadata."""

from collections.abc import Mapping
from typing import Any

_SHOWN = 4


def remarks(metadata: Mapping[str, Any]) -> list[str]:
    """Return remarks on how a log was read; empty if there was nothing special.

    Parameters
    ----------
    metadata : mapping
        Metadata of a recording.

    Examples
    --------
    >>> remarks({"topic": "/joint_states", "stamps": "log time"})
    ['times are log times, because the messages have no time stamps']
    """
    found = []
    others = metadata.get("joints_left_out")
    if isinstance(others, Mapping) and others:
        found.append(
            f"joints left out: {', '.join(f'{joint} ({why})' for joint, why in others.items())}"
        )
    found += map(str, metadata.get("of_no_joint", ()))
    if metadata.get("incomplete"):
        found.append(str(metadata["incomplete"]))
    if "topic" in metadata and metadata.get("stamps") == "log time":
        found.append("times are log times, because the messages have no time stamps")
    for name, what in (
        ("repeated_messages", "repeat another message and are left out"),
        (
            "reordered_messages",
            "are older than the previous message; all messages were sorted by time",
        ),
    ):
        count = metadata.get(name)
        if isinstance(count, int) and count:
            found.append(f"{count} messages {what}")
    topics = metadata.get("topics_not_compared")
    if isinstance(topics, int) and topics:
        what = "1 topic is" if topics == 1 else f"{topics} topics are"
        found.append(
            f"{what} not compared with the chosen topic, because too many topics have the same number of messages"
        )
    dropped = metadata.get("dropped_rows")
    if isinstance(dropped, int) and dropped:
        rows = "1 damaged row is" if dropped == 1 else f"{dropped} damaged rows are"
        found.append(f"{rows} left out")
    overridden = metadata.get("overridden_units")
    if isinstance(overridden, Mapping):
        found += [
            f"{signal} is read in the unit that the call states, not in the file's unit {unit}"
            for signal, unit in overridden.items()
        ]
    repeated = metadata.get("repeated_rows")
    if isinstance(repeated, int) and repeated:
        rows = "1 row repeats" if repeated == 1 else f"{repeated} rows repeat"
        verb = "is" if repeated == 1 else "are"
        found.append(f"{rows} an earlier row and {verb} left out")
    empty = metadata.get("empty_rows")
    if isinstance(empty, int) and empty:
        found.append(f"{empty} row(s) of zeros at the end are left out")
    rounded = metadata.get("rounded_stamps")
    if isinstance(rounded, Mapping):
        resolution, period = (
            1e3 * float(rounded.get(key, 0.0)) for key in ("resolution", "period")
        )
        found.append(
            f"time stamps had a resolution of {resolution:.4g} ms; evenly spaced stamps, {period:.4g} ms apart, "
            "replace these stamps"
        )
    cut = metadata.get("cut_samples")
    if isinstance(cut, int) and cut:
        found.append(
            f"{cut} samples at the ends are left out, because one channel has no samples there"
        )
    if metadata.get("converted"):
        found.append(str(metadata["converted"]))
    skipped = metadata.get("not_read")
    if isinstance(skipped, list | tuple) and skipped:
        more = f" and {len(skipped) - _SHOWN} more" if len(skipped) > _SHOWN else ""
        found.append(f"these objects are not read: {', '.join(map(str, skipped[:_SHOWN]))}{more}")
    return found
