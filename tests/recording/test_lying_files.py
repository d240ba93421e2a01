"""Small files that hold more than they say: refused in one sentence, before the libraries unpack them."""

import contextlib
import inspect
import io
import itertools
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lanes import slow_but
from measured_reading import on_linux, refusal

import jointid as jid
from jointid.base.unpacking import Room
from jointid.recording.readers.parquet_sizes import Sizes, pages_size

_NAMES = ("time", "position", "torque")


def _zigzag(number: int, width: int = 0) -> bytes:
    """A number of Thrift's compact protocol, in so many bytes."""
    number *= 2
    parts: list[int] = []
    while number or not parts:
        parts.append(number & 127)
        number >>= 7
    parts += [0] * (width - len(parts))
    return bytes([*(part | 128 for part in parts[:-1]), parts[-1]])


def parquet_pages(path: Path) -> str:
    """A column is one page of 480 MB; the footer says 12 rows, everywhere."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    rows = 60_000_000
    known = inspect.signature(writer.ParquetWriter.__init__).parameters
    one_page = {"max_rows_per_page": rows} if "max_rows_per_page" in known else {}
    writer.write_table(
        pyarrow.table({name: np.zeros(rows, "f8" if name == "time" else "i1") for name in _NAMES}),
        path,
        row_group_size=rows,
        data_page_size=2**31 - 1,
        write_batch_size=rows,
        compression="zstd",
        use_dictionary=False,
        write_statistics=False,
        **one_page,
    )
    content = path.read_bytes()
    start = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
    said = _zigzag(rows)
    footer = content[start:].replace(said, _zigzag(12, len(said)))
    path.write_bytes(content[:start] + footer)
    assert writer.ParquetFile(path).metadata.num_rows == 12
    return "unpacked file is larger than"


def parquet_rows(path: Path) -> str:
    """A group of rows says 150 billion of them: damage at four bytes of 1330, found among a million."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    rows = 1_000_003  # found twice in the footer behind the columns' own: of the group, and of the file
    writer.write_table(pyarrow.table({name: np.zeros(rows) for name in _NAMES}), path)
    content = path.read_bytes()
    start = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
    said = _zigzag(rows)
    footer = content[start:].replace(said, _zigzag(12, len(said)), 1)  # the first is the file's
    path.write_bytes(content[:start] + footer)
    return "its row groups hold 1000003 rows, but the file has 12"


def parquet_texts(path: Path) -> str:
    """A text of 100 kB, in each of 8,000 cells."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    cells = ["y" * 100_000] * 100
    table = pyarrow.table({"time": np.zeros(100), "position": cells, "torque": np.zeros(100)})
    with writer.ParquetWriter(path, table.schema, compression="zstd") as file:
        for _ in range(80):
            file.write_table(table)
    return "at index 0 is not a number"


def hdf5_chunk(path: Path) -> str:
    """A chunk of 12 numbers that holds 800 MB."""
    h5py = pytest.importorskip("h5py")
    packer = zlib.compressobj(9)
    packed = b"".join(packer.compress(bytes(10_000_000)) for _ in range(80)) + packer.flush()
    with h5py.File(path, "w") as file:
        for name in _NAMES:
            dataset = file.create_dataset(name, (12,), "f8", chunks=(12,), compression="gzip")
            try:
                dataset.id.write_direct_chunk((0,), packed)
            except OSError:
                pytest.skip("this HDF5 does not write a chunk so much larger than its numbers")
    return "a chunk holds more than the expected 96 bytes"


def hdf5_large_chunk(path: Path) -> str:
    """A chunk of 800 MB, of a dataset of 12 numbers."""
    h5py = pytest.importorskip("h5py")
    packer = zlib.compressobj(9)
    packed = b"".join(packer.compress(bytes(10_000_000)) for _ in range(80)) + packer.flush()
    with h5py.File(path, "w") as file:
        for name in _NAMES:
            dataset = file.create_dataset(
                name, (12,), "f8", chunks=(100_000_000,), maxshape=(None,), compression="gzip"
            )
            dataset.id.write_direct_chunk((0,), packed)
    return "unpacked file is larger than"


def npz_bzip2(path: Path) -> str:
    """A member of 600 MB, of which the archive's index says 56 MB."""
    head = io.BytesIO()
    shape = {"descr": "<f8", "fortran_order": False, "shape": (7_000_000,)}
    np.lib.format.write_array_header_1_0(head, shape)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_BZIP2) as archive:
        with archive.open("time.npy", "w", force_zip64=True) as member:
            member.write(head.getvalue())
            for _ in range(60):
                member.write(bytes(10_000_000))
        for name in ("position.npy", "torque.npy"):
            archive.writestr(name, head.getvalue())
        archive.infolist()[0].file_size = len(head.getvalue()) + 56_000_000
    return "its compression method differs from the method of numpy.savez_compressed"


LIES: tuple[Callable[[Path], str], ...] = (
    *(parquet_pages, parquet_rows, parquet_texts, hdf5_chunk, hdf5_large_chunk, npz_bzip2),
)


