"""The result of an identification: values, uncertainty, findings."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from jointid.base.argument_checks import require_path
from jointid.base.errors import InputError
from jointid.base.result import KeptResult, Overview, require_text
from jointid.estimate.questions import Questions
from jointid.estimate.statistics import FrictionCurve, ParameterEstimate
from jointid.problem.window_table import Prediction

if TYPE_CHECKING:
    import pandas as pd

    from jointid.estimate.derived import DerivedValue
    from jointid.estimate.verdict import Verdict
    from jointid.recording.recording import Recording


class Estimate(Questions, KeptResult):
    """The result of `identify`: values, their uncertainty, and findings.

    Attributes
    ----------
    parameters : mapping of str to ParameterEstimate
        Parameters by name, in the order of the torque balance.
    status : str
        "converged", or "stopped" if a callback ended the search early.
    message : str
        Description of the end of the search.
    penalty : float
        Sum of squared window residuals. With ``gain="instruments"``, these are residuals of the torque. They
        contain only the part of the sensor's reading that the motion explains.
    correlation : ndarray, shape (p, p)
        Correlation of the free parameters, in the order of `free`, with offsets at the sensor's mean reading.
    condition : float
        Condition number of the scaled regressor matrix.
    weakest : tuple of str
        Parameters with a large share in the combination that the data determine worst.
    covariance : ndarray, shape (p, p)
        Covariance of the free parameters. If the data cannot separate an offset from direction-dependent Coulomb
        friction, the offset's variance is infinite. The other variances then apply to a fixed offset.
    information : ndarray, shape (p, p), or None
        Inverse of the covariance of random errors; zero for a combination that the recordings do not determine.
        None in an estimate saved by an older version.
    residuals : ResidualStatistics
    windows : WindowTable
    convergence : Convergence or None
        Course of the search over its generations; None without a genetic or random search.
    findings : tuple of Finding
        Problems of data and fit, and remarks, most severe first; `docs/findings.md` lists the codes.
    derived : mapping of str to DerivedValue
        Quantities that follow from the parameters, with standard errors: "breakaway" (coulomb + static),
        "stribeck_velocity" (1/√stribeck). Asymmetric friction adds "coulomb_sum". With an offset, it also adds
        "constant_positive" and "constant_negative". The data determine both even if the offset is undetermined.
    warnings : tuple of Finding
        The findings of severity "warning" or "blocking".
    joint : Joint
        Joint with the estimated values, for use or for a joint file.
    settings : mapping
        Settings that repeat the identification: method, residual, terms, options, seed, versions, fingerprints.
    seconds : float
        Wall time [s].
    delays : mapping of str to Delay
        Constant delay of each signal relative to the position, if the data show a delay. `identify` removes
        statistically certain delays.
    within : mapping of str to float
        Relative error (half of the 95 % interval) for each purpose of the verdict. "compensation": error of the
        friction in the recorded motion, relative to this friction, but at least to a fifth of the torque.
        "simulation": error of the torque. "monitoring": random error of the worst parameter. A purpose with an
        unknown error is missing.
    slow_motion : SlowMotion or None
        Disagreement of the slowest windows with the faster windows; None if not examined.
    selection : Selection or None
        Choice of the model, with scores and reason; None if the model was named.
    cross_check : CrossCheck or None
        Values of an independent least-squares fit to the recorded signals, and whether both fits agree. None in an
        estimate saved by an older version.
    follow_up : FollowUp or None
        Object that answers questions with the recordings; None in an estimate that was read from a file.

    Examples
    --------
    >>> estimate = jid.identify(recording, joint, model="stribeck")
    >>> round(estimate["coulomb"].value), estimate["coulomb"].unit
    (25, 'N·m')
    >>> str(estimate.verdict.level)
    'usable'
    """

    __slots__ = ()
    _KIND = "estimate"

    def __repr__(self) -> str:
        values = ", ".join(f"{p.name}={p.value:.6g}" for p in self.parameters.values())
        return f"Estimate({values}; {len(self.warnings)} warnings)"

    __iter__ = None  # loop over `parameters` instead

    def __getitem__(self, name: str) -> ParameterEstimate | DerivedValue:
        """Return a parameter or a derived quantity by name.

        Raises
        ------
        InputError
            The estimate has no such parameter or quantity.

        Examples
        --------
        >>> bool(abs(estimate["coulomb"].value - 25.0) < 0.1)
        True
        """
        known: dict[str, ParameterEstimate | DerivedValue] = {**self.parameters, **self.derived}
        if not isinstance(name, str) or name not in known:
            from jointid.joint.checks import suggestion

            raise InputError(
                f"the estimate has no such parameter; {suggestion(name, known)}",
                argument="estimate[...]",
                value=name,
            )
        return known[name]

    def __contains__(self, name: object) -> bool:
        return name in self.parameters or name in self.derived

    @property
    def derived(self) -> Mapping[str, DerivedValue]:
        """Derived quantities of the model by name, with standard errors, e.g. the breakaway friction."""
        from jointid.estimate.derived import derived_values

        return derived_values(self)

    @property
    def verdict(self) -> Verdict:
        """Verdict on the use of the values; `jointid.estimate.verdict.judged` also considers a self-test."""
        from jointid.estimate.verdict import judged

        return judged(self)

    @property
    def overview(self) -> Overview:
        """Return the summary that a report page shows."""
        from jointid.estimate.overview import overview_of

        return overview_of(self)

    def friction(self, velocity: ArrayLike, *, load: float = 0.0) -> FrictionCurve:
        """Return the friction at these velocities, with a pointwise 95 % band.

        Parameters
        ----------
        velocity : array_like, shape (n,)
            Velocities [rad/s or m/s].
        load : float
            Torque that the drive transmits [N·m or N], for load-dependent friction; its sign does not matter.
            Default 0: friction without load, as in `windows.friction`.

        Returns
        -------
        FrictionCurve

        Raises
        ------
        InputError
            A velocity or a load is not a number.

        Examples
        --------
        >>> estimate.friction([0.1, 0.2]).torque.round(1)
        array([34.4, 29.4])
        """
        from jointid.estimate.friction_map import friction_curve
        from jointid.joint.checks import finite_number

        try:
            velocities = np.atleast_1d(np.asarray(velocity, dtype=np.float64))
        except (OverflowError, TypeError, ValueError):
            raise InputError("numbers are expected", argument="velocity", value=velocity) from None
        return friction_curve(self, velocities, finite_number("", "load", load))

    def predict(self, recording: Recording) -> Prediction:
        """Predict the window integrals of a recording, and compare them with the measured integrals.

        Parameters
        ----------
        recording : Recording
            Recording of the same joint; it may be a new recording.

        Returns
        -------
        Prediction

        Raises
        ------
        InputError
            The recording lacks a signal that the estimate's terms need.
        """
        from jointid.estimate.prediction import predict

        return predict(self, recording)

    def report(self, *, verbose: bool = False) -> str:
        """Return the answer as text: verdict, values with standard errors, remedies.

        Parameters
        ----------
        verbose : bool
            Whether to add systematic errors, intervals, quality of the fit and complete findings. Default False.
        """
        if verbose:
            from jointid.estimate.tables import text_report

            return text_report(self)
        from jointid.estimate.answers import answer

        return answer(self)

    def to_pandas(self) -> pd.DataFrame:
        """Return the parameters and derived quantities as a data frame, one row per quantity.

        Returns
        -------
        DataFrame
            Frame indexed by name, with the attributes of `ParameterEstimate`: value, stderr, systematic, the ends of
            the interval (low, high), bounds (min, max), vary, at_bound, unit, meaning. Derived quantities lack some
            of these attributes.

        Raises
        ------
        InputError
            pandas is not installed.

        Examples
        --------
        >>> estimate.to_pandas().loc["coulomb", "unit"]
        'N·m'
        """
        from jointid.estimate.frame import parameter_frame

        return parameter_frame(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the whole estimate in JSON's types, as in `to_json`."""
        from jointid.estimate.json import estimate_document

        return estimate_document(self)

    def to_json(self) -> str:
        """Return the whole estimate as JSON with a schema version; `Estimate.from_json` reads it."""
        from jointid.base.json_layout import json_text

        return json_text(self.to_dict())

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the estimate from a JSON text.

        Parameters
        ----------
        text : str
            JSON text from `to_json`, of this schema or an older schema.

        Raises
        ------
        InputError
            The text is not JSON, is not an estimate, has a newer schema, or has an invalid value. The error's place
            is the JSON path, e.g. "parameters.coulomb.value".
        """
        from jointid.base.schema import read_json
        from jointid.estimate.json import estimate_of

        return estimate_of(read_json(require_text(text)), cls)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the estimate from a .json file.

        Parameters
        ----------
        path : path-like

        Raises
        ------
        InputError
            The file does not exist, is not JSON, is not an estimate, or has a newer schema; the error names the
            file and the place in the file.
        """
        from jointid.base.schema import read_text

        path = require_path("path", path)
        text = read_text(path)
        if not text.lstrip().startswith(
            ("{", "[")
        ):  # another kind of file: the place of a JSON error would not help
            raise InputError(
                "an estimate is expected: a .json file that identify saved",
                place=str(path),
            )
        try:
            return cls.from_json(text)
        except InputError as error:
            raise error.at(str(path)) from error

    def save(self, path: str | Path) -> Path:
        """Save the estimate to a .json file, or its joint to a joint file (.toml).

        An existing joint file keeps its comments. The file is written completely or not at all. The method returns
        the file's path.

        Parameters
        ----------
        path : path-like
            File name; its ending determines the format.

        Raises
        ------
        InputError
            The file name has another ending, the folder does not exist, or an existing joint file cannot be read.
        OSError
            The file cannot be written.
        """
        from jointid.base.files import write_whole

        path = require_path("path", path)
        if path.suffix == ".toml":
            self.joint.save(path)
        elif path.suffix == ".json":
            write_whole(path, self.to_json().encode())
        else:
            raise InputError(
                "an estimate is saved as .toml (joint file) or .json",
                argument="path",
                value=path.name,
            )
        return path
