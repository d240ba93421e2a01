"""Studies: the same rows wherever and in how many goes they are done, and nothing lost on the way."""

import csv
import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid import _core
from jointid.study.row import Row
from jointid.study.study_file import StudyFile
from jointid.study.summary import Summary

GRID = {"ga.population": [8, 12], "ga.generations": [5, 15]}
TRUTH = {
    "coulomb": 25.0,
    "static": 20.0,
    "stribeck": 100.0,
    "viscous": 20.0,
    "sensor_gain": 2.4,
    "sensor_offset": 15.0,
}


@pytest.fixture(scope="module")
def recording() -> jid.Recording:
    return jid.load(WELL_EXCITED)


@pytest.fixture(scope="module")
def joint() -> jid.Joint:
    return jid.thesis_joint()


@pytest.fixture(scope="module")
def scenario(joint: jid.Joint) -> jid.Scenario:
    true = joint.with_parameters(TRUTH)
    estimates = jid.control_estimates(true) | {"coulomb": 10.0, "viscous": 10.0}
    return jid.Scenario(
        true,
        jid.AdaptiveRobust(**estimates),
        jid.Trajectory.thesis(1.0, cycle=3.0, duration=6.0),
        jid.Sensors(torque_noise=0.5),
        control_period=2e-3,
    )


@pytest.fixture(scope="module")
def study(recording: jid.Recording, joint: jid.Joint) -> jid.Study:
    return jid.sweep(
        recording, joint, grid=GRID, trials=3, windows=200, truth=TRUTH, search=jid.Search(seed=5)
    )


class _AtOnce(Executor):
    """Does the work in this process; counts the parts."""

    def __init__(self) -> None:
        self.parts = 0

    def submit(self, fn: Any, /, *arguments: Any, **keywords: Any) -> Future[Any]:
        self.parts += 1
        future: Future[Any] = Future()
        future.set_result(fn(*arguments, **keywords))
        return future


def test_a_row_is_what_identify_gives_with_its_seed(
    recording: jid.Recording, joint: jid.Joint, study: jid.Study
) -> None:
    assert study.complete
    assert [row.place for row in study.rows] == [(c, t) for c in range(4) for t in range(3)]
    for row in study.rows:
        cell = study.cells[row.cell]
        options = jid.GaOptions(
            population=cell["ga.population"], generations=cell["ga.generations"]
        )
        estimate = jid.identify(
            recording, joint, windows=200, search=jid.Search(ga=options, seed=row.seed)
        )
        assert row.seed == 5 + row.trial
        assert row.values == {n: p.value for n, p in estimate.parameters.items()}
        assert row.status == estimate.status
        assert estimate.convergence is not None
        assert row.evaluations == estimate.convergence.evaluations[-1]
        assert row.penalty == pytest.approx(estimate.penalty, rel=1e-12)


@pytest.mark.parametrize("method", ["random", "separable"])
def test_other_methods_are_those_of_identify(
    recording: jid.Recording, joint: jid.Joint, method: Any
) -> None:
    options = jid.GaOptions(population=20, generations=10)
    found = jid.sweep(
        recording, joint, trials=2, standard_errors=True, search=jid.Search(method, ga=options)
    )
    for row in found.rows:
        wanted = jid.identify(
            recording, joint, search=jid.Search(method, ga=options, seed=row.seed)
        )
        assert row.values == {n: p.value for n, p in wanted.parameters.items()}
        errors = {n: p.stderr for n, p in wanted.parameters.items() if p.stderr is not None}
        assert row.stderr == errors


def test_threads_and_executors_give_the_same_bits(
    recording: jid.Recording, joint: jid.Joint, study: jid.Study
) -> None:
    again: dict[str, Any] = {"grid": GRID, "trials": 3, "windows": 200}
    for threads in (1, 2, 7):
        assert (
            jid.sweep(recording, joint, search=jid.Search(seed=5, threads=threads), **again).rows
            == study.rows
        )
    at_once = _AtOnce()
    assert (
        jid.sweep(recording, joint, executor=at_once, search=jid.Search(seed=5), **again).rows
        == study.rows
    )
    assert at_once.parts > 0
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert (
            jid.sweep(recording, joint, executor=pool, search=jid.Search(seed=5), **again).rows
            == study.rows
        )


