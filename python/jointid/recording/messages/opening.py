"""Opening a file of messages as a table: choose its topic, read its messages."""

from collections.abc import Callable
from pathlib import Path

from jointid.base.errors import InputError
from jointid.recording.messages.choice import chosen_topic
from jointid.recording.messages.collecting import collect
from jointid.recording.messages.companions import with_companions
from jointid.recording.messages.message_table import MessageTable, no_messages
from jointid.recording.messages.topic import DamageError, Source


def opened(
    path: Path, source: Callable[[Path], Source], *, topic: str | None, kind: str | None
) -> MessageTable:
    """Return the messages of one topic as a table.

    Parameters
    ----------
    path : Path
    source : callable
        Opens the file.
    topic : str or None
        Name of the topic. Default: the only topic with joints.
    kind : {"revolute", "prismatic"}, optional
        Kind of the joints. Default: revolute.

    Raises
    ------
    InputError
        The file is damaged, or no topic can be chosen.
    """
    place = str(path)
    try:
        messages = source(path)
        chosen = chosen_topic(path, messages.topics, topic, messages.incomplete)
        place = f"{path}, topic {chosen.name}"
        collected = with_companions(messages, chosen, collect(messages, chosen))
    except DamageError as error:
        raise InputError(str(error), place=place) from None
    if not len(collected.log_times):
        raise no_messages(path, chosen, messages.incomplete)
    return MessageTable(
        path, chosen, collected, kind=kind or "revolute", incomplete=messages.incomplete
    )
