"""`compare_models` prefers the model that predicts held-out motion, and the simpler one when it makes no difference."""

import html
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid.base.errors import InputError
from jointid.cli.progress import ComparisonProgress
from jointid.comparison.comparison import judge
from jointid.comparison.fitter import ComparisonStep
from jointid.comparison.held_out import folds_by_block, folds_by_recording
from jointid.comparison.row import ComparedModel
from jointid.estimate.causes import Causes
from jointid.identification import identification
from jointid.identification.causes import causes
from jointid.identification.search.run import run_search
from jointid.problem.problem import Problem
from jointid.report.saving import report_page


def simulated(seed: int, *, seconds: float = 10.0, static: float = 0.0) -> jid.Recording:
    """Inertia 2, Coulomb 3, viscous 1.5 and a Stribeck excess of `static`; noise 0.2 N·m."""
    time = np.arange(0.0, seconds, 0.002)
    position = np.sin(1.7 * time) + 0.4 * np.sin(4.1 * time + seed)
    velocity = 1.7 * np.cos(1.7 * time) + 1.64 * np.cos(4.1 * time + seed)
    acceleration = -2.89 * np.sin(1.7 * time) - 6.724 * np.sin(4.1 * time + seed)
    dry = 3.0 + static * np.exp(-10.0 * velocity**2)
    torque = 2.0 * acceleration + dry * np.sign(velocity) + 1.5 * velocity
    noise = np.random.default_rng(seed).normal(0.0, 0.2, len(time))
    return jid.Recording(time=time, position=position, velocity=velocity, torque=torque + noise)


@pytest.fixture(scope="module")
def well_excited() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@pytest.fixture(scope="module")
def comparison(well_excited: jid.Recording) -> jid.Comparison:
    return jid.compare_models(
        well_excited, jid.thesis_joint(), models=("coulomb_viscous", "stribeck")
    )


def row(comparison: jid.Comparison, model: str) -> ComparedModel:
    return next(row for row in comparison.rows if row.model == model)


# --- Which model wins ---


def test_the_true_model_wins_where_it_matters(comparison: jid.Comparison) -> None:
    assert comparison.winner == "stribeck"
    assert comparison.estimate.settings["model"] == "stribeck"
    assert comparison.estimate.parameters["static"].value == pytest.approx(20.0, rel=0.01)
    plain, rich = comparison.rows
    assert (plain.parameters, rich.parameters) == (4, 6)
    assert plain.score > 5 * rich.score
    assert plain.penalty > rich.penalty
    assert "chosen" in rich.reason
    assert "more than one standard error" in plain.reason
    assert "stribeck (6 parameters)" in comparison.reason


@pytest.mark.parametrize("seed", range(5))
def test_a_term_that_is_not_there_does_not_win(seed: int) -> None:
    without = jid.compare_models(simulated(seed), models=("stribeck", "coulomb_viscous"))
    assert without.winner == "coulomb_viscous"
    assert without.estimate.settings["model"] == "coulomb_viscous"
    with_it = jid.compare_models(
        simulated(seed, static=2.0), models=("stribeck", "coulomb_viscous")
    )
    assert with_it.winner == "stribeck"


def test_the_score_is_the_noise_where_the_model_is_true() -> None:
    recording = simulated(1)
    found = jid.compare_models(recording, models="coulomb_viscous", windows=0.02)
    assert recording.torque is not None
    # Over 10 intervals the trapezoid rule weighs eleven samples, the outer ones by a half.
    noise = 0.2 * np.sqrt(9.5 / 100.0)
    assert found.rows[0].score == pytest.approx(
        noise / np.sqrt(np.mean(recording.torque**2)), rel=0.1
    )


def test_emps_refuses_the_stribeck_term(emps: Path) -> None:
    recording = jid.load(emps / "emps_train.csv.gz")
    found = jid.compare_models(recording, models=("coulomb_viscous", "stribeck"))
    assert found.winner == "coulomb_viscous"
    assert not row(found, "stribeck").eligible
    assert "static ended at its lower bound" in row(found, "stribeck").reason
    assert "the data do not support stribeck" in found.reason
    assert row(found, "coulomb_viscous").score == pytest.approx(0.0418, rel=0.05)