@pytest.mark.slow
def test_a_dask_cluster_of_processes_gives_the_same_bits(
    scenario: jid.Scenario, recording: jid.Recording, joint: jid.Joint, study: jid.Study
) -> None:
    distributed = pytest.importorskip("distributed")
    simulated: dict[str, Any] = {"grid": {"sensors.torque_noise": [0.1, 1.0]}, "trials": 3}
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        there = jid.sweep(scenario, executor=client.get_executor(), **simulated)
        grid = jid.sweep(
            recording,
            joint,
            grid=GRID,
            trials=3,
            windows=200,
            executor=client.get_executor(),
            search=jid.Search(seed=5),
        )
    assert there.rows == jid.sweep(scenario, **simulated).rows
    assert grid.rows == study.rows


def test_a_scenario_is_simulated_anew_for_each_trial(scenario: jid.Scenario) -> None:
    study = jid.sweep(
        scenario,
        grid={"sensors.torque_noise": [0.0, 1.0], "truth.coulomb": [20.0, 30.0]},
        trials=2,
        tracking=True,
        search=jid.Search(seed=3),
    )
    for row in study.rows:
        cell = study.cells[row.cell]
        changed = scenario.changed(cell)
        recording = jid.simulate(
            scenario.joint.with_parameters({"coulomb": cell["truth.coulomb"]}),
            scenario.controller,
            scenario.trajectory,
            sensors=jid.Sensors(torque_noise=cell["sensors.torque_noise"]),
            control_period=2e-3,
            seed=row.seed,
        )
        estimate = jid.identify(recording, changed.joint, search=jid.Search(seed=row.seed))
        assert row.values == {n: p.value for n, p in estimate.parameters.items()}
        after = changed.simulate(row.seed, controllers=changed.believing(estimate.joint))
        assert row.tracking["after"] == after.error[0]
        assert row.tracking["after"] < 0.5 * row.tracking["before"]
        assert row.values["coulomb"] == pytest.approx(study.truth_of(row.cell)["coulomb"], rel=0.02)
    noisy = study.column("sensors.torque_noise") > 0.0
    coulomb = study.column("coulomb")
    assert len(set(coulomb[noisy])) == 4  # each trial has noise of its own
    assert coulomb[~noisy][::2] == pytest.approx(coulomb[~noisy][1::2], rel=1e-9)


def test_presets_and_labelled_values_make_cells(
    scenario: jid.Scenario, recording: jid.Recording, joint: jid.Joint
) -> None:
    slow = jid.Trajectory.thesis(0.5, cycle=6.0, duration=6.0)
    found = jid.sweep(
        scenario,
        grid={"trajectory": {"wide": scenario.trajectory, "slow": slow}},
        trials=1,
        search=jid.Search(ga=jid.GaOptions(population=10, generations=5)),
    )
    assert [cell["trajectory"] for cell in found.cells] == ["wide", "slow"]
    assert found.rows[0].values != found.rows[1].values
    presets = jid.sweep(
        recording, joint, grid={"ga": ["default", "thesis"], "ga.generations": [5]}, trials=1
    )
    text = jid.identify(
        recording, joint, search=jid.Search(ga=jid.GaOptions.thesis().replace(generations=5))
    )
    assert presets.rows[1].values == {n: p.value for n, p in text.parameters.items()}


