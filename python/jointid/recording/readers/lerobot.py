"""Tables of LeRobot datasets: lists with joint names, and consecutive episodes on one clock."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.errors import InputError
from jointid.recording.runs import shifts_of_runs
from jointid.recording.signals import FloatArray
from jointid.recording.table import RenamedTable, Table
from jointid.recording.wide.finding_joints import joint_headers

INFO = "meta/info.json"
"""A file that every dataset has, by its path from the top folder."""

_STATE = "observation.state"
_SIGNALS = {
    _STATE: "position",
    "observation.velocity": "velocity",
    "observation.effort": "torque",
    "action": "reference",
}
_ELEMENT = rf"({'|'.join(map(re.escape, _SIGNALS))})(?:_(\d+))?"
_BEHIND = r"\.(pos|vel|torque|effort)$"  # suffix of a motor's name in newer datasets
_ABOVE = 4  # parent folders of a file that are searched for the dataset's top
_EPISODE, _FRAME, _TIME = "episode_index", "frame_index", "timestamp"
_UNIT = "lerobot"
_MOST_SHOWN = 100  # episodes in the metadata


def with_episodes(table: Table, path: Path) -> Table:
    """Return the table of a LeRobot dataset with named joints; any other table unchanged.

    Parameters
    ----------
    table : Table
        Table with one column per list element.
    path : Path
        The dataset's folder, or one of its files.

    Raises
    ------
    InputError
        ``meta/info.json`` exists, but cannot be read.
    """
    headers = set(table.headers)
    of_states = any(_is_element(each, _STATE) for each in headers)
    if not of_states or not {_EPISODE, _FRAME, _TIME} <= headers:
        return table
    return LeRobotTable(table, _info(path))


def _is_element(header: str, feature: str) -> bool:
    found = re.fullmatch(_ELEMENT, header)
    return found is not None and found[1] == feature


def _info(path: Path) -> Mapping[str, Any]:
    """Return the dataset's description; empty for a single file."""
    folders = [path] if path.is_dir() else [*path.resolve().parents][:_ABOVE]
    file = next((each / INFO for each in folders if (each / INFO).is_file()), None)
    if file is None:
        return {}
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError, OSError):
        raise InputError("it is no JSON, or is damaged", place=str(file)) from None
    return found if isinstance(found, dict) else {}


def joint_names(info: Mapping[str, Any], feature: str, count: int) -> list[str]:
    """Return the names of a feature's elements; their numbers if the dataset does not name all of them."""
    features = info.get("features")
    own = features.get(feature) if isinstance(features, Mapping) else None
    names = own.get("names") if isinstance(own, Mapping) else None
    if isinstance(names, Mapping):
        lists = [each for each in names.values() if isinstance(each, list)]
        names = lists[0] if len(lists) == 1 else list(names)
    plain = [str(number) for number in range(count)]
    if not isinstance(names, list) or len(names) != count or len(set(map(str, names))) != count:
        return plain
    found = [re.sub(_BEHIND, "", str(each).strip()) for each in names]
    headers = [f"{name}.position [{_UNIT}]" for name in found]
    return found if list(joint_headers(headers)) == found else plain


def _named(headers: Sequence[str], info: Mapping[str, Any]) -> tuple[list[str], list[str]]:
    """Return the headers, with joint names for list elements, and the features that belong to no joint."""
    elements = [re.fullmatch(_ELEMENT, header) for header in headers]
    counts = Counter(each[1] for each in elements if each is not None)
    names = {name: joint_names(info, name, count) for name, count in counts.items()}
    joints = names[_STATE]
    of_none = []
    for feature, own in names.items():
        known = set(joints) & set(own) if joints[0] != "0" != own[0] else set()
        if len(own) == len(joints) and not known:  # without names, in the order of the states
            names[feature] = joints
        elif not known:
            of_none.append(feature)
    found = []
    for index, (header, element) in enumerate(zip(headers, elements, strict=True)):
        if element is None:
            found.append(f"{header} [s]" if header == _TIME else header)
        elif element[1] in of_none:
            found.append(f"unassigned_{index}")
        else:
            signal = _SIGNALS[element[1]]
            joint = names[element[1]][int(element[2] or 0)]
            unit = f" [{_UNIT}]" if signal in ("position", "velocity", "reference") else ""
            found.append(f"{joint}.{signal}{unit}")
    return found, [
        f"{each} is not read: its {counts[each]} elements have no joint names, and {_STATE} has {len(joints)} joints"
        for each in of_none
    ]


class LeRobotTable(RenamedTable):
    """A dataset's rows: states are positions, actions are references, episodes are consecutive runs.

    Parameters
    ----------
    table : Table
    info : mapping
        Content of ``meta/info.json``; empty without the file.
    """

    def __init__(self, table: Table, info: Mapping[str, Any]) -> None:
        own = {header: index for index, header in enumerate(table.headers)}
        headers, of_none = _named(table.headers, info)
        super().__init__(table, headers, own)
        self._own_notes = {"of_no_joint": of_none} if of_none else {}
        self._rate = info.get("fps")
        self._time = table.headers.index(_TIME)

    @cached_property
    def _episodes(self) -> tuple[FloatArray, list[npt.NDArray[np.intp]]]:
        """Return each row's episode, and the rows of each run."""
        (episodes,) = self._table.numbers([self._table.headers.index(_EPISODE)])
        ends = np.flatnonzero(np.diff(episodes)) + 1
        return episodes, np.split(np.arange(len(episodes)), ends)

    @property
    def notes(self) -> dict[str, Any]:
        """Metadata entries on how the file was read."""
        found = super().notes
        episodes, runs = self._episodes
        if len(runs) > 1:
            shown = [f"episode {episodes[run[0]]:g}" for run in runs[:_MOST_SHOWN]]
            more = len(runs) - len(shown)
            found["runs"] = [*shown, f"{more} more"] if more else shown
        return found

    def numbers(self, columns: Sequence[int]) -> list[FloatArray]:
        """Return columns as arrays of shape (n,), or raise `InputError`."""
        values = self._table.numbers(columns)
        return [
            self._clock(each) if column == self._time else each
            for column, each in zip(columns, values, strict=True)
        ]

    def _clock(self, stamps: FloatArray) -> FloatArray:
        """Return the time of all rows: frame numbers over the dataset's rate if the stamps agree with them."""
        if isinstance(self._rate, int | float) and self._rate > 0.0:
            (frames,) = self._table.numbers([self._table.headers.index(_FRAME)])
            even = frames / float(self._rate)
            if np.allclose(even, stamps, rtol=1e-5, atol=0.1 / float(self._rate)):
                stamps = even
        _, runs = self._episodes
        if all(stamps[first[-1]] < stamps[then[0]] for first, then in pairwise(runs)):
            return stamps
        return stamps + shifts_of_runs(stamps, runs)

    def raw(self, column: int) -> npt.NDArray[Any] | None:
        """Return the values of a column as the file has them."""
        return None if column == self._time else super().raw(column)

    def text(self, column: int) -> list[str]:
        """Return the values of a column as text."""
        if column == self._time:
            return list(map(repr, self.numbers([column])[0].tolist()))
        return super().text(column)
