"""Reading ROS 1 bags (.bag) and ROS 2 bags (a folder, or a .db3 file of one); the extra `ros` is needed."""

from pathlib import Path

from jointid.recording.readers.reader import Reader
from jointid.recording.table import Table


def _opened(path: Path, *, part: str | None = None, kind: str | None = None) -> Table:
    from jointid.recording.messages.opening import opened
    from jointid.recording.messages.ros1_source import Ros1Source
    from jointid.recording.messages.ros2_source import FolderSource, SqliteSource

    if path.is_dir():
        return opened(path, FolderSource, topic=part, kind=kind)
    ros1 = path.name.lower().endswith(".bag")
    return opened(path, Ros1Source if ros1 else SqliteSource, topic=part, kind=kind)


READER = Reader(
    endings=(".bag", ".db3"),
    open=_opened,
    package=("rosbags", "mcap", "lz4", "zstandard"),
    install="mcap rosbags",
    part="topic",
    folder=(".db3", ".mcap", ".db3.zstd", ".mcap.zstd"),
)