def test_a_loop_that_diverges_takes_no_other_trial_with_it(scenario: jid.Scenario) -> None:
    """Adaptation on the edge, without a torque limit: some seeds diverge."""
    edge = scenario.changed(
        {
            "joint": scenario.joint.replace(limits=jid.Limits()),
            "sensors": jid.Sensors(encoder_counts=8000, velocity="counts", torque_noise=0.5),
            "controller.adaptation": True,
            "controller.adaptation_dry": 0.00026 * 101.0**2,
            "controller.adaptation_viscous": 0.00026 * 101.0**4,
        }
    )
    options = jid.GaOptions(population=8, generations=5)
    study = jid.sweep(edge, trials=16, search=jid.Search(ga=options))
    refused = [row.trial for row in study.rows if row.status == "refused"]
    assert 0 < len(refused) < 16
    assert "not stable" in study.rows[refused[0]].message
    alone = [
        jid.sweep(edge, trials=1, search=jid.Search(ga=options, seed=t)).rows
        for t in range(16)
        if t not in refused
    ]
    kept = [row for row in study.rows if row.trial not in refused]
    assert [rows[0].values for rows in alone] == [row.values for row in kept]


def test_tracking_knows_what_a_controller_cannot_believe(scenario: jid.Scenario) -> None:
    study = jid.sweep(
        scenario,
        grid={"model": ["coulomb_viscous", "stribeck_general"]},
        trials=1,
        tracking=True,
    )
    plain, general = study.rows
    believed = scenario.joint.replace(
        model=scenario.joint.model.replace(name="coulomb_viscous")
    ).with_parameters(
        {
            name: plain.values[name]
            for name in ("coulomb", "viscous", "sensor_gain", "sensor_offset")
        }
    )
    law = scenario.believing(believed)
    assert law.asdict()["static"] == 0.0
    error = scenario.simulate(0, controllers=law, recordings=False).error[0]
    assert plain.tracking["after"] == error
    assert np.isnan(general.tracking["after"])
    assert general.values["coulomb"] > 0.0


def test_truths_that_differ_are_those_of_their_cells(scenario: jid.Scenario) -> None:
    other = scenario.joint.with_parameters({"coulomb": 12.0})
    by_joint = jid.sweep(scenario, grid={"joint": {"a": scenario.joint, "b": other}}, trials=2)
    labelled = jid.sweep(scenario, grid={"truth.coulomb": {"a": 25.0, "b": 12.0}}, trials=2)
    for study in (by_joint, labelled):
        assert [study.truth_of(cell)["coulomb"] for cell in (0, 1)] == [25.0, 12.0]
        assert all(abs(cell.bias["coulomb"]) < 0.02 for cell in study.summary().cells)


def test_a_dead_worker_is_reported_with_what_was_done(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path
) -> None:
    path = tmp_path / "study.jsonl"
    again: dict[str, Any] = {"grid": {"windows": list(range(50, 250, 20))}, "trials": 4}
    again |= {"search": jid.Search(ga="thesis"), "output": path}
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:

        def kill(step: jid.StudyStep) -> None:
            if step.number > 4:
                for process in list(pool._processes.values()):
                    process.kill()

        with pytest.raises(jid.StudyBrokenError, match="with an output file can be") as broken:
            jid.sweep(recording, joint, executor=pool, callback=kill, **again)
    assert 4 < len(broken.value.study) < 40
    assert jid.Study.load(path).rows == broken.value.study.rows
    whole = jid.sweep(recording, joint, resume=True, **again)
    assert whole.complete
    assert (
        whole.rows[:4]
        == jid.sweep(
            recording, joint, grid={"windows": [50]}, trials=4, search=jid.Search(ga="thesis")
        ).rows
    )


def test_one_cell_needs_no_grid(recording: jid.Recording, joint: jid.Joint) -> None:
    found = jid.sweep(recording, joint, trials=2)
    assert (len(found.cells), len(found)) == (1, 2)
    assert "coulomb" in str(found)


