"""The genetic search from Python: choices by word, presets, history, checkpoints, random search."""

import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from example_recordings import WELL_EXCITED

import jointid as jid
from jointid import _core

CHOICES: dict[str, list[str]] = {
    "coding": ["real", "binary"],
    "selection": ["tournament", "roulette", "rank"],
    "fitness": ["inverse_square", "inverse", "sum_minus"],
    "crossover": ["sbx", "sorted_sbx", "blx"],
    "bit_crossover": ["one_point", "two_point"],
    "uncrossed": ["mates", "places"],
    "mutation": ["non_uniform", "shrinking", "uniform", "polynomial"],
    "mutation_unit": ["gene", "individual"],
    "diversity": ["penalty", "fitness"],
}
SHORT = jid.GaOptions(population=12, generations=40, tolerance=0.0)

# A penalty of its own, so that a second interpreter can make the same one.
PENALTY = """
import numpy as np
from jointid import _core
from jointid.cli.demonstration import data_folder

def penalty_of(frequency):
    time = np.arange(2001) * 1e-3
    position = 0.4 * np.sin(frequency * time) + 0.1 * time
    velocity = 0.4 * frequency * np.cos(frequency * time) + 0.1
    acceleration = -0.4 * frequency**2 * np.sin(frequency * time)
    torque = 0.8 * acceleration + 3.0 * np.sign(velocity) + 1.5 * velocity
    recording = _core.Recording(
        time=time, position=position, velocity=velocity, torque=torque,
        sensor=None, torque_hold=_core.Hold.linear, gap_after=[],
    )
    return _core.Penalty(
        recordings=[recording], terms=["inertia", "coulomb", "viscous"],
        windows=_core.WindowOptions(count=40), residual=_core.Residual.torque,
    )

penalty, lower, upper = penalty_of(7.0), np.zeros(3), np.array([3.0, 10.0, 8.0])
"""


class Task:
    """The penalty above, and searches over it."""

    def __init__(self) -> None:
        scope: dict[str, Any] = {}
        exec(PENALTY, scope)
        self.penalty: _core.Penalty = scope["penalty"]
        self.other: _core.Penalty = scope["penalty_of"](9.0)
        self.box = (scope["lower"], scope["upper"])

    def search(self, options: jid.GaOptions = SHORT, **how: Any) -> _core.GaResult:
        return _core.minimise_genetic(self.penalty, *self.box, options=options, **how)


@pytest.fixture(scope="module")
def task() -> Task:
    return Task()


def bits(result: _core.GaResult) -> tuple[object, ...]:
    """All of a result that must not depend on threads or interruptions."""
    rows = [
        (g.number, g.best, g.mean, g.diversity, g.crossover_probability, g.mutation_probability)
        for g in result.history
    ]
    return (result.best.tobytes(), result.penalty, result.evaluations, result.stop, rows)


def with_choice(field: str, word: object) -> jid.GaOptions:
    change: dict[str, Any] = {field: word}
    return jid.GaOptions(**change)


@pytest.mark.parametrize("field", CHOICES)
def test_choices_are_words(field: str) -> None:
    for word in CHOICES[field]:
        options = with_choice(field, word)
        assert getattr(options, field) == word
        assert options.asdict()[field] == word
        assert f"{field}='{word}'" in repr(options)
        assert pickle.loads(pickle.dumps(options)) == options
        assert eval(repr(options), {"GaOptions": jid.GaOptions}) == options
    known = ", ".join(CHOICES[field])
    expected = f"GaOptions.{field} is 'fancy': choose one of {known}"
    with pytest.raises(ValueError, match=expected):
        with_choice(field, "fancy")
    with pytest.raises(jid.InputError, match=f"GaOptions.{field} is 3: it is of the wrong type"):
        with_choice(field, 3)


def test_every_word_searches(task: Task) -> None:
    plain = bits(task.search())
    different = set()
    for field, words in CHOICES.items():
        for word in words:
            base = SHORT.replace(selection="roulette") if field == "fitness" else SHORT
            base = SHORT.replace(coding="binary") if field == "bit_crossover" else base
            change: dict[str, Any] = {field: word}
            result = task.search(base.replace(**change))
            assert result.penalty < result.history[0].best
            different.add(bits(result)[0])
    # Every word walks its own way: the default, and selection 2, fitness 2, crossover 2, uncrossed 1,
    # mutation 3, its unit 1, binary coding with either crossover 2; diversity is only reported.
    assert plain[0] in different
    assert len(different) == 14


