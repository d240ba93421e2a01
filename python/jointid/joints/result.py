"""The result of `identify_joints`: each joint's estimate, and what each residual owes to the others."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from jointid.joints.record import JointEstimatesRecord


class JointEstimates(JointEstimatesRecord):
    """Several joints identified from one recording, each for itself; a mapping from names to estimates.

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
    >>> found = jid.identify_joints(jid.load_robot("arm.csv", [1, 2]))
    >>> sorted(found), found["1"].joint.name
    (['1', '2'], 'joint 1')
    """

    __slots__ = ()

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

    def document(self) -> dict[str, Any]:
        """Return the result in JSON types."""
        from jointid.joints.document import document_of

        return document_of(self)

    def to_json(self) -> str:
        """Return the result as JSON: each joint's estimate as `Estimate.to_json` has it, and the couplings."""
        from jointid.joints.document import json_of

        return json_of(self)

    def save(self, path: str | Path) -> Path:
        """Write the result as JSON, whole or not at all.

        Raises
        ------
        InputError
            The path does not end in ``.json``, or its folder does not exist.
        OSError
            The file cannot be written; an existing one is untouched.
        """
        from jointid.joints.document import save_json

        return save_json(self, path)

    def __str__(self) -> str:
        return self.report()

    def _repr_html_(self) -> str:
        from jointid.joints.html_tables import html_summary

        return str(html_summary(self))
