"""Reading .mcap files with mcap, and the messages in them with rosbags; the extra `ros` installs both."""

from pathlib import Path

from jointid.recording.readers.reader import Reader
from jointid.recording.table import Table


def _opened(path: Path, *, part: str | None = None, kind: str | None = None) -> Table:
    from jointid.recording.messages.mcap_source import McapSource
    from jointid.recording.messages.opening import opened

    return opened(path, McapSource, topic=part, kind=kind)


READER = Reader(
    endings=(".mcap",),
    open=_opened,
    package=("mcap", "rosbags"),
    install="mcap rosbags",
    part="topic",
)
