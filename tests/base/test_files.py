"""Writing a file whole: a target that cannot be written is named, never the temporary file."""

import errno
import os
from pathlib import Path

import pytest

from jointid import InputError
from jointid.base.files import make_folder, write_new, write_whole


def test_a_folder_that_does_not_exist_is_bad_input(tmp_path: Path) -> None:
    target = tmp_path / "none" / "e.json"
    with pytest.raises(InputError) as refused:
        write_whole(target, b"x")
    error = refused.value
    assert error.reason == f"the folder '{target.parent}' does not exist"
    assert (error.place, error.remedy) == (str(target), ("create it first",))


def test_a_link_into_a_folder_that_does_not_exist_is_bad_input(tmp_path: Path) -> None:
    link = tmp_path / "e.json"
    link.symlink_to(tmp_path / "none" / "e.json")
    with pytest.raises(InputError, match=r"e\.json: the folder '.*none' does not exist"):
        write_whole(link, b"x")


def test_an_error_names_the_target(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device", ".e.json.x7")

    monkeypatch.setattr(os, "fsync", full)
    target = tmp_path / "e.json"
    target.write_bytes(b"old")
    with pytest.raises(OSError, match="No space left") as refused:
        write_whole(target, b"x")
    assert refused.value.filename == str(target)
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_file_keeps_its_mode_and_a_new_one_has_the_users(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    old.write_bytes(b"1")
    old.chmod(0o604)
    mask = os.umask(0o027)
    try:
        write_whole(old, b"2")
        write_whole(new, b"3")
        assert os.umask(0o027) == 0o027  # as it was
    finally:
        os.umask(mask)
    assert [path.stat().st_mode & 0o7777 for path in (old, new)] == [0o604, 0o640]


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"1")
    link.symlink_to(target)
    write_whole(link, b"2")
    assert link.is_symlink()
    assert target.read_bytes() == b"2"


def test_nothing_is_left_of_a_write_that_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "file"
    path.write_bytes(b"old")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_new_file_has_the_users_mode_and_replaces_nothing(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    mask = os.umask(0o027)
    try:
        write_new(path, b"1")
    finally:
        os.umask(mask)
    assert path.stat().st_mode & 0o7777 == 0o640
    with pytest.raises(FileExistsError) as refused:
        write_new(path, b"2")
    assert refused.value.filename == str(path)
    assert path.read_bytes() == b"1"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(InputError, match="does not exist"):
        write_new(tmp_path / "none" / "joint.toml", b"1")


def test_a_file_system_without_second_names_is_written_as_well(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def none(_from: Path, _to: Path) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(os, "link", none)
    path = tmp_path / "joint.toml"
    write_new(path, b"1")
    with pytest.raises(FileExistsError):
        write_new(path, b"2")
    assert path.read_bytes() == b"1"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_is_on_the_disk_with_those_above_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[Path] = []
    monkeypatch.setattr("jointid.base.files.sync_folder", synced.append)
    make_folder(tmp_path / "a" / "b")
    assert sorted(synced) == [tmp_path, tmp_path / "a"]
    make_folder(tmp_path / "a" / "b")
    assert len(synced) == 2
    (tmp_path / "file").touch()
    with pytest.raises(FileExistsError):
        make_folder(tmp_path / "file")