def test_presets_are_the_thesis_s_two_algorithms() -> None:
    text, code = jid.GaOptions.thesis(), jid.GaOptions.thesis_code()
    shared = {
        "population": 100,
        "generations": 1000,
        "coding": "real",
        "selection": "roulette",
        "elite": 0,
        "crossover_eta": 4.0,
        "crossover_gene_probability": 1.0,
        "mutation_unit": "individual",
        "mutation_exponent": 2.0,
        "adaptive": True,
        "diversity_low": 0.7,
        "diversity_high": 0.95,
        "crossover_probability_alike": 0.8,
        "mutation_probability": 0.03,
        "islands": 1,
        "tolerance": 0.0,
        "polish": False,
    }
    own = {
        "fitness": ("inverse_square", "sum_minus"),
        "crossover": ("sbx", "sorted_sbx"),
        "uncrossed": ("mates", "places"),
        "mutation": ("non_uniform", "shrinking"),
        "diversity": ("fitness", "penalty"),
        "crossover_probability": (0.95, 0.9),
        "mutation_probability_alike": (0.08, 0.15),
    }
    assert {name: text.asdict()[name] for name in shared} == shared
    assert {name: code.asdict()[name] for name in shared} == shared
    for name, (in_text, in_code) in own.items():
        assert (text.asdict()[name], code.asdict()[name]) == (in_text, in_code)
    differing = {name for name, value in text.asdict().items() if code.asdict()[name] != value}
    assert differing == set(own)


def test_history_tells_diversity_and_probabilities(task: Task) -> None:
    options = jid.GaOptions.thesis().replace(population=20, generations=60)
    history = task.search(options).history
    assert [g.number for g in history] == list(range(61))
    assert [g.evaluations for g in history] == [20 * (n + 1) for n in range(61)]
    assert all(0 < g.diversity <= 1 for g in history)
    for g in history:
        share = np.clip((g.diversity - 0.7) / 0.25, 0, 1)
        assert g.crossover_probability == pytest.approx(0.95 - 0.15 * share, abs=1e-15)
        assert g.mutation_probability == pytest.approx(0.03 + 0.05 * share, abs=1e-15)
    assert len({g.crossover_probability for g in history}) > 5


@pytest.mark.parametrize(
    "options",
    [
        SHORT,
        SHORT.replace(islands=4, migration_interval=6, adaptive=True),
        SHORT.replace(coding="binary"),
        jid.GaOptions.thesis().replace(population=12, generations=40),
        jid.GaOptions.thesis_code().replace(population=12, generations=40),
    ],
    ids=["default", "islands", "binary", "thesis", "thesis_code"],
)
def test_threads_and_interruptions_change_no_bit(task: Task, options: jid.GaOptions) -> None:
    whole = bits(task.search(options, seed=5, threads=1))
    assert bits(task.search(options, seed=5, threads=2)) == whole
    assert bits(task.search(options, seed=5, threads=7)) == whole
    assert bits(task.search(options, seed=6, threads=1)) != whole
    for stop in (0, 11, 39, 40):
        part = task.search(options, seed=5, callback=lambda g, stop=stop: g.number == stop)
        assert part.stop == _core.Stop.observer
        assert part.state is not None
        state = _core.GaState.from_bytes(part.state.to_bytes())
        assert state == part.state
        assert pickle.loads(pickle.dumps(state)) == state
        assert bits(task.search(options, seed=5, threads=2, resume=state)) == whole


def test_a_killed_search_resumes_to_the_same_bits(task: Task, tmp_path: Path) -> None:
    options = SHORT.replace(islands=2, generations=300)
    checkpoint = tmp_path / "search.checkpoint"
    program = f"""{PENALTY}
import os, time
def save(state):
    with open({str(checkpoint)!r} + ".new", "wb") as file:
        file.write(state.to_bytes())
    os.replace({str(checkpoint)!r} + ".new", {str(checkpoint)!r})
_core.minimise_genetic(
    penalty, lower, upper, options=_core.{options!r}, seed=8,
    callback=lambda g: time.sleep(0.01), checkpoint=save, checkpoint_interval=20,
)
"""
    running = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path)
    deadline = time.monotonic() + 60
    while not checkpoint.exists() and running.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    running.kill()
    assert running.wait() == -signal.SIGKILL
    state = _core.GaState.from_bytes(checkpoint.read_bytes())
    assert 20 <= state.generation < 300
    assert state.generation % 20 == 0
    assert bits(task.search(options, seed=8, resume=state)) == bits(task.search(options, seed=8))