def test_trials_side_by_side_are_the_searches_one_by_one() -> None:
    rng = np.random.default_rng(1)
    time_, position = np.arange(400) * 0.01, np.cumsum(rng.normal(size=400)) * 0.01
    recording = jid.Recording(time=time_, position=position, torque=rng.normal(size=400))
    core = _core.Recording(
        time=recording.time,
        position=recording.position,
        velocity=recording.velocity,
        torque=np.asarray(recording.torque),
        sensor=None,
        torque_hold=_core.Hold.linear,
        gap_after=[],
    )
    penalty = _core.Penalty(
        recordings=[core],
        terms=["inertia", "coulomb", "viscous"],
        windows=_core.WindowOptions(),
        residual=_core.Residual.torque,
    )
    low, high = np.zeros(3), np.full(3, 5.0)
    sizes = [jid.GaOptions(population=n, generations=g) for n, g in ((6, 9), (40, 3), (10, 70))]
    seeds = [3, 2**63, 0]
    for random in (False, True):
        many = _core.minimise_trials(
            penalty, low, high, options=sizes, seeds=seeds, random=random, threads=2
        )
        single = _core.minimise_random if random else _core.minimise_genetic
        for options, seed, found in zip(sizes, seeds, many, strict=True):
            alone = single(penalty, low, high, options=options, seed=seed)
            assert found.best.tolist() == alone.best.tolist()
            assert (found.penalty, found.evaluations) == (alone.penalty, alone.evaluations)
            assert (found.stop, found.generations) == (alone.stop, alone.history[-1].number)
    with pytest.raises(ValueError, match="equally many, got 3 and 1"):
        _core.minimise_trials(penalty, low, high, options=sizes, seeds=[1])


def test_what_cannot_be_used_here_is_refused_there_only(
    recording: jid.Recording, joint: jid.Joint
) -> None:
    found = jid.sweep(recording, joint, grid={"windows": [50, 1e9]}, trials=2)
    assert [row.status for row in found.rows] == ["converged", "converged", "refused", "refused"]
    assert "refused" in str(found)
    assert np.isnan(found.column("penalty")[2:]).all()
    assert found.column("message")[3]
    with pytest.raises(jid.InputError, match="window"):
        jid.sweep(recording, joint, grid={"windows": [1e9]}, trials=2)


@pytest.mark.parametrize(
    ("keywords", "wording"),
    [
        ({"grid": {"ga.populaton": [20]}}, "grid: ga.populaton: it cannot be swept; did you mean"),
        (
            {"grid": {"sensors.torque_noise": [1.0]}},
            "grid: sensors.torque_noise: .* simulation.*; sweep with subject=... \\(a scenario",
        ),
        ({"grid": {3: [1.0]}}, "grid is 3: the name of a setting"),
        ({"grid": {"windows": 100}}, "grid: windows is 100: a list of values is expected"),
        ({"grid": {"windows": []}}, r"grid: windows is \[\]: at least one value"),
        ({"grid": {"windows": [100, 100]}}, r"windows is \[100, 100\]: a value is given twice"),
        ({"grid": {"windows": {(1, 2): 100}}}, r"grid: windows: \(1, 2\) is not a label"),
        ({"grid": {"ga": [jid.GaOptions()]}}, "a table cannot show the value .*; give a mapping"),
        ({"grid": {"ga.population": [1]}}, "population is 1: must be 4 to 1000000"),
        ({"grid": {"ga.population": ["many"]}}, "grid: ga.population is 'many': a whole number"),
        ({"grid": {"ga.population": [True]}}, "ga.population is True: a whole number"),
        ({"grid": {"ga.population": [10**30]}}, "ga.population is 10*: a whole number below"),
        ({"grid": {"ga.coding": [3]}}, "ga.coding is 3: text"),
        ({"grid": {"ga.polish": [1]}}, "ga.polish is 1: true or false"),
        ({"grid": {"ga.tolerance": ["small"]}}, "ga.tolerance is 'small': a number"),
        ({"grid": {"ga.tolerance": [float("nan")]}}, "ga.tolerance is nan: a finite number"),
        ({"grid": {"method": ["simplex"]}}, "method is 'simplex': it is unknown"),
        ({"grid": [("windows", 3)]}, r"grid is \[\('windows', 3\)\]: a mapping from a setting's"),
        ({"trials": 0}, "trials is 0: 1 to"),
        ({"search": jid.Search(seed=2**64 - 1), "trials": 2}, "seed is .*: 0 to"),
        ({"grid": {"ga": ["thesys"]}}, "did you mean 'thesis'"),
        ({"search": jid.Search(checkpoint="x.bin")}, "leave it out of the search"),
        ({"tracking": True}, "tracking is True: .*; sweep with subject=... \\(a scenario"),
        ({"resume": True}, "resume is True: there is no file to continue; sweep with output="),
        ({"output": "x.csv"}, r"output is 'x\.csv': a file that ends in \.jsonl"),
        ({"output": "nowhere/x.jsonl"}, "output is 'nowhere/x.jsonl': .* does not exist; create"),
        ({"executor": 3}, "executor is 3: a concurrent.futures.Executor is expected"),
        ({"callback": 3}, "callback is 3: a function"),
        ({"truth": 3}, "truth is 3"),
        ({"truth": {"coulomb": "much"}}, "coulomb is 'much'"),
        ({"standard_errors": 1}, "standard_errors is 1: true or false"),
    ],
)
def test_wrong_input_is_reported_in_a_sentence(
    recording: jid.Recording, joint: jid.Joint, keywords: dict[str, Any], wording: str
) -> None:
    with pytest.raises(jid.InputError, match=wording) as error:
        jid.sweep(recording, joint, **keywords)
    assert "\n" not in str(error.value)