def test_emps_prefers_the_asymmetric_model(emps: Path) -> None:
    found = jid.compare_models(jid.load(emps / "emps_train.csv.gz"))
    assert found.winner == "coulomb_viscous:asymmetric"
    symmetric, asymmetric = row(found, "coulomb_viscous"), row(found, found.winner)
    assert symmetric.eligible
    assert asymmetric.score + asymmetric.stderr < symmetric.score
    # An independent window least squares with the sign of the mean velocity: 3.20 % against 4.18 %.
    assert asymmetric.score == pytest.approx(0.032, rel=0.05)
    for model in ("stribeck", "stribeck:asymmetric"):
        assert not row(found, model).eligible, model


def test_ripple_is_preferred_where_there_is_one(shared_data: object) -> None:
    recording = jid.load(f"{shared_data}/simulated/rippled.csv.gz")
    models = ("stribeck", {"name": "stribeck", "ripple": (2,)}, "stribeck:ripple=2,4")
    found = jid.compare_models(recording, jid.thesis_joint(), models=models, folds=4)
    assert found.winner == "stribeck:ripple=2"
    assert row(found, "stribeck").score > 5 * row(found, found.winner).score


def test_a_model_on_its_bound_cannot_win() -> None:
    found = jid.compare_models(
        simulated(2, static=2.0),
        models=("coulomb_viscous", "stribeck"),
        parameters={"viscous": {"max": 1.0}},
    )
    assert not any(entry.eligible for entry in found.rows)
    assert "viscous at its upper bound" in row(found, "coulomb_viscous").reason
    assert "support none of the models" in found.reason
    assert found.winner == "stribeck"  # still reported: what predicts best


# --- The rule, on made-up scores ---


def made_up(
    model: str, parameters: int, score: float, stderr: float, wording: str = ""
) -> ComparedModel:
    return ComparedModel(
        model=model,
        spec=jid.Model(),
        parameters=parameters,
        score=score,
        stderr=stderr,
        fold_scores=(score,),
        penalty=1.0,
        eligible=not wording,
        reason=wording,
    )


def test_the_simplest_within_one_standard_error_wins() -> None:
    entries = [
        made_up("rich", 7, 0.100, 0.010),
        made_up("middle", 5, 0.109, 0.001),
        made_up("poor", 4, 0.125, 0.050),
        made_up("also_middle", 5, 0.108, 0.001),
    ]
    judged, winner, reason = judge(entries)
    assert judged[winner].model == "also_middle"
    assert (
        "simplest model within one standard error of the best model, rich (residual 10.0 ± 1.0 %)"
        in reason
    )
    assert [entry.reason.split(",")[0] for entry in judged] == [
        "not significantly better than the chosen model",
        "not significantly better than the chosen model",
        "worse than the best model by more than one standard error",
        "chosen",
    ]


def test_an_ineligible_model_neither_wins_nor_sets_the_mark() -> None:
    entries = [
        made_up("refused", 3, 0.010, 0.001, "not eligible: because"),
        made_up("good", 6, 0.100, 0.001),
        made_up("simple", 4, 0.200, 0.001),
    ]
    judged, winner, reason = judge(entries)
    assert judged[winner].model == "good"
    assert "no simpler model is within" in reason
    assert "do not support refused" in reason
    assert judged[0].reason == "not eligible: because"


# --- Folds ---


