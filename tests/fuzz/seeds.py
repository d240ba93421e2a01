"""Valid files of every format that is read, small, and who reads them."""

import tempfile
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import message_files
import numpy as np
from read_back.registry import EXAMPLES
from recording_files import mat

import jointid as jid
from jointid.hardware.can.frame_log import logged_frames

Use = Callable[[Path], object]


def _run(count: int = 12) -> jid.Recording:
    time = np.arange(count) * 1e-3
    return jid.Recording(time=time, position=np.sin(time), torque=np.cos(time), sensor=time)


def _saved(ending: str) -> Callable[[Path], None]:
    return lambda path: _run().save(path.with_name(f"seed{ending}"))


def _text(path: Path) -> None:
    rows = "".join(f"0,{k:03d};{k % 5},5;{k}\n" for k in range(12))
    path.write_text(f"Zeit [s];Position [deg];Moment [Nm]\n{rows}", encoding="utf-8")


def _mat(path: Path, *, packed: bool) -> None:
    run = _run()
    values = {"time": run.time, "position": run.position, "torque": run.torque}
    mat(path, {"run": values, "table": np.eye(8)}, do_compression=packed)


def _hdf5(path: Path) -> None:
    import h5py

    run = _run()
    packed: dict[str, dict[str, Any]] = {
        "time": {"compression": "gzip"},
        "position": {"compression": "gzip", "shuffle": True, "fletcher32": True, "chunks": (5,)},
        "velocity": {"chunks": (5,)},
        "torque": {},
        "temperature": {"compression": "lzf"},
    }
    with h5py.File(path, "w") as file:
        for name, options in packed.items():
            values = getattr(run, name, None)
            values = run.time if values is None else values
            file.create_dataset(f"run/{name}", data=values, **options)


def _parquet(path: Path) -> None:
    import pyarrow
    from pyarrow import parquet

    run = _run()
    parquet.write_table(
        pyarrow.table({name: getattr(run, name) for name in ("time", "position", "torque")}), path
    )


def _lerobot(path: Path) -> None:
    import pyarrow
    from pyarrow import parquet

    run = _run()
    states = pyarrow.array(np.column_stack([run.position, run.time]).tolist())
    frames = {"frame_index": np.arange(12), "episode_index": np.arange(12) // 6}
    columns = {"observation.state": states, "action": states, "timestamp": run.time, **frames}
    parquet.write_table(pyarrow.table(columns), path)


def _lerobot_use(path: Path) -> object:
    return jid.load(path, joints="all", units={"position": "deg", "reference": "deg"})


def _sent() -> list[message_files.Sent]:
    return [message_files.joint_state("/joint_states", each) for each in message_files.motion(12)]


def _db3(path: Path) -> None:
    folder = message_files.ros2_bag(path.parent / "bag", _sent())
    (found,) = folder.glob("*.db3")
    path.write_bytes(found.read_bytes())


def _candump(path: Path) -> None:
    path.write_text(
        "".join(f"(1700000000.{k:06d}) can0 {0x180 + k:03X}#0011{k:02X}\n" for k in range(12)),
        encoding="ascii",
    )


def _asc(path: Path) -> None:
    import can

    with can.Logger(str(path)) as log:
        for number in range(12):
            log(can.Message(timestamp=float(number), arbitration_id=0x181, data=bytes(8)))


_FORMATS: dict[str, tuple[str, Callable[[Path], object], Use, str]] = {
    "csv": (".csv", _saved(".csv"), jid.load, ""),
    "csv.gz": (".csv.gz", _saved(".csv.gz"), jid.load, ""),
    "text": (".txt", _text, jid.load, ""),
    "npz": (".npz", _saved(".npz"), jid.load, ""),
    "mat": (".mat", lambda path: _mat(path, packed=False), jid.load, "scipy"),
    "packed mat": (".mat", lambda path: _mat(path, packed=True), jid.load, "scipy"),
    "hdf5": (".h5", _hdf5, jid.load, "h5py"),
    "parquet": (".parquet", _parquet, jid.load, "pyarrow"),
    "lerobot": (".parquet", _lerobot, _lerobot_use, "pyarrow"),
    "mcap": (".mcap", lambda path: message_files.mcap(path, _sent()), jid.load_robot, "mcap"),
    "bag": (".bag", lambda path: message_files.ros1_bag(path, _sent()), jid.load_robot, "rosbags"),
    "db3": (".db3", _db3, jid.load_robot, "rosbags"),
    "candump": (".log", _candump, lambda path: list(logged_frames(path)), ""),
    "asc": (".asc", _asc, lambda path: list(logged_frames(path)), ""),
    "blf": (".blf", _asc, lambda path: list(logged_frames(path)), ""),
}


def readers() -> Iterator[str]:
    """Yield the names of what is read, as far as the packages are installed."""
    yield from (
        name for name, (*_, package) in _FORMATS.items() if not package or find_spec(package)
    )
    yield from (f"our {name}" for name in EXAMPLES)


def seed_of(name: str) -> tuple[str, bytes, dict[str, bytes], Use]:
    """Return a file's name, its valid content, the files beside it, and its reader."""
    if name.startswith("our "):
        example = EXAMPLES[name.removeprefix("our ")]()
        return example.name, example.text().encode(), example.beside, example.use
    ending, write, use, _ = _FORMATS[name]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"seed{ending}"
        write(path)
        return path.name, path.read_bytes(), {}, use
