"""What every result has in common: a face, whatever was identified, compared, designed or simulated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self, cast

from jointid.base.argument_checks import require_kind, require_path
from jointid.base.errors import InputError
from jointid.base.joining import joined
from jointid.base.values import dataclass

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """One value of a result, for a table that does not know what was identified.

    Attributes
    ----------
    name, unit, meaning : str
    value : float or None
        None where there is none, e.g. beyond a bound.
    error : float or None
        Standard error; None where there is none.
    systematic : str
        Error that more data does not reduce, with its main source, e.g. "1.3 (given)". Default: none.
    remark : str
        What a reader must know of this value, e.g. "given". Default: nothing.
    """

    name: str
    value: float | None
    error: float | None = None
    systematic: str = ""
    unit: str = ""
    meaning: str = ""
    remark: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Overview:
    """Summary of any result for a report page.

    Attributes
    ----------
    title : str
        Subject and what was done with it, e.g. "KR300 joint 1: friction".
    footer : str
        What made it: version, seed, recordings. Default: nothing.
    verdict : Verdict or None
        Whether the values may be used, and for what; None where nothing is judged.
    answer : tuple of str
        The answer in sentences, where there is no verdict; what follows a verdict, where there is one.
    level : str
        Level of the verdict: "usable", "usable with care", "not usable", or "" without a verdict.
    parameters : tuple of Quantity
        Rows of the main table: values and what follows from them; of a comparison its models, of a rollout its runs,
        of a study its cells.
    fit : tuple of (str, str)
        How well the result explains the data: label and text.
    facts : tuple of (str, str)
        What it was made from: label and text.
    findings : tuple of Finding
    settings : tuple of (str, str)
        With which it can be repeated: label and text.
    inner : mapping of str to Result
        Results that it consists of, by name.
    """

    title: str
    footer: str = ""
    verdict: Any = None
    answer: tuple[str, ...] = ()
    level: str = ""
    parameters: tuple[Quantity, ...] = ()
    fit: tuple[tuple[str, str], ...] = ()
    facts: tuple[tuple[str, str], ...] = ()
    findings: tuple[Any, ...] = ()
    settings: tuple[tuple[str, str], ...] = ()
    inner: Mapping[str, Result] = field(default_factory=dict)


class Result:
    """Base of all results: text report, notebook display, JSON and data frame."""

    __slots__ = ()
    _KIND: ClassVar[str] = ""

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        raise NotImplementedError

    def report(self, *, verbose: bool = False) -> str:
        """Return the result as text.

        Parameters
        ----------
        verbose : bool
            Whether to return the complete report. Default False: only the answer.
        """
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Return the result in JSON's types."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return str(joined("notebook_view")(self))

    @classmethod
    def from_json(cls, text: str) -> Result:
        """Return the result that a JSON text holds; `Result.from_json` reads any kind, a kind reads its own.

        Parameters
        ----------
        text : str
            From `to_json`, of this version or an older one.

        Raises
        ------
        InputError
            Not JSON, no result or another kind, a newer schema, or a value that cannot be used; names its place.
        """
        return cls._class_of(require_text(text)).from_json(text)

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Return the result that a file holds; `Result.load` reads any kind, a kind reads its own.

        Parameters
        ----------
        path : path-like
            As `save` wrote it: .json, a design's .toml, the file of a sweep.

        Raises
        ------
        InputError
            No such file, or as `from_json`; names the file and the place in it.

        Examples
        --------
        >>> path = jid.identify(recording, joint).save("estimate.json")
        >>> jid.Result.load(path)["coulomb"].unit
        'N·m'
        """
        file = require_path("path", path)
        return cls._class_of(file).load(file)

    @classmethod
    def _class_of(cls, source: Path | str) -> type[KeptResult]:
        """The kind of result that a file or a JSON text holds."""
        if cls is not Result:
            raise InputError(f"a result of the kind '{cls._KIND}' is not read from a file")
        return cast("type[KeptResult]", joined("class_of_kind")(source))


class KeptResult(Result):
    """A result that is kept: as a file, as JSON, as a table."""

    __slots__ = ()

    def to_json(self) -> str:
        """Return the whole result as JSON; `from_json` reads it."""
        raise NotImplementedError

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the result that a JSON text holds.

        Parameters
        ----------
        text : str
            From `to_json`, of this version or an older one.

        Raises
        ------
        InputError
            Not JSON, another kind of result, a newer schema, or a value that cannot be used; names its place.
        """
        raise NotImplementedError

    def save(self, path: str | Path) -> Path:
        """Write the result to a file, whole or not at all, and return its path.

        Parameters
        ----------
        path : path-like
            The ending chooses the format: .json holds everything.

        Raises
        ------
        InputError
            Another ending, or a folder that does not exist.
        OSError
            The file cannot be written; an existing one is untouched.
        """
        from jointid.base.files import write_whole

        file = require_path("path", path)
        if file.suffix != ".json":
            raise InputError("it is saved as .json", argument="path", value=file.name)
        write_whole(file, self.to_json().encode())
        return file

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the result that a .json file holds.

        Parameters
        ----------
        path : path-like

        Raises
        ------
        InputError
            No such file, or as `from_json`; names the file and the place in it.
        """
        from jointid.base.schema import read_text

        file = require_path("path", path)
        try:
            return cls.from_json(read_text(file))
        except InputError as error:
            raise error.at(str(file)) from error

    def to_pandas(self) -> pd.DataFrame:
        """Return the result as a data frame, one row each.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        raise NotImplementedError


def require_text(text: object) -> str:
    """Return a text that `from_json` reads.

    Raises
    ------
    InputError
        It is none.
    """
    require_kind("text", text, str)
    return cast("str", text)


def kind_of(result: Result) -> str:
    """Return the name of a result's kind, e.g. "estimate"; empty for what is no result."""
    return getattr(result, "_KIND", "")


KINDS = (
    "estimate",
    "joints",
    "robot",
    "servo",
    "comparison",
    "robot comparison",
    "servo comparison",
    "design",
    "study",
    "rollout",
    "bootstrap",
    "self-test",
    "causes",
    "commissioning",
    "online",
)
"""The kinds of result; the sections of a page and the files that are read back are named by them."""