def test_blocks_cover_every_window_once_and_training_never_sees_them(
    well_excited: jid.Recording,
) -> None:
    windows = jid.identify(well_excited, jid.thesis_joint(), search="separable").windows
    folds = folds_by_block(well_excited, windows, 7)
    seen = np.zeros(len(windows.start), dtype=int)
    sizes = []
    for fold in folds:
        (block,), (training,) = fold.held_out, fold.training
        inside = (windows.start >= block.start) & (windows.stop <= block.stop)
        seen += inside
        sizes.append(int(inside.sum()))
        assert not np.any((training.time >= block.start) & (training.time < block.stop))
        kept = np.isin(well_excited.time, training.time)
        assert np.array_equal(well_excited.velocity[kept], training.velocity)
    assert set(seen) == {1}
    assert max(sizes) - min(sizes) <= 1
    assert [len(fold.training[0].gaps) for fold in folds] == [0, 1, 1, 1, 1, 1, 0]


def test_whole_recordings_are_held_out() -> None:
    runs = [simulated(seed, seconds=3.0) for seed in range(5)]
    folds = folds_by_recording(runs, 5)
    assert [fold.held_out[0].recording for fold in folds] == runs
    for index, fold in enumerate(folds):
        assert list(fold.training) == [run for other, run in enumerate(runs) if other != index]
    grouped = folds_by_recording(runs, 2)
    assert [len(fold.held_out) for fold in grouped] == [3, 2]
    assert [len(fold.training) for fold in grouped] == [2, 3]


def test_several_recordings_are_compared_by_recording() -> None:
    runs = [simulated(seed, seconds=4.0, static=2.0) for seed in range(3)]
    found = jid.compare_models(runs, models=("coulomb_viscous", "stribeck"))
    assert found.winner == "stribeck"
    assert found.settings["folds"] == 3
    assert found.settings["held_out"] == "recording"
    assert "3 folds, one recording held out in each" in found.report(verbose=True)
    assert len(found.estimate.settings["recordings"]) == 3


def test_all_models_are_scored_on_the_same_windows(well_excited: jid.Recording) -> None:
    found = jid.compare_models(
        well_excited, jid.thesis_joint(), models=("coulomb_viscous", "stribeck"), windows=0.05
    )
    assert found.settings["windows"] == pytest.approx(0.05)
    assert found.estimate.settings["windows"] == pytest.approx(0.05)


def test_cumulative_windows_are_scored_on_disjoint_ones() -> None:
    recording = simulated(0, static=2.0)
    found = jid.compare_models(
        recording, models=("coulomb_viscous", "stribeck"), windows="cumulative", folds=3
    )
    assert found.winner == "stribeck"
    assert found.settings["windows"] == pytest.approx(recording.sample_period)


def test_asymmetric_friction_beside_a_sensors_offset_is_compared(
    well_excited: jid.Recording,
) -> None:
    found = jid.compare_models(well_excited, jid.thesis_joint())
    assert found.settings["left_out"] == {}
    assert found.winner == "stribeck"
    # The offset and the difference of the Coulomb frictions are one parameter.
    assert [row.parameters for row in found.rows] == [4, 6, 5, 8]


def test_a_rows_model_repeats_its_fit_with_an_asymmetric_joint() -> None:
    joint = jid.Joint(model=jid.Model("stribeck", asymmetric=True))
    recording = simulated(3)
    found = jid.compare_models(recording, joint, models="coulomb_viscous", folds=2)
    assert found.winner == found.rows[0].model == "coulomb_viscous"
    again = jid.identify(
        recording,
        joint,
        model=found.rows[0].spec,
        search="separable",
        windows=found.settings["windows"],
    )
    assert again.parameters.keys() == found.estimate.parameters.keys()
    assert again.penalty == found.estimate.penalty


def test_a_symmetric_model_is_the_same_however_it_is_stated() -> None:
    with pytest.raises(InputError, match="given twice"):
        jid.compare_models(
            simulated(3), models=["coulomb_viscous", "coulomb_viscous:asymmetric=false"]
        )


def test_a_report_has_no_control_characters() -> None:
    joint = jid.Joint(name="a\x1b[2Jb")
    report = jid.compare_models(simulated(3), joint, models="coulomb_viscous", folds=2).report(
        verbose=True
    )
    assert "\x1b" not in report
    assert "a\ufffd[2Jb" in report


