"""Fits of a comparison: each model to all data and to the training part of each fold, with progress."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.comparison.contenders import text_of
from jointid.comparison.held_out import Fold
from jointid.estimate.estimate import Estimate
from jointid.estimate.prediction import FittedModel, TorquePredictor
from jointid.identification.follow_up import EstimateSource
from jointid.identification.identification import identified
from jointid.identification.prepared import prepare
from jointid.identification.search.run import run_search
from jointid.identification.search.search import Search
from jointid.joint.joint import Joint
from jointid.joint.model import Model
from jointid.problem.settings import Settings
from jointid.problem.windows import Windows
from jointid.recording.recording import Recording


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonStep:
    """One fit of a comparison, as passed to the callback.

    Attributes
    ----------
    number, total : int
        Fits done so far, and in all.
    model : str
        Text of the fitted model.
    """

    number: int
    total: int
    model: str


def with_causes(estimate: Estimate) -> Estimate:
    """Return an estimate of `Fitter.fit` with the causes of its residual; this takes as long as the fit.

    Parameters
    ----------
    estimate : Estimate
    """
    source = estimate.follow_up
    if not isinstance(source, EstimateSource) or source.attributed is None:
        return estimate
    return replace(source.attributed(), seconds=estimate.seconds)


class Fitter:
    """Fits models to parts of the data, adds the model to errors, and reports progress to the callback."""

    def __init__(
        self,
        *,
        joint: Joint | None,
        settings: Settings,
        search: Search,
        total: int,
        callback: Callable[[ComparisonStep], object] | None,
    ) -> None:
        self._joint, self._settings, self._search = joint, settings, search
        self._callback = callback
        self.total = total
        self._done = 0

    def shift(self, delays: Mapping[str, float]) -> None:
        """Remove these delays in all further fits [s]."""
        self._settings = replace(self._settings, shift=delays)

    def fit(
        self,
        spec: Model,
        training: Sequence[Recording],
        windows: Windows,
        where: str = "",
        attribute: bool = False,
    ) -> Estimate:
        """Return the estimate of a model.

        Parameters
        ----------
        where : str
            Name of the part of the data, for errors. Default: all data.
        attribute : bool
            Whether the causes of its residual are searched; see `with_causes`. Default False.

        Raises
        ------
        InputError
            The error of `identify`, with the model's name and `where`.
        """
        try:
            settings = replace(self._settings, model=spec, windows=windows)
            estimate = identified(
                training, self._joint, settings, self._search, attribute=attribute
            )
        except InputError as error:
            raise error.at(f"model '{text_of(spec)}'{where}") from error
        self._step(spec)
        return estimate

    def _step(self, spec: Model) -> None:
        self._done += 1
        if self._callback is not None:
            self._callback(ComparisonStep(number=self._done, total=self.total, model=text_of(spec)))

    def _values(
        self,
        spec: Model,
        training: Sequence[Recording],
        windows: Windows,
        where: str,
        whole: Estimate,
    ) -> FittedModel:
        """Return the values without intervals and causes, which a score does not need.

        Properties of the signals found in all data apply to their parts: delays, and that a reading is not taken before
        the torque steps. The amount of the latter is measured in each part.
        """
        search = self._search
        try:
            prepared = prepare(
                tuple(training),
                self._joint,
                replace(self._settings, model=spec, windows=windows),
                threads=search.threads,
                measure=False,
                instant="sensor_before_step" in whole.settings,
            )
            outcome = run_search(search, prepared.penalty, prepared.domain)
        except InputError as error:
            raise error.at(f"model '{text_of(spec)}'{where}") from error
        self._step(spec)
        return prepared.fitted(search, outcome)

    def scores(
        self, spec: Model, splits: Sequence[Fold], windows: Windows, whole: Estimate
    ) -> list[float]:
        """Return the relative residual of each fold's held-out part, fitted to the others.

        Parameters
        ----------
        splits : sequence of Fold
        windows : WindowOptions
            Options of the windows, the same for all models.
        whole : Estimate
            Estimate of the model from all data.

        Raises
        ------
        InputError
            A fold cannot be fitted or judged.
        """
        # If all data show a drift, it is also searched in their parts.
        inferred = not spec.named or any(key.endswith("_removed") for key in whole.settings)
        found = []
        predictor = TorquePredictor()  # for the blocks of one recording, with the same windows
        for number, split in enumerate(splits, start=1):
            where = f", fold {number} of {len(splits)}"
            fitted = (
                FittedModel.of(self.fit(spec, split.training, windows, where))
                if inferred
                else self._values(spec, split.training, windows, where, whole)
            )
            try:
                found.append(split.residual(fitted, predictor))
            except InputError as error:
                raise error.at(f"model '{text_of(spec)}'{where}") from error
        return found