@on_linux
@pytest.mark.parametrize("lie", slow_but(LIES, "parquet_rows"), ids=lambda lie: lie.__name__)
def test_a_file_that_lies_is_refused_in_little_memory(
    lie: Callable[[Path], str], tmp_path: Path
) -> None:
    ending = {"parquet": ".parquet", "hdf5": ".h5", "npz": ".npz"}[lie.__name__.partition("_")[0]]
    path = tmp_path / f"lie{ending}"
    expected = lie(path)
    assert path.stat().st_size < 3_000_000
    assert expected in refusal(path)


def _written(writer: Any, table: Any, **options: Any) -> bytes:
    file = io.BytesIO()
    writer.write_table(table, file, row_group_size=1000, data_page_size=2000, **options)
    return file.getvalue()


def _chunks(writer: Any, content: bytes) -> list[tuple[int, int, int]]:
    """Start, end and bytes with headers, of each column of each group."""
    metadata = writer.ParquetFile(io.BytesIO(content)).metadata
    found = []
    for group, leaf in itertools.product(
        range(metadata.num_row_groups), range(metadata.num_columns)
    ):
        chunk = metadata.row_group(group).column(leaf)
        start = chunk.data_page_offset
        if chunk.has_dictionary_page:
            start = min(start, chunk.dictionary_page_offset)
        end = start + chunk.total_compressed_size
        found.append((start, end, chunk.total_uncompressed_size))
    return found


def test_pages_hold_what_a_true_footer_says() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    count = 3000
    table = pyarrow.table(
        {
            "time": np.arange(count) * 1e-3,
            "zero": np.zeros(count),
            "text": [f"joint {k % 7}" for k in range(count)],
            "few": pyarrow.array([None if k % 3 else float(k) for k in range(count)]),
            "pair": [[1.0, 2.0]] * count,
        }
    )
    for packed, dictionary, version, described in itertools.product(
        ("none", "snappy", "gzip", "zstd"), (True, False), ("1.0", "2.0"), (True, False)
    ):
        content = _written(
            writer,
            table,
            compression=packed,
            use_dictionary=dictionary,
            data_page_version=version,
            write_statistics=described,
            write_page_index=described,
        )
        chunks = _chunks(writer, content)
        for start, end, size in chunks:
            held = pages_size(content, start, end)
            assert size - 100 * (end - start) < held < size  # the footer counts headers, too
            assert held > 0
        sizes = Sizes(content)
        assert sizes.rows == count
        for leaf in range(5):
            own = (pages_size(content, start, end) for start, end, _ in chunks[leaf::5])
            assert sizes.of(leaf) == sum(own)


@settings(max_examples=300)
@given(content=st.binary(max_size=200), start=st.integers(-3, 20), length=st.integers(-3, 250))
def test_any_bytes_are_pages_or_damage(content: bytes, start: int, length: int) -> None:
    with contextlib.suppress(ValueError):
        assert pages_size(content, start, start + length) >= 0


@settings(max_examples=300)
@given(place=st.integers(0, 10**6), value=st.integers(0, 255), wide=st.booleans())
def test_any_footer_is_read_or_damaged(place: int, value: int, wide: bool) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    content = bytearray(_written(writer, pyarrow.table({"time": [0.0, 1.0], "text": ["a", "b"]})))
    length = int.from_bytes(content[-8:-4], "little")
    where = len(content) - 8 - length + place % (length + 4)
    content[where : where + (4 if wide else 1)] = bytes([value] * (4 if wide else 1))
    try:
        sizes = Sizes(bytes(content))
        assert min(sizes.rows, sizes.of(0), sizes.of(1)) >= 0
        assert all(isinstance(each, int) for each in sizes.encodings(1))
    except (ValueError, LookupError):
        pass


def test_sizes_are_read_as_thrift_reads_them() -> None:
    page = b"\x15\x00\x15%s\x15%s\x00"
    body = bytes(10)
    one = page % (_zigzag(5000), _zigzag(10)) + body
    assert pages_size(one, 0, len(one)) == 5000
    assert pages_size(one + one, 0, 2 * len(one)) == 10_000
    # More than 32 bits are cut off; the last of two sizes counts.
    wide = page % (_zigzag((1 << 34) + 70), _zigzag(10)) + body
    assert pages_size(wide, 0, len(wide)) == 70
    twice = b"\x15\x00\x15%s\x15%s\x05\x04%s\x00" % (_zigzag(7), _zigzag(10), _zigzag(9)) + body
    assert pages_size(twice, 0, len(twice)) == 9
    with pytest.raises(ValueError, match="damaged"):
        pages_size(twice[:6], 0, 6)
    with pytest.raises(ValueError, match="no size"):
        pages_size(b"\x15\x00\x15\x01\x15\x02\x00", 0, 7)
    with pytest.raises(ValueError, match="damaged"):
        pages_size(b"\x1c" * 100, 0, 100)  # structures within each other


