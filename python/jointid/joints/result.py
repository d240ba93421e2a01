"""The result of `identify_joints`: each joint's estimate, and what each residual owes to the others."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Self

from jointid.base.result import KeptResult, Overview, require_text
from jointid.joints.record import JointEstimatesRecord

if TYPE_CHECKING:
    import pandas as pd


class JointEstimates(JointEstimatesRecord, KeptResult):
    """Several joints identified from one recording, each alone; a mapping from names to estimates.

    A joint that failed is not in the mapping; `results` has it with its reason.

    Attributes
    ----------
    results : mapping of str to JointResult
        By joint, in the recording's order.
    name : str
        The recording's.
    seconds : float
        Wall time.

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
        """Return the summary that a report page shows."""
        from jointid.joints.overview import overview_of

        return overview_of(self)

    def report(self, verbose: bool = False) -> str:
        """Return the verdict, a line for each joint, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return everything: the table, the couplings, and each joint's findings. Default False.
        """
        from jointid.joints.answers import answer
        from jointid.joints.tables import text_report

        return text_report(self) if verbose else answer(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the result in JSON's types: each joint's estimate as `Estimate.to_dict` has it, and the couplings."""
        from jointid.joints.document import document_of

        return document_of(self)

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads it."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the estimates that a JSON text holds; what needs the recordings is refused by each of them.

        Parameters
        ----------
        text : str
            From `to_json`.

        Raises
        ------
        InputError
            Not JSON, not the estimates of several joints, another schema, or a value that cannot be used; names the
            place in it.
        """
        from jointid.joints.reading_back import read_joints

        return read_joints(require_text(text), cls)

    def to_pandas(self) -> pd.DataFrame:
        """Return the parameters and derived quantities of all joints as a data frame, one row each.

        Returns
        -------
        DataFrame
            Indexed by joint and name, with the columns of `Estimate.to_pandas`. A joint that failed has no row.

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
