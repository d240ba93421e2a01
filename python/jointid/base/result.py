"""Common interface of all results: identified, compared, designed or simulated."""

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
    """One value of any result, for a table.

    Attributes
    ----------
    name, unit, meaning : str
    value : float or None
        None if there is no value, e.g. beyond a bound.
    error : float or None
        Standard error; None if there is none.
    systematic : str
        Error that more data does not reduce, with its main source, e.g. "1.3 (given)". Default: none.
    remark : str
        Note on this value, e.g. "given". Default: none.
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
        Subject and task, e.g. "KR300 joint 1: friction".
    footer : str
        Origin of the result: version, seed, recordings. Default: empty.
    verdict : Verdict or None
        Whether the values may be used, and for which purpose; None without a judgement.
    answer : tuple of str
        The answer in sentences, if there is no verdict; otherwise sentences that follow the verdict.
    level : str
        Level of the verdict: "usable", "usable with care", "not usable", or "" without a verdict.
    parameters : tuple of Quantity
        Rows of the main table: values and derived quantities; models of a comparison; runs of a rollout; cells of
        a study.
    fit : tuple of (str, str)
        Quality of the fit: label and text.
    facts : tuple of (str, str)
        Facts about the data: label and text.
    findings : tuple of Finding
    settings : tuple of (str, str)
        Settings that repeat the result: label and text.
    inner : mapping of str to Result
        Results that are parts of this one, by name.
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
        """Return the result from a JSON text. `Result.from_json` reads any result; a subclass reads only its own kind.

        Parameters
        ----------
        text : str
            JSON text from `to_json`, of this version or an older version.

        Raises
        ------
        InputError
            The text is not JSON, is not a result of this kind, has a newer schema, or has an invalid value; the error
            names the place.
        """
        return cls._class_of(require_text(text)).from_json(text)

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Return the result from a file. `Result.load` reads any result; a subclass reads only its own kind.

        Parameters
        ----------
        path : path-like
            File of a result: .json, a design's .toml, or the output file of a sweep.

        Raises
        ------
        InputError
            The file does not exist, or is invalid as in `from_json`; the error names the file and the place in the
            file.

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
        """Return the class of the result in a file or a JSON text."""
        if cls is not Result:
            raise InputError(f"a result of the kind '{cls._KIND}' cannot be read from a file")
        return cast("type[KeptResult]", joined("class_of_kind")(source))


class KeptResult(Result):
    """A result that can be saved as a file or JSON, or shown as a table."""

    __slots__ = ()

    def to_json(self) -> str:
        """Return the whole result as JSON; `from_json` reads it."""
        raise NotImplementedError

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the result from a JSON text.

        Parameters
        ----------
        text : str
            JSON text from `to_json`, of this version or an older version.

        Raises
        ------
        InputError
            The text is not JSON, is another kind of result, has a newer schema, or has an invalid value; the error
            names the place.
        """
        raise NotImplementedError

    def save(self, path: str | Path) -> Path:
        """Write the result to a file, completely or not at all, and return the file's path.

        Parameters
        ----------
        path : path-like
            File name; its ending determines the format. A .json file contains the whole result.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        OSError
            The file cannot be written; an existing file is unchanged.
        """
        from jointid.base.files import write_whole

        file = require_path("path", path)
        if file.suffix != ".json":
            raise InputError("this result is saved as .json", argument="path", value=file.name)
        write_whole(file, self.to_json().encode())
        return file

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the result from a .json file.

        Parameters
        ----------
        path : path-like

        Raises
        ------
        InputError
            The file does not exist, or is invalid as in `from_json`; the error names the file and the place in the
            file.
        """
        from jointid.base.schema import read_text

        file = require_path("path", path)
        try:
            return cls.from_json(read_text(file))
        except InputError as error:
            raise error.at(str(file)) from error

    def to_pandas(self) -> pd.DataFrame:
        """Return the result as a data frame, one row per value.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        raise NotImplementedError


def require_text(text: object) -> str:
    """Return the argument of `from_json` if it is a text.

    Raises
    ------
    InputError
        The argument is not a text.
    """
    require_kind("text", text, str)
    return cast("str", text)


def kind_of(result: Result) -> str:
    """Return the name of a result's kind, e.g. "estimate"; empty if it is not a result."""
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
"""Kinds of result; they name sections of report pages and saved files."""
