"""Result of `identify` for a servo."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.result import KeptResult, Overview, require_text
from jointid.joint.joint import Joint
from jointid.servo.record import ServoEstimateRecord

if TYPE_CHECKING:
    import pandas as pd

    from jointid.estimate.verdict import Verdict


class ServoEstimate(ServoEstimateRecord, KeptResult):
    """Motor, friction and inertia of a servo.

    Attributes
    ----------
    joint : Joint
        The joint that was passed to `identify`.
    parameters : mapping of str to ParameterEstimate
        Parameters by name: "torque_per_voltage" (k_t/R), "back_emf" (k_t²/R), the coefficients of the friction
        model ("viscous", "coulomb"), "load_friction" (dry friction per torque through the gear: load plus motor),
        "inertia" (of the drive, at the output), and the derived "torque_constant" (k_t at the output) and
        "resistance".
    findings : tuple of Finding
    model : str
        Name of the friction model.
    values : ndarray, shape (n,)
        Values of the parameters up to "inertia". Load friction is 0 if the model does not include it.
    draws : ndarray, shape (draws, n)
        The same parameters from fits to resampled runs.
    load_friction : bool
        Whether the model includes load friction.
    separable : bool
        Whether the data separate back-EMF from viscous friction. Then some windows contain a driven motor and others
        a motor that turns freely.
    lead : float
        Time by which a row's position is older than the row's duty [s].
    lead_found : bool
        Whether the lead was estimated.
    command_lag : float or None
        Mean delay from a row to its command [s]: half a sample period if the command is held until the next row, 0
        if the command moves linearly. None if the position loop is not known.
    windows : int
        Number of windows used.
    window, slowest : float
        Duration of a window [s], and lowest speed of the used motion [rad/s].
    runs : tuple of str
        Names of the runs.
    moving : tuple of float
        Used share of each run.
    rms : float
        Root mean square of the windows' mean residuals [N·m].
    relative_residual : float
        `rms` relative to the load's torque.
    seconds : float
        Wall time [s].
    """

    __slots__ = ()
    _KIND = "servo"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.servo.overview import overview_of

        return overview_of(self)

    @property
    def verdict(self) -> Verdict:
        """Verdict on the use of the values, for compensation, simulation and monitoring."""
        from jointid.servo.verdict import judged_servo

        return judged_servo(self)

    @property
    def identified(self) -> Joint:
        """Return the joint with the identified motor, inertia and friction."""
        from jointid.servo.joint_from_estimate import identified_joint

        return identified_joint(self)

    def report(self, verbose: bool = False) -> str:
        """Return the verdict, the values with their errors, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return the complete report: intervals, meanings, the fit, and all findings. Default False.
        """
        from jointid.servo.answers import answer
        from jointid.servo.tables import text_report

        return text_report(self) if verbose else answer(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the estimate in JSON's types, with all attributes except `draws`."""
        from jointid.servo.document import document_of

        return document_of(self)

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    def save(self, path: str | Path) -> Path:
        """Write the estimate as JSON, or the identified joint as a joint file (.toml); return the file's path.

        Raises
        ------
        InputError
            The file name has another ending, or the folder does not exist.
        OSError
            The file cannot be written; an existing file is unchanged.

        Examples
        --------
        >>> path = jid.identify(servo_runs, servo).save("servo.json")
        >>> jid.ServoEstimate.load(path)["inertia"] > 0.0
        True
        """
        from jointid.base.files import write_whole

        target = require_path("path", path)
        if target.suffix == ".toml":
            self.identified.save(target)
        elif target.suffix == ".json":
            write_whole(target, self.to_json().encode())
        else:
            raise InputError(
                "a servo's estimate is saved as .json or .toml", argument="path", value=target.name
            )
        return target

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the estimate from a JSON text, with all attributes except `draws`.

        Raises
        ------
        InputError
            The text is not JSON or not a servo's estimate, has another schema, or holds an invalid field. The message
            names the place in the text.
        """
        from jointid.base.schema import read_json
        from jointid.servo.reading_back import servo_estimate_of

        return servo_estimate_of(read_json(require_text(text)), cls)

    def to_pandas(self) -> pd.DataFrame:
        """Return the parameters as a data frame, one row per parameter.

        Returns
        -------
        DataFrame
            Data frame indexed by name, with the columns of `Estimate.to_pandas`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame
        from jointid.estimate.frame import parameter_rows

        return data_frame(parameter_rows(self.parameters.values()), index="name")

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={p.value:.4g}" for name, p in self.parameters.items())
        return f"<ServoEstimate of {len(self.runs)} runs: {shown}>"
