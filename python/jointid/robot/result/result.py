"""Result of `identify` for a robot."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from jointid.base.argument_checks import require_kind
from jointid.base.errors import InputError
from jointid.base.result import KeptResult, Overview, require_text
from jointid.recording.wide.robot_recording import RobotRecording
from jointid.robot.result.record import RobotEstimateRecord

if TYPE_CHECKING:
    import pandas as pd

    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.verdict import Verdict
    from jointid.robot.result.prediction import RobotPrediction

Array = NDArray[np.float64]


class RobotEstimate(RobotEstimateRecord, KeptResult):
    """Friction and inertia of a whole robot.

    Attributes
    ----------
    joints : mapping of str to RobotJoint
        Results of the joints, by the joints' names in the URDF.
    inertia : str
        "urdf", "scaled" or "free".
    base_parameters : mapping of str to ParameterEstimate
        Combinations of inertial parameters that the motion determines, with ``inertia="free"``.
    inertial : ndarray, shape (n, 10)
        Inertial parameters of all links: m, m·c, I about the joint's frame. With ``inertia="free"``, many sets have
        these base parameters. This set is physically consistent and close to the URDF's, if the errors allow this.
        Do not interpret its single values.
    consistent : bool or None
        Whether the inertial parameters are physically consistent; None: the URDF's parameters are used unchanged.
    impossible_by : float
        Distance from the identified base parameters to the nearest physically consistent parameters, in standard
        errors (Mahalanobis distance), with ``inertia="free"``. Default 0: consistent.
    relative_residual : float
        Norm of all joints' residuals divided by the norm of the measured integrals.
    free : tuple of str
        Names of the free parameters, "joint.name", in the order of `covariance`.
    covariance : ndarray
    condition : float
    findings : tuple of Finding
    robot : Robot
    settings : mapping
    seconds : float
        Wall time [s].
    within : mapping of str to float
        Possible relative error of all joints together for each purpose, as in `Estimate.within`.
    draws : RobotDraws or None
        Input of `bootstrap`; None if the estimate was read from a file.
    cross_check : CrossCheck or None
        Values of an independent least-squares fit to the filtered recorded signals, and whether both fits agree.
        None if the estimate was saved without a cross-check.
    """

    __slots__ = ()
    _KIND = "robot"

    @property
    def overview(self) -> Overview:
        """Summary for a report page."""
        from jointid.robot.result.overview import overview_of

        return overview_of(self)

    @property
    def verdict(self) -> Verdict:
        """Verdict on the use of the values, for each purpose."""
        from jointid.robot.result.verdict import judged_robot

        return judged_robot(self)

    def friction(self, velocity: ArrayLike) -> Array:
        """Return the friction torque of all joints at given speeds, including the friction of coupled motors.

        Parameters
        ----------
        velocity : array_like, shape (n,) or (samples, n)
            Speeds of the joints [rad/s or m/s].

        Returns
        -------
        ndarray
            Friction torques [N·m or N], in the shape of `velocity`.

        Raises
        ------
        InputError
            `velocity` does not have one finite number for each joint.
        """
        from jointid.robot.result.friction import friction_of

        try:
            speeds = np.asarray(velocity, dtype=np.float64)
        except (OverflowError, TypeError, ValueError):
            speeds = np.zeros(0)
        if not np.all(np.isfinite(speeds)):
            raise InputError("finite speeds are expected", argument="velocity", value=velocity)
        if speeds.ndim not in (1, 2) or speeds.shape[-1] != self.robot.n:
            raise InputError(
                f"{self.robot.n} numbers are expected, one per joint",
                argument="velocity",
                value=velocity,
            )
        return friction_of(self, speeds)

    def predict(self, recording: RobotRecording) -> RobotPrediction:
        """Predict the torques of a recording, and compare them with the measured torques, as integrals over windows.

        Parameters
        ----------
        recording : RobotRecording
            Recording of the same robot, usually not used for the estimate.

        Returns
        -------
        RobotPrediction
            Relative residual of each joint, and of all joints together.

        Raises
        ------
        InputError
            The recording lacks a joint, its torque, or the gear ratios.
        """
        from jointid.robot.result.prediction import predict_robot

        require_kind("recording", recording, RobotRecording)
        return predict_robot(self, recording)

    def bootstrap(self, n: int = 1000, seed: int = 0) -> Bootstrap:
        """Resample blocks of the recordings, and refit all joints to each draw (block bootstrap).

        The draws check the standard errors without their formula. A block contains all joints. It lasts an eighth
        of the recordings, at least 0.25 s and at most 1 s; recordings over 10 min have longer blocks. Refitted
        values stay within the bounds, with the same prior on base parameters. The torque balance is linearised at
        the estimate. For B blocks and p parameters of a joint, errors are multiplied by the square root of B / (B -
        p), at most by 1.41. The fit absorbs this part of the blocks' errors.

        Parameters
        ----------
        n : int
            Number of draws, 20 to 1,000,000. Default 1000.
        seed : int
            Seed of the draws. The same seed gives the same result, on any number of threads. Default 0.

        Returns
        -------
        Bootstrap
            Bootstrap with the parameter names of `parameters`.

        Raises
        ------
        InputError
            The estimate was read from a file and has no recordings, or `n` is out of range.

        Examples
        --------
        >>> found.bootstrap().parameters["joint_1.coulomb"].ratio  # doctest: +SKIP
        1.02
        """
        from jointid.robot.result.bootstrap import bootstrapped

        return bootstrapped(self.draws, self.parameters, self.robot.names, n, seed)

    def report(self, verbose: bool = False) -> str:
        """Return the verdict, a line for each joint, and the first finding, as text.

        Parameters
        ----------
        verbose : bool
            Whether to return the complete report: tables and all findings. Default False.
        """
        from jointid.robot.result.answers import answer
        from jointid.robot.result.tables import text_report

        return text_report(self) if verbose else answer(self)

    def summary(self) -> str:
        """Return the table of the joints as text."""
        from jointid.robot.result.tables import text_summary

        return text_summary(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the estimate in JSON's types, with all attributes except `draws`."""
        from jointid.robot.result.document import document_of

        return document_of(self)

    document = to_dict

    def to_json(self) -> str:
        """Return `to_dict` as JSON text; `from_json` reads the text."""
        return json.dumps(self.to_dict(), indent=1, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the estimate from a JSON text. All its methods except `bootstrap` work.

        Raises
        ------
        InputError
            The text is not JSON or not a robot's estimate, has another schema, or holds an invalid field. The message
            names the place in the text.

        Examples
        --------
        >>> jid.RobotEstimate.load("arm.json").friction([0.5, -0.5])  # doctest: +SKIP
        array([ 5.5, -2.75])
        """
        from jointid.base.schema import read_json
        from jointid.robot.result.reading_back import robot_estimate_of

        return robot_estimate_of(read_json(require_text(text)), cls)

    def to_pandas(self) -> pd.DataFrame:
        """Return the parameters of all joints, and the base parameters, as a data frame, one row per parameter.

        Returns
        -------
        DataFrame
            Data frame indexed by the names of `parameters`, with the columns of `Estimate.to_pandas`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        from jointid.base.frames import data_frame
        from jointid.estimate.frame import parameter_rows

        every = self.parameters
        rows = parameter_rows(every.values())
        named = [row | {"name": name} for name, row in zip(every, rows, strict=True)]
        return data_frame(named, index="name")

    def __str__(self) -> str:
        return self.report()

    def __repr__(self) -> str:
        names = ", ".join(self.joints)
        return (
            f"<RobotEstimate {self.robot.name!r}: {names}; inertia {self.inertia}, residual "
            f"{100.0 * self.relative_residual:.2f} %, {len(self.warnings)} warnings>"
        )