def test_an_asymmetric_model_takes_the_joints_offset_along() -> None:
    joint = jid.Joint(torque_offset=True, model=jid.Model("stribeck", asymmetric=True))
    models = ("coulomb_viscous", "coulomb_viscous:asymmetric")
    found = jid.compare_models(simulated(3), joint, models=models)
    plain, asymmetric = found.rows
    assert (plain.parameters, asymmetric.parameters) == (4, 5)
    assert found.winner == "coulomb_viscous"
    assert not found.estimate.settings["terms"][1].endswith("positive")


def test_same_bits_again(comparison: jid.Comparison, well_excited: jid.Recording) -> None:
    again = jid.compare_models(
        well_excited,
        jid.thesis_joint(),
        models=("coulomb_viscous", "stribeck"),
        search=jid.Search("separable", threads=1),
    )
    assert [entry.fold_scores for entry in again.rows] == [
        entry.fold_scores for entry in comparison.rows
    ]


# --- What it looks like ---


def test_report_json_and_html(comparison: jid.Comparison) -> None:
    text = comparison.report(verbose=True)
    assert "5 folds, one block of the recording held out in each" in text
    assert "chosen: stribeck" in text
    document = json.loads(comparison.to_json())
    assert document["schema"] == 1
    assert document["winner"] == "stribeck"
    assert [entry["model"] for entry in document["rows"]] == ["coulomb_viscous", "stribeck"]
    assert len(document["rows"][0]["fold_scores"]) == 5
    estimate = jid.Estimate.from_json(json.dumps(document["estimate"]))
    assert estimate.parameters["static"].value == comparison.estimate.parameters["static"].value
    page = comparison._repr_html_()
    assert page.count("<tr ") == 3
    assert "<b>Use stribeck: usable.</b>" in page
    assert "chosen stribeck" in repr(comparison)


def test_the_callback_sees_every_fit() -> None:
    steps: list[ComparisonStep] = []
    jid.compare_models(
        simulated(0), models=("coulomb_viscous", "stribeck"), folds=3, callback=steps.append
    )
    assert [step.number for step in steps] == list(range(1, 9))
    assert {step.total for step in steps} == {8}


def test_a_bar_is_drawn_on_a_terminal_only() -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    step = ComparisonStep(number=3, total=12, model="stribeck")
    shown: dict[type[io.StringIO], str] = {}
    for kind in (Terminal, io.StringIO):
        stream = kind()
        with ComparisonProgress(stream=stream) as progress:
            progress(step)
        shown[kind] = stream.getvalue()
    assert "██████·" in shown[Terminal]
    assert "fit 3/12, stribeck" in shown[Terminal]
    assert shown[Terminal].endswith("\r\033[K")
    assert shown[io.StringIO] == ""


def compare(**options: object) -> Callable[[], object]:
    return lambda: jid.compare_models(simulated(0), **options)  # type: ignore[call-overload]


@pytest.mark.parametrize(
    ("call", "wording"),
    [
        (compare(models=()), "at least one"),
        (compare(models=("stribeck", "stribeck")), "it is given twice"),
        (compare(models=("magic",)), "choose one of coulomb_viscous"),
        (compare(models=(3,)), "model is 3: "),
        (compare(models=(("stribeck", 3),)), "a mapping of its fields is expected"),
        (compare(models=("stribeck:magic",)), "model: magic: a model has no such option"),
        (compare(models=("stribeck:seed=3",)), "model: seed: a model has no such option"),
        (compare(models=("stribeck:",)), "write name:option"),
        (compare(models=("stribeck:ripple=",)), "write name:option"),
        (compare(models=("",)), "needs a name"),
        (compare(folds=1), "folds is 1"),
        (compare(folds=True), "folds is True"),
        (compare(folds=2.5), "folds is 2.5"),
        (compare(folds=100_000), "use fewer folds"),
        (compare(search="magic"), "separable"),
        (compare(parameters={"magic": 1.0}), "magic: there is no such parameter"),
        (lambda: jid.compare_models([]), r"recordings is \[\]: at least one"),
        (
            lambda: jid.compare_models([simulated(0), 3]),  # type: ignore[list-item]
            "recording 1: recordings is 3: a Recording is expected",
        ),
    ],
)
def test_bad_input_is_reported_in_a_sentence(call: Callable[[], object], wording: str) -> None:
    with pytest.raises(InputError, match=wording) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_a_fold_that_cannot_be_fitted_is_named() -> None:
    runs = [simulated(0, seconds=4.0), simulated(1, seconds=0.1)]
    with pytest.raises(InputError, match="model 'coulomb_viscous', fold 1 of 2"):
        jid.compare_models(runs, models="coulomb_viscous", windows=0.05)