def test_a_refused_row_has_no_advice_and_the_error_has(
    recording: jid.Recording, joint: jid.Joint
) -> None:
    blind = joint.replace(sensor=False, torque_offset=None)
    mixed = jid.sweep(recording, blind, grid={"residual": ["torque", "sensor"]}, trials=1)
    message = mixed.rows[1].message
    assert message.startswith("residual is 'sensor': ")
    assert "identify with" not in message
    with pytest.raises(jid.InputError) as caught:
        jid.sweep(recording, blind, residual="sensor", trials=1)
    assert (caught.value.argument, caught.value.value) == ("residual", "sensor")
    assert "identify with residual=" in str(caught.value)


def test_a_scenario_refuses_what_it_has_not(scenario: jid.Scenario, joint: jid.Joint) -> None:
    with pytest.raises(jid.InputError, match=r"did you mean 'sensors\.torque_noise'"):
        jid.sweep(scenario, grid={"sensors.torque_nois": [1.0]})
    with pytest.raises(jid.InputError, match=r"^controller is 3"):
        jid.Scenario(joint, 3, scenario.trajectory)  # type: ignore[arg-type]
    with pytest.raises(jid.InputError, match="uses no estimates"):
        jid.sweep(scenario.changed({"controller": jid.Pd(stiffness=1.0)}), tracking=True)
    with pytest.raises(jid.InputError, match=r"Scenario\.controler: no such field"):
        scenario.changed({"controler": jid.Pd()})
    with pytest.raises(jid.InputError, match="torque_noise"):
        scenario.changed({"sensors.torque_noise": -1.0})


def test_the_table_is_the_same_in_every_form(study: jid.Study, tmp_path: Path) -> None:
    frame = study.to_pandas()
    assert list(frame.columns) == list(study.columns)
    assert frame["coulomb"].tolist() == [row.values["coulomb"] for row in study.rows]
    study.save(tmp_path / "table.csv")
    with (tmp_path / "table.csv").open(newline="") as file:
        lines = list(csv.DictReader(file))
    assert [float(line["coulomb"]) for line in lines] == frame["coulomb"].tolist()
    study.save(tmp_path / "table.parquet")
    parquet = pytest.importorskip("pyarrow.parquet").read_table(tmp_path / "table.parquet")
    assert parquet.to_pydict()["penalty"] == frame["penalty"].tolist()
    study.save(tmp_path / "study.jsonl")
    back = jid.Study.load(tmp_path / "study.jsonl")
    assert back.rows == study.rows
    assert (back.cells, back.truth, back.trials) == (study.cells, study.truth, study.trials)
    with pytest.raises(jid.InputError, match=r"saved as \.csv, \.parquet, \.jsonl"):
        study.save(tmp_path / "table.xlsx")
    with pytest.raises(jid.InputError, match=r"'colomb': .* no such column; did you mean 'coul"):
        study.column("colomb")


