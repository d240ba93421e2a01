"""A designed motion: its course, its limits, and the expected errors of identification."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.result import KeptResult, Overview, require_text
from jointid.excitation.design_fields import DesignFields

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, slots=True, kw_only=True)
class Design(DesignFields, KeptResult):
    """The result of `design`; `load_design` reads it from a file.

    Attributes
    ----------
    status : str
        "complete", or the problem in a few words.
    reason : str
        Description of the problem in a sentence. Default: empty.
    trajectory : Trajectory
        The motion, for `simulate` and for a session.
    joint : Joint
        Nominal joint, with the joint's parameter values or the middles of the prior's ranges.
    controller : Controller
        The controller that drives the joint.
    sensors : Sensors
        The sensors that record the motion.
    limits : MotionLimits
        The limits of the motion.
    peaks : Peaks
        Largest values of the motion over joints drawn from the prior, including noise.
    parameters : mapping of str to ExpectedError
        Expected errors of the parameters for which the motion was designed.
    reference : mapping of str to float
        Relative error of each parameter with the thesis's motion (20 degrees, ending at rest). Nominal joint,
        controller, sensors and duration are the same. Default: not computed.
    criterion : str
        "worst" or "determinant".
    joints : int
        Number of drawn joints with which the search evaluated each motion.
    evaluations : int
        Number of motions that the search tried.
    seed : int
    duration : float
        Duration of the motion [s].
    believed : mapping of str to (float, float)
        Range of each free parameter, from which joints were drawn. Default: not known.
    control_period : float
        The controller's period [s]. Default 1 ms.
    weakest : str
        The parameter with the largest relative error.
    limited_by : str
        Cause that limits the error of `weakest`: a reached limit, the duration, the noise, …

    Examples
    --------
    >>> design = jid.load_design("motion.toml")
    >>> design.trajectory.duration
    4.0
    """

    _KIND = "design"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.excitation.overview import overview_of

        return overview_of(self)

    def report(self, *, verbose: bool = False) -> str:
        """Return the expected errors and the causes that limit them, as text.

        Parameters
        ----------
        verbose : bool
            Whether to add the table of errors, each limit, and the evaluation settings. Default False.
        """
        from jointid.excitation.tables import answer, summary

        return summary(self) if verbose else answer(self)

    def summary(self) -> str:
        """Return the complete report as text, as `report(verbose=True)`."""
        return self.report(verbose=True)

    def plot(self) -> tuple[Axes, Axes, Axes]:
        """Draw position and velocity over time with their limits, and the time spent at each velocity.

        Returns
        -------
        tuple of Axes
            Axes of `jointid.plot.designed_motion`.
        """
        from jointid.plot.design import designed_motion

        return designed_motion(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of a saved design in JSON types. A number that is not finite becomes a text."""
        from jointid.excitation.design_document import document_of

        return document_of(self)

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the design from a JSON text.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON, is not a design, has a newer schema, or has an invalid value. The message shows
            the place in the text.
        """
        from jointid.base.schema import Plain, TableOf, read_json
        from jointid.excitation.design_file import read_design

        document = TableOf(Plain()).read(read_json(require_text(text)), "")
        if "design" not in document and "trajectory" not in document:
            raise InputError("a design is expected: a file that Design.save wrote")
        return read_design(document, cls)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the design to a .toml or .json file; return its path.

        A session, `simulate` and `load_design` read the .toml file. If writing fails, an existing file is unchanged.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        OSError
            The file cannot be written. An existing file is unchanged.
        """
        from jointid.base.files import write_whole
        from jointid.excitation.design_document import design_text

        place = require_path("path", path)
        ending = place.suffix.lower()
        if ending not in (".toml", ".json") and not place.is_dir():
            raise InputError(
                "a design is saved as .toml or .json", argument="path", value=place.name
            )
        text = self.to_json() if ending == ".json" else design_text(self)
        write_whole(place, text.encode())
        return place

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Return the design from a file; see `load_design`.

        Parameters
        ----------
        path : path-like

        Raises
        ------
        InputError
            The file cannot be read, or is not a design. The message shows the file and the key.
        """
        from jointid.base.toml_file import read_toml
        from jointid.excitation.design_file import read_design

        place = require_path("path", path)
        if place.suffix.lower() == ".json":
            return super(Design, cls).load(place)
        document = read_toml(place)
        try:
            return read_design(document, cls, str(place))
        except InputError as error:
            raise (error if error.place.startswith(str(place)) else error.at(str(place))) from None

    def to_pandas(self) -> pd.DataFrame:
        """Return the expected errors as a data frame, one row per parameter.

        Returns
        -------
        DataFrame
            Data frame indexed by name, with the attributes of `ExpectedError`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame

        return data_frame([asdict(each) for each in self.parameters.values()], index="name")

    def __str__(self) -> str:
        return self.summary()


def load_design(path: str | os.PathLike[str]) -> Design:
    """Return the design that `Design.save` wrote.

    Parameters
    ----------
    path : path
        File of a design. A file with a motion but without expected errors, for example written by hand, is not a
        design. A session and `jointid simulate --trajectory` read such a file.

    Raises
    ------
    InputError
        The file cannot be read, or is not a design. The message shows the file and the key.

    Examples
    --------
    >>> design = jid.load_design("motion.toml")
    >>> recording = jid.simulate(design.joint, design.controller, design.trajectory)
    """
    return Design.load(path)