def test_a_comparison_as_a_data_frame(comparison: jid.Comparison) -> None:
    frame = comparison.to_pandas()
    assert list(frame.index) == [row.model for row in comparison.rows]
    assert list(frame["score"]) == [row.score for row in comparison.rows]
    assert bool(frame.loc[comparison.winner, "eligible"])


@pytest.mark.parametrize(
    ("models", "winner", "misfits"),
    [
        (("coulomb_viscous",), "coulomb_viscous", True),
        (("coulomb_viscous:asymmetric", "coulomb_viscous"), "coulomb_viscous", True),
        (("coulomb_viscous", "stribeck"), "stribeck", False),  # the truth
    ],
)
@pytest.mark.parametrize("windows", [None, 0.05])
def test_causes_are_looked_for_of_the_winner_alone(
    models: tuple[str, ...],
    winner: str,
    misfits: bool,
    windows: float | None,
    well_excited: jid.Recording,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked, searched = [], []
    find = causes.find_causes

    def found(problem: Problem, *arguments: Any, **options: Any) -> Causes:
        model = problem.choice.model.resolved
        asked.append((model.name, model.asymmetric))
        return find(problem, *arguments, **options)

    def minimum(*arguments: Any) -> Any:
        searched.append(arguments)
        return run_search(*arguments)

    monkeypatch.setattr(causes, "find_causes", found)
    monkeypatch.setattr(identification, "run_search", minimum)
    joint = jid.thesis_joint()
    compared = jid.compare_models(well_excited, joint, models=models, windows=windows)
    assert compared.winner == winner
    best = row(compared, winner)
    assert asked == ([(winner, False)] if misfits else [])
    assert len(searched) == len(models)  # a search whose callback stops it is not done again
    duration = compared.settings["windows"]
    alone = jid.identify(well_excited, joint, model=best.spec, search="separable", windows=duration)
    assert best.penalty == compared.estimate.penalty == alone.penalty
    assert compared.estimate.findings == alone.findings
    assert compared.estimate.parameters == alone.parameters
    for finding in alone.warnings:
        assert f"{finding.severity} ({finding.code}): {finding.cause}" in compared.report(
            verbose=True
        )
    for line in alone.verdict.lines():
        assert line in compared.report(verbose=True)


def test_a_comparison_of_useless_values_says_so(well_excited: jid.Recording) -> None:
    degrees = jid.Recording(
        time=well_excited.time,
        position=np.degrees(well_excited.position),
        velocity=well_excited.velocity,
        torque=well_excited.torque,
    )
    comparison = jid.compare_models(
        degrees, models=["coulomb_viscous"], folds=3, search="separable"
    )
    blocking = [found for found in comparison.estimate.findings if found.severity == "blocking"]
    assert "implausible_units" in {found.code for found in blocking}
    lines = comparison.report(verbose=True).splitlines()
    for found in blocking:
        assert f"not usable ({found.code}): {found.cause}" in lines
    first = f"Use none: {blocking[0].cause}."
    assert first in html.unescape(report_page(comparison)).partition("<h2")[0]
    assert '<p class="verdict not-usable"><b>Use none: ' in comparison._repr_html_()
