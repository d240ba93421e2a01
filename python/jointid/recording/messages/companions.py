"""Other topics with the same stamps: they add columns to the same rows."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from jointid.recording.messages.collecting import READ, Collected, collect
from jointid.recording.messages.decoding import Block
from jointid.recording.messages.joints import is_joint_kind
from jointid.recording.messages.topic import DamageError, Message, Source, Topic

_TRIED = 16  # first messages that are compared before a topic is read
_MOST_TOPICS, _LEAST_TOPICS = 256, 64  # limits of the number of compared topics
_PASSED = (
    10_000_000  # messages that may be scanned in total: each topic needs one pass over the file
)


def with_companions(source: Source, chosen: Topic, collected: Collected) -> Collected:
    """Return a topic's messages, joined with those of the topics that have exactly the same stamps.

    The added columns are ``TOPIC.FIELD``. Topics with other stamps are not added, because that would need
    interpolation.

    Parameters
    ----------
    source : Source
    chosen : Topic
    collected : Collected
        The topic's messages.
    """
    if collected.stamps is None or not is_joint_kind(chosen.kind):
        return collected
    blocks = list(collected.blocks)
    others = [
        topic
        for topic in source.topics
        if topic.name != chosen.name
        and not is_joint_kind(topic.kind)
        and topic.count == len(collected.stamps)
        and topic.encoding in READ
    ]
    messages = sum(topic.count or 0 for topic in source.topics)
    compared = min(max(_PASSED // max(messages, 1), _LEAST_TOPICS), _MOST_TOPICS)
    for topic in others[:compared]:
        blocks += _blocks(source, topic, collected)
    return replace(collected, blocks=tuple(blocks), not_compared=max(0, len(others) - compared))


def _blocks(source: Source, topic: Topic, collected: Collected) -> list[Block]:
    stamps = collected.stamps
    try:
        some = collect(_Beginning(source), topic).stamps
        if some is None or stamps is None or not np.array_equal(some, stamps[: len(some)]):
            return []
        found = collect(source, topic)
    except DamageError:  # damage in a topic that was not requested
        return []
    if found.stamps is None or not np.array_equal(found.stamps, stamps):
        return []
    return [
        replace(block, columns=tuple(("", f"{topic.name}.{field}") for _, field in block.columns))
        for block in found.blocks
    ]


class _Beginning:
    """The first messages of a file."""

    incomplete = ""

    def __init__(self, source: Source) -> None:
        self._source = source
        self.topics = source.topics

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the first messages of a topic."""
        return islice(self._source.messages(topic), _TRIED)