def test_a_data_frame_without_pandas_says_what_to_install(
    study: jid.Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    for table in (study, study.summary()):
        with pytest.raises(jid.InputError, match="pip install pandas"):
            table.to_pandas()


def test_the_summary_counts_right(study: jid.Study) -> None:
    summary = study.summary(within=0.02)
    for number, cell in enumerate(summary.cells):
        mine = [row for row in study.rows if row.cell == number]
        values = np.array([row.values["static"] for row in mine])
        true = study.truth["static"]
        assert cell.mean["static"] == pytest.approx(values.mean(), rel=1e-15)
        assert cell.bias["static"] == pytest.approx(values.mean() / true - 1.0, abs=1e-12)
        near = [
            all(abs(row.values[n] / v - 1.0) <= 0.02 for n, v in study.truth.items() if v)
            for row in mine
        ]
        assert cell.success == pytest.approx(np.mean(near))
    frame = summary.to_pandas()
    assert len(frame) == 4
    assert len(json.loads(json.dumps(summary.asdict()))["cells"]) == 4


class _Interrupt:
    """Raises after some trials, as Ctrl-C would."""

    def __init__(self, after: int) -> None:
        self.after = after

    def __call__(self, step: jid.StudyStep) -> None:
        if step.number >= self.after:
            raise KeyboardInterrupt


def test_ctrl_c_keeps_what_is_done(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path
) -> None:
    again: dict[str, Any] = {"grid": {"windows": [50, 100, 200]}, "trials": 2}
    whole = jid.sweep(recording, joint, **again)
    path = tmp_path / "study.jsonl"
    with pytest.raises(KeyboardInterrupt) as interrupted:
        jid.sweep(recording, joint, callback=_Interrupt(2), output=path, **again)
    assert isinstance(interrupted.value, jid.StudyInterruptedError)
    kept = interrupted.value.study
    assert not kept.complete
    assert all(row in whole.rows for row in kept.rows)
    assert jid.Study.load(path).rows == kept.rows
    seen: list[Row] = []
    rest = jid.sweep(
        recording,
        joint,
        output=path,
        resume=True,
        callback=lambda step: seen.extend(step.rows),
        **again,
    )
    assert rest.rows == whole.rows
    assert sorted(r.place for r in [*kept.rows, *seen]) == [r.place for r in whole.rows]
    assert jid.Study.load(path).rows == whole.rows


def test_a_callback_stops(recording: jid.Recording, joint: jid.Joint) -> None:
    found = jid.sweep(
        recording, joint, grid={"windows": [50, 100, 200]}, trials=1, callback=lambda _: True
    )
    assert len(found) == 1
    assert not found.complete


def test_more_trials_are_added_to_a_finished_file(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path
) -> None:
    path = tmp_path / "study.jsonl"
    few = jid.sweep(recording, joint, grid=GRID, trials=1, output=path)
    more = jid.sweep(recording, joint, grid=GRID, trials=3, output=path, resume=True)
    assert more.rows == jid.sweep(recording, joint, grid=GRID, trials=3).rows
    assert all(row in more.rows for row in few.rows)
    assert jid.Study.load(path).trials == 3
    fewer = jid.sweep(recording, joint, grid=GRID, trials=2, output=path, resume=True)
    assert len(fewer) == 8


def test_a_torn_line_is_done_again(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path
) -> None:
    path = tmp_path / "study.jsonl"
    whole = jid.sweep(recording, joint, grid=GRID, trials=2, output=path)
    content = path.read_bytes()
    for cut in (len(content) - 1, len(content) - 40, content.find(b"\n") + 1):
        path.write_bytes(content[:cut])
        assert jid.sweep(recording, joint, grid=GRID, trials=2, output=path, resume=True).rows == (
            whole.rows
        )
        assert sorted(path.read_bytes().splitlines()[1:]) == sorted(content.splitlines()[1:])


def test_another_studys_file_is_left_alone(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path
) -> None:
    path = tmp_path / "study.jsonl"
    jid.sweep(recording, joint, grid=GRID, trials=1, output=path)
    content = path.read_bytes()
    changes: list[tuple[dict[str, Any], str]] = [
        ({"grid": GRID}, "the file exists; sweep with resume=True .* or sweep with output="),
        ({"grid": {"ga.population": [8]}, "resume": True}, "other swept settings"),
        ({"grid": GRID | {"ga.population": [8]}, "resume": True}, "other values of the grid"),
        ({"grid": GRID, "search": jid.Search(seed=1), "resume": True}, "another seed"),
        ({"grid": GRID, "windows": 77, "resume": True}, "another options"),
    ]
    for keywords, wording in changes:
        with pytest.raises(jid.InputError, match=wording):
            jid.sweep(recording, joint, trials=1, output=path, **keywords)
    other = recording.crop(0.0, 6.0)
    with pytest.raises(jid.InputError, match="another subject"):
        jid.sweep(other, joint, grid=GRID, trials=1, output=path, resume=True)
    assert path.read_bytes() == content


@pytest.mark.parametrize(
    "content", [b"", b"{}\n", b"[1]\n", b"not json\n", b'{"format": "jointid-study"}\n', b"\xff\n"]
)
def test_a_file_that_is_no_study_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "study.jsonl"
    path.write_bytes(content)
    with pytest.raises(jid.InputError, match=r"study\.jsonl"):
        jid.Study.load(path)


_LONG = """
import sys
import jointid as jid
recording = jid.load(sys.argv[2])
try:
    jid.sweep(
        recording,
        jid.thesis_joint(),
        grid={"windows": list(range(50, 450, int(sys.argv[3])))},
        trials=4,
        search=jid.Search(ga="thesis", threads=2),
        output=sys.argv[1],
        resume=True,
    )
except jid.StudyInterruptedError as interrupted:
    print(len(interrupted.study))
    raise SystemExit(130)
"""


def _lines(path: Path) -> Iterator[str]:
    return iter(path.read_text().splitlines() if path.exists() else [])


@pytest.mark.parametrize(
    ("kill", "step"),
    [
        (signal.SIGKILL, 60),
        pytest.param(signal.SIGKILL, 10, marks=pytest.mark.slow),
        pytest.param(signal.SIGINT, 10, marks=pytest.mark.slow),
    ],
)
def test_a_killed_study_goes_on(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path, kill: signal.Signals, step: int
) -> None:
    """After each 15 rows of at least 28."""
    grid = {"windows": list(range(50, 450, step))}
    path = tmp_path / "study.jsonl"
    kills = 0
    for _ in range(20):
        begun = len(list(_lines(path)))
        child = subprocess.Popen(
            [sys.executable, "-c", _LONG, str(path), str(WELL_EXCITED), str(step)],
            stdout=subprocess.PIPE,
            text=True,
        )
        while child.poll() is None and len(list(_lines(path))) < begun + 15:
            time.sleep(0.002)
        if child.poll() is None:
            os.kill(child.pid, kill)
            kills += 1
        wording, _ = child.communicate(timeout=60)
        if child.returncode == 0:
            break
        if kill == signal.SIGINT:
            assert child.returncode in (130, -signal.SIGINT)
            if child.returncode == 130:
                assert int(wording) == len(jid.Study.load(path))
    assert kills > 0
    whole = jid.sweep(recording, joint, grid=grid, trials=4, search=jid.Search(ga="thesis"))
    assert jid.Study.load(path).rows == whole.rows
    rows = [json.loads(line) for line in _lines(path)]
    places = [(row["cell"], row["trial"]) for row in rows if "cell" in row]
    assert len(places) == len(set(places)) == len(whole.rows)


def test_a_plot_shows_each_cell(study: jid.Study) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    try:
        heat = jid.plot.sweep(study, value="error.coulomb")
        assert len(heat.texts) == 4
        assert (heat.get_xlabel(), heat.get_ylabel()) == ("ga.population", "ga.generations")
        axes = pyplot.subplots()[1]
        assert jid.plot.sweep(study, "ga.generations", value="static", ax=axes) is axes
        assert "N·m" in axes.get_ylabel()
        worst = jid.plot.sweep(study, value="error.worst", statistic="worst")
        errors = [
            max(abs(100.0 * (row.values[n] / v - 1.0)) for n, v in TRUTH.items())
            for row in study.rows
        ]
        assert max(float(text.get_text()) for text in worst.texts) == pytest.approx(
            max(errors), rel=0.01
        )
        with pytest.raises(jid.InputError, match="x is 'windows': this setting is not swept"):
            jid.plot.sweep(study, "windows")
        with pytest.raises(jid.InputError, match="the study has no true value"):
            jid.plot.sweep(study, value="error.inertia")
    finally:
        pyplot.close("all")


def test_one_trial_has_no_spread(study: jid.Study) -> None:
    first = study.summary().cells[0]
    alone = replace(first, trials=1, mean={"a": 25.0}, spread={"a": math.nan}, bias={})
    known = replace(alone, bias={"a": 0.01}, scatter={"a": math.nan})
    for cell in (alone, known):
        assert "±" not in str(Summary(cells=(cell,), within=0.05))


def test_what_the_table_leaves_out_is_named(study: jid.Study) -> None:
    first = study.summary().cells[0]
    cells = tuple(
        replace(first, mean={"a": a, "b": 2.0}, spread={"a": 0.1, "b": 0.0}, bias={})
        for a in (1.0, 2.0)
    )
    summary = Summary(cells=cells, within=0.05)
    assert str(summary).endswith("\nnot shown: b (same in all cells)")
    assert "<p>not shown: b (same in all cells)</p>" in summary.to_html()
    same = replace(cells[0], spread={"a": 0.0, "b": 0.0})
    assert "not shown" not in str(Summary(cells=(same,), within=0.05))


def test_a_swept_model_keeps_what_the_study_states(
    recording: jid.Recording, joint: jid.Joint
) -> None:
    found = jid.sweep(
        recording,
        joint.replace(sensor=False),
        model=jid.Model(load_friction=True),
        grid={"model": ["coulomb_viscous", "coulomb_viscous:load_friction=false"]},
        trials=1,
        search="separable",
    )
    assert [("load_friction" in row.values) for row in found.rows] == [True, False]


def test_a_summary_has_no_control_characters(recording: jid.Recording, joint: jid.Joint) -> None:
    found = jid.sweep(
        recording, joint, grid={"windows": {"a\x1b[2J": 50}}, trials=1, search="separable"
    )
    assert "\x1b" not in str(found)
    assert "a\ufffd[2J" in str(found)


def test_an_interrupted_study_knows_the_rows_that_were_written_as_it_was_stopped(
    recording: jid.Recording, joint: jid.Joint, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "study.jsonl"
    append = StudyFile.append

    def stopped(file: StudyFile, rows: Any) -> None:
        append(file, rows)
        raise KeyboardInterrupt

    monkeypatch.setattr(StudyFile, "append", stopped)
    with pytest.raises(jid.StudyInterruptedError) as caught:
        jid.sweep(recording, joint, grid={"windows": [50, 60]}, trials=2, output=path)
    assert len(caught.value.study) > 0
    assert caught.value.study.rows == jid.Study.load(path).rows