def test_pages_count_where_a_column_is_larger_than_its_rows(tmp_path: Path) -> None:
    """Rows and pages are both counted, whichever is more."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    from jointid.recording.readers.parquet_reader import ParquetTable

    path = tmp_path / "a.parquet"
    words = [f"{k:040d}" for k in range(100)]
    table = pyarrow.table({"time": np.zeros(100), "text": words})
    writer.write_table(table, path, use_dictionary=["time"])
    opened = ParquetTable(path)
    opened._room = room = Room(path)
    allowed = room.left
    opened.numbers([0])
    assert allowed - room.left == 8 * 100  # its pages hold a single number
    opened.numbers([0])
    assert allowed - room.left == 8 * 100
    assert opened.text(1) == words
    assert allowed - room.left > 8 * 100 + 40 * 100


@pytest.mark.parametrize("empty", [(0,), (1,), (2,), (0, 1, 2)])
def test_empty_groups_of_rows(empty: tuple[int, ...], tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "a.parquet"
    time = np.arange(60) * 1e-3
    table = pyarrow.table(dict.fromkeys(_NAMES, time))
    with writer.ParquetWriter(path, table.schema) as file:
        for number in range(3):
            file.write_table(table.slice(20 * number, 0 if number in empty else 20))
    if len(empty) < 3:
        assert len(jid.load(path)) == 40
    else:
        with pytest.raises(jid.InputError, match="samples"):
            jid.load(path)


@pytest.mark.parametrize("encoding", ["PLAIN", "DELTA_LENGTH_BYTE_ARRAY", "DELTA_BYTE_ARRAY"])
def test_texts_in_any_encoding(encoding: str, tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "a.parquet"
    time = np.arange(60) * 1e-3
    columns = dict.fromkeys(_NAMES, time) | {"run": ["left", "right", None] * 20}
    encodings = {"run": encoding}
    writer.write_table(
        pyarrow.table(columns), path, use_dictionary=False, column_encoding=encodings
    )
    assert len(jid.load(path, where={"run": "left"})) == 20


def test_texts_by_differences_are_counted(tmp_path: Path) -> None:
    """Each begins like the one before: 1000 texts of 100 kB take less than 1 MB."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    path = tmp_path / "a.parquet"
    cells = ["y" * 100_000] * 200
    columns = {"time": np.zeros(200), "position": cells, "torque": np.zeros(200)}
    table = pyarrow.table(columns)
    encodings = {"position": "DELTA_BYTE_ARRAY"}
    with writer.ParquetWriter(
        path, table.schema, use_dictionary=False, column_encoding=encodings
    ) as file:
        for _ in range(5):
            file.write_table(table)
    assert path.stat().st_size < 1_000_000
    with pytest.raises(jid.InputError, match="unpacked file is larger than"):
        jid.load(path)


def test_groups_that_share_their_pages(tmp_path: Path) -> None:
    """A thousand groups that point to the same pages would be looked through a thousand times."""
    pyarrow = pytest.importorskip("pyarrow")
    writer = pytest.importorskip("pyarrow.parquet")
    file = io.BytesIO()
    writer.write_table(pyarrow.table({"time": np.zeros(3000)}), file, row_group_size=1000)
    sizes = Sizes(file.getvalue())
    assert sizes.of(0) > 0
    assert sizes.encodings(0)
    about = sizes._groups[0][1, 9][0][3, 12]
    about[2, 9] = [{}]  # a list of structures, as damage makes of one of numbers
    sizes._groups *= 1000
    assert sizes.encodings(0) <= set(range(10))
    with pytest.raises(ValueError, match="its footer is damaged"):
        sizes.of(0)


def test_chunks_of_any_kind_are_read(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    count = 40_000
    chance = np.random.default_rng(1)
    kinds: tuple[dict[str, Any], ...] = (
        {"chunks": (20_000,), "compression": "gzip"},
        {"chunks": (20_000,), "compression": "gzip", "shuffle": True, "fletcher32": True},
        {"chunks": (50_000,), "compression": "gzip", "maxshape": (None,), "compression_opts": 0},
        {"chunks": (20_000,), "compression": "lzf"},
    )
    for kind, block in itertools.product(kinds, (0, 512)):
        path = tmp_path / "a.h5"
        signals = {"time": np.arange(count) * 1e-3}
        signals |= {name: chance.normal(size=count) for name in _NAMES[1:]}
        with h5py.File(path, "w", userblock_size=block) as file:
            for name, values in signals.items():
                file.create_dataset(name, data=values, **kind)
        run = jid.load(path)
        assert np.array_equal(run.position, signals["position"])


def test_chunks_packed_twice_are_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "a.h5"
    packed = zlib.compress(zlib.compress(bytes(96)))
    with h5py.File(path, "w") as file:
        for name in _NAMES:
            made_by = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            made_by.set_chunk((12,))
            made_by.set_deflate(9)
            made_by.set_deflate(9)
            space = h5py.h5s.create_simple((12,))
            made = h5py.h5d.create(file.id, name.encode(), h5py.h5t.NATIVE_DOUBLE, space, made_by)
            made.write_direct_chunk((0,), packed)
    with pytest.raises(
        jid.InputError, match="is packed by several filters, which jointid cannot read"
    ):
        jid.load(path)
