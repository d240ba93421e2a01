"""Held-out windows are cut once for all folds of a model."""

from dataclasses import replace

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.estimate.prediction import FittedModel, TorquePredictor
from jointid.problem.problem import Problem


def test_folds_that_pose_the_same_problem_share_its_windows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recording = jid.load(WELL_EXCITED)
    fitted = FittedModel.of(jid.identify(recording, jid.thesis_joint()))
    made = []
    cut = Problem.penalty

    def counted(problem: Problem, windows: object) -> object:
        made.append(windows)
        return cut(problem, windows)  # type: ignore[arg-type]

    monkeypatch.setattr(Problem, "penalty", counted)
    predictor = TorquePredictor()
    first = predictor.predicted(fitted, recording)
    louder = replace(fitted, values={**fitted.values, "viscous": 2.0 * fitted.values["viscous"]})
    second = predictor.predicted(louder, recording)
    assert len(made) == 1
    assert abs(second.residual).sum() > 2.0 * abs(first.residual).sum()
    longer = replace(fitted, settings={**fitted.settings, "windows": 0.1})
    assert len(predictor.predicted(longer, recording).torque) < len(first.torque)
    assert len(made) == 2