def test_a_state_keeps_every_option(task: Task) -> None:
    plain = jid.GaOptions(population=8, generations=3)
    for name, value in plain.asdict().items():
        changes: dict[str, Any]
        if name in CHOICES:
            changes = {name: next(word for word in CHOICES[name] if word != value)}
        elif isinstance(value, bool):
            changes = {name: not value}
        else:
            changes = {name: value + 1 if isinstance(value, int) else 0.5 * value + 0.41}
        options = plain.replace(**changes)
        assert options != plain
        state = task.search(options).state
        assert state is not None
        assert _core.GaState.from_bytes(state.to_bytes()).options == options
        with pytest.raises(ValueError, match=rf"resume: .* with {name} "):
            task.search(plain, resume=state)


def test_a_state_tells_what_it_holds_and_refuses_other_runs(task: Task) -> None:
    result = task.search(seed=2)
    state = result.state
    assert state is not None
    assert (state.seed, state.trial, state.options) == (2, 0, SHORT)
    assert state.generation == result.history[-1].number
    assert state.genes.shape == (3, 12)
    assert state.penalties.min() >= state.penalty == result.penalty
    assert np.array_equal(state.best, result.best)
    with pytest.raises(ValueError, match="seed 2, not 3"):
        task.search(seed=3, resume=state)
    with pytest.raises(ValueError, match="belongs to another recording, model or windows"):
        _core.minimise_genetic(task.other, *task.box, options=SHORT, seed=2, resume=state)
    for content in (b"", b"no state", state.to_bytes()[:-1], state.to_bytes() + b"x"):
        with pytest.raises(ValueError, match="checkpoint of a genetic search: "):
            _core.GaState.from_bytes(content)


def test_random_search_has_the_same_budget_and_finds_less(task: Task) -> None:
    def go(**how: Any) -> _core.GaResult:
        return _core.minimise_random(task.penalty, *task.box, options=SHORT, **how)

    result = go(seed=1)
    assert result.state is None
    assert result.evaluations == 12 * 41
    assert bits(go(seed=1, threads=7)) == bits(result)
    assert bits(go(seed=2)) != bits(result)
    assert result.penalty == task.penalty(result.best)
    assert task.search(seed=1).penalty < result.penalty
    assert go(seed=1, callback=lambda g: g.number == 3).stop == _core.Stop.observer


def test_identify_takes_the_presets(repo: Path) -> None:
    recording = jid.load(repo / "examples" / "data" / "well_excited.csv.gz")
    for preset in (jid.GaOptions.thesis(), jid.GaOptions.thesis_code()):
        options = preset.replace(population=20, generations=10)
        estimate = jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options))
        assert estimate.settings["ga"] == options.asdict()


def test_identify_resumes_a_killed_search_to_the_same_bits(tmp_path: Path) -> None:
    recording = jid.load(WELL_EXCITED)
    options = jid.GaOptions(population=20, generations=120)
    whole = jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options, seed=5))
    path = tmp_path / "search.state"

    def give_up(generation: jid.Generation) -> None:
        if generation.number == 70:
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        jid.identify(
            recording,
            jid.thesis_joint(),
            search=jid.Search(ga=options, seed=5, callback=give_up, checkpoint=path),
        )
    resumed = jid.identify(
        recording, jid.thesis_joint(), search=jid.Search(ga=options, seed=5, resume=path)
    )
    assert {n: p.value for n, p in resumed.parameters.items()} == {
        n: p.value for n, p in whole.parameters.items()
    }
    assert whole.convergence is not None
    assert resumed.convergence is not None
    assert np.array_equal(whole.convergence.mean, resumed.convergence.mean)
    with pytest.raises(jid.InputError, match="seed"):
        jid.identify(
            recording, jid.thesis_joint(), search=jid.Search(ga=options, seed=6, resume=path)
        )
    path.write_bytes(b"nonsense")
    with pytest.raises(jid.InputError, match=r"search\.state"):
        jid.identify(recording, jid.thesis_joint(), search=jid.Search(ga=options, resume=path))


def test_random_search_is_worse_for_the_same_budget() -> None:
    recording = jid.load(WELL_EXCITED)
    options = jid.GaOptions(population=60, generations=150, polish=False)
    random, genetic = (
        jid.identify(recording, jid.thesis_joint(), search=jid.Search(method, ga=options))
        for method in ("random", "ga")
    )
    assert random.convergence is not None
    assert genetic.convergence is not None
    assert random.convergence.evaluations[-1] == genetic.convergence.evaluations[-1]
    assert random.penalty > genetic.penalty
    assert random.status == "stopped"
