"""The result of `identify_servo`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.notebook import Shown
from jointid.base.schema import read_text
from jointid.joint.joint import Joint
from jointid.servo.record import ServoEstimateRecord

if TYPE_CHECKING:
    from jointid.estimate.verdict import Verdict


class ServoEstimate(ServoEstimateRecord, Shown):
    """A servo as identified.

    Attributes
    ----------
    joint : Joint
        As given.
    parameters : mapping of str to ParameterEstimate
        "torque_per_voltage" (k_t/R), "back_emf" (k_t²/R), the coefficients of the friction model ("viscous",
        "coulomb"), "load_friction" (dry friction per torque through the gear: load plus motor), "inertia" (of the
        drive, at the output), and what follows: "torque_constant" (k_t at the output) and "resistance".
    findings : tuple of Finding
    model : str
        Name of the friction model.
    values : ndarray, shape (n,)
        The parameters up to the inertia; 0 for friction of the load that the model does not have.
    draws : ndarray, shape (draws, n)
        The same of runs drawn anew.
    load_friction : bool
        Whether the model has friction of the load.
    separable : bool
        Whether windows with and without drive divide back-EMF from viscous friction.
    lead : float
        Time by which a row's position is older than its duty [s].
    lead_found : bool
        Whether the lead was estimated.
    command_lag : float or None
        How much later than its row the command acts on average [s]: half a row if it is held from row to row, 0 if it
        moves evenly. None where the position loop is not known.
    windows : int
        Windows used.
    window, slowest : float
        Duration [s], slowest motion [rad/s].
    runs : tuple of str
        Names.
    moving : tuple of float
        Share of each run that is used.
    rms : float
        Root mean square of what the model leaves, as a mean over a window [N·m].
    relative_residual : float
        The same as a share of the load's torque.
    seconds : float
        Wall time.
    """

    __slots__ = ()

    @property
    def verdict(self) -> Verdict:
        """Whether the values may be used, for compensation, for simulation and for monitoring."""
        from jointid.servo.verdict import judged_servo

        return judged_servo(self)

    @property
    def identified(self) -> Joint:
        """The joint with what was identified: motor, inertia and friction."""
        from jointid.servo.joint_from_estimate import identified_joint

        return identified_joint(self)

    def report(self, verbose: bool = False) -> str:
        """Return the verdict, the values with their errors, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return everything: intervals, meanings, the fit, and all findings. Default False.
        """
        from jointid.servo.answers import answer
        from jointid.servo.tables import text_report

        return text_report(self) if verbose else answer(self)

    def document(self) -> dict[str, Any]:
        """Return the estimate in JSON types."""
        from jointid.servo.document import document_of

        return document_of(self)

    def to_json(self) -> str:
        """Return the estimate as JSON."""
        from jointid.servo.document import json_of

        return json_of(self)

    def save(self, path: str | Path) -> Path:
        """Write the estimate as JSON, or the joint as identified into a joint file (.toml).

        Raises
        ------
        InputError
            Another ending, or a folder that does not exist.
        OSError
            The file cannot be written; an existing one is untouched.
        """
        from jointid.servo.document import save

        return save(self, path)

    @classmethod
    def from_json(cls, text: str) -> ServoEstimate:
        """Return the estimate that a JSON text holds.

        Raises
        ------
        InputError
            Not JSON, not a servo's estimate, another schema, or a field that cannot be used; names the place in it.
        """
        from jointid.servo.reading_back import read_servo_estimate

        return read_servo_estimate(text, cls)

    @classmethod
    def load(cls, path: str | Path) -> ServoEstimate:
        """Return the estimate that a .json file holds; all but `draws` is in it.

        Parameters
        ----------
        path : path-like

        Raises
        ------
        InputError
            No such file, or as `from_json`; names the file and the place in it.

        Examples
        --------
        >>> path = jid.identify_servo(servo_runs, servo).save("servo.json")
        >>> jid.ServoEstimate.load(path)["inertia"] > 0.0
        True
        """
        file = require_path("path", path)
        text = read_text(file)
        try:
            return cls.from_json(text)
        except InputError as error:
            raise error.at(str(file)) from error

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={p.value:.4g}" for name, p in self.parameters.items())
        return f"<ServoEstimate of {len(self.runs)} runs: {shown}>"
