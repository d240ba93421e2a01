"""Result of `identify_joints`: each joint's estimate, and the couplings between their residuals."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Self

from jointid.base.result import KeptResult, Overview, require_text
from jointid.joints.record import JointEstimatesRecord

if TYPE_CHECKING:
    import pandas as pd


class JointEstimates(JointEstimatesRecord, KeptResult):
    """Estimates of several joints from one recording, each joint identified alone; a mapping from names to estimates.

    A joint with a failed identification is not in the mapping. `results` contains the joint with the reason.

    Attributes
    ----------
    results : mapping of str to JointResult
        Results by joint, in the recording's order.
    name : str
        Name of the recording.
    seconds : float
        Wall time [s].

    Examples
    --------
    >>> found = jid.identify(jid.load("arm.csv", joints=[1, 2]))
    >>> sorted(found), found["1"].joint.name
    (['1', '2'], 'joint 1')
    """

    __slots__ = ()
    _KIND = "joints"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.joints.overview import overview_of

        return overview_of(self)

    def report(self, verbose: bool = False) -> str:
        """Return the verdict, a line for each joint, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return the complete report: the table, the couplings, and each joint's findings. Default
            False.
        """
        from jointid.joints.answers import answer
        from jointid.joints.tables import text_report

        return text_report(self) if verbose else answer(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the result in JSON's types: each joint's estimate as in `Estimate.to_dict`, and the couplings."""
        from jointid.joints.document import document_of

        return document_of(self)

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the estimates from a JSON text. Their methods that need the recordings raise an error.

        Parameters
        ----------
        text : str
            JSON text from `to_json`.

        Raises
        ------
        InputError
            The text is not JSON or not the estimates of several joints, has another schema, or holds an invalid value.
            The message names the place in the text.
        """
        from jointid.joints.reading_back import read_joints

        return read_joints(require_text(text), cls)

    def to_pandas(self) -> pd.DataFrame:
        """Return the parameters and derived quantities of all joints as a data frame, one row per quantity.

        Returns
        -------
        DataFrame
            Data frame indexed by joint and name, with the columns of `Estimate.to_pandas`. A joint with a failed
            identification has no row.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame
        from jointid.estimate.frame import estimate_rows

        rows = [
            {"joint": name, **row}
            for name, estimate in self.items()
            for row in estimate_rows(estimate)
        ]
        frame = data_frame(rows)
        return frame.set_index(["joint", "name"]) if rows else frame

    def __str__(self) -> str:
        return self.report()
