"""Every kind of result has the interface of `base/result.py`; where one has a hole, the reason is here."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
import small_arm
from designs import designed
from moving_joints import recorded, sines, torques
from online_feeding import fed
from read_back.registry import SAVED
from report_pages import good
from simulated_servo import Truth, bench_runs, servo_joint

import jointid as jid
from jointid.base.result import KINDS, KeptResult, Overview, Quantity, Result, kind_of
from jointid.cli.demonstration import data_folder
from jointid.commissioning import Commissioning
from jointid.commissioning.result import BenchRun
from jointid.estimate.causes import Causes
from jointid.estimate.findings import Finding
from jointid.estimate.verdict import Verdict
from jointid.verbs.result_kinds import _HOMES, class_of_kind

_GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guide.md"
METHODS = (
    *("overview", "report", "to_dict", "_repr_html_"),
    *("to_json", "from_json", "save", "load", "to_pandas"),
)
_KEPT = frozenset({"to_json", "from_json", "save", "load", "to_pandas"})
CLASSES: dict[str, type[Result]] = {
    "estimate": jid.Estimate,
    "joints": jid.JointEstimates,
    "robot": jid.RobotEstimate,
    "servo": jid.ServoEstimate,
    "comparison": jid.Comparison,
    "robot comparison": jid.RobotComparison,
    "servo comparison": jid.ServoComparison,
    "design": jid.Design,
    "study": jid.Study,
    "rollout": jid.Rollout,
    "bootstrap": jid.Bootstrap,
    "self-test": jid.SelfTest,
    "causes": Causes,
    "commissioning": Commissioning,
    "online": jid.OnlineEstimate,
}
# Why a kind is not kept in files and tables of its own.
HOLES: dict[str, str] = {
    "rollout": "simulate it again from an estimate and its logs",
    "bootstrap": "draw it again from an estimate with its seed",
    "self-test": "run it again from an estimate with its seed",
    "causes": "the estimate's findings contain the causes",
    "commissioning": "its recordings and estimates are saved",
    "online": "the next estimate replaces this estimate; you can save only the joint",
}
# A method of its own is no promise: a self-test's JSON is not read back.
_BEYOND = {("self-test", "to_json")}


@cache
def joint_estimate() -> jid.Estimate:
    return jid.identify(good()[:6.0], jid.thesis_joint(), windows=100)


def misfit() -> jid.Estimate:
    """Of a joint that the model does not fit."""
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    return jid.identify(jid.load(data_folder() / "kr300_joint1.csv.gz"), joint)


@cache
def several() -> jid.JointEstimates:
    """The second joint has no motion, and fails."""
    motion = sines(2, 1)
    run = recorded(motion, torques(motion, 1, unmodelled=1.0))
    still = np.column_stack([run.position[:, 0], np.zeros(len(run.time))])
    speed = None if run.velocity is None else np.column_stack([run.velocity[:, 0], still[:, 1]])
    found = jid.RobotRecording(
        time=run.time, position=still, velocity=speed, torque=run.torque, names=("a", "b")
    )
    return jid.identify_joints(found, windows=50)


@cache
def servo() -> jid.ServoEstimate:
    return jid.identify_servo(bench_runs(Truth(), seed=2)[:6], servo_joint())


@cache
def arm() -> tuple[jid.Robot, jid.RobotRecording]:
    pytest.importorskip("pinocchio")
    with TemporaryDirectory() as folder:
        path = small_arm.urdf(Path(folder))
        return jid.Robot.from_urdf(path), small_arm.recording(path, static=0.5, duration=3.0)


@cache
def robot_comparison() -> jid.RobotComparison:
    robot, recording = arm()
    return jid.compare_robot_models(recording, robot, inertia=["urdf", "free"], folds=2, windows=30)


def session() -> Commissioning:
    """Two runs made by hand: an emulated one takes seconds."""
    first = BenchRun(
        name="initial",
        recording=good()[:2.0],
        controller=jid.AdaptiveRobust(),
        tracking_error=2e-3,
        peak_error=3e-3,
    )
    second = replace(first, name="cycle 1", tracking_error=1e-3)
    return Commissioning(
        runs=(first, second), estimates=(joint_estimate(),), truth={"coulomb": 25.0}
    )


def online() -> jid.OnlineEstimate:
    with jid.OnlineIdentifier(jid.thesis_joint(), window=3.0) as identifier:
        return fed(identifier, good()[:4.0], 1000)


def servo_comparison() -> jid.ServoComparison:
    return jid.ServoComparison(
        models=("coulomb_viscous:load_friction=false", "coulomb_viscous:load_friction"),
        errors=np.array([[0.1, 0.2], [0.01, 0.02]]),
        bistable=np.array([[False, True], [False, False]]),
        runs=("one", "two"),
        groups=("10", "20"),
        estimate=servo(),
    )


def comparison() -> jid.Comparison:
    models = ["coulomb_viscous", "stribeck:asymmetric"]
    return jid.compare_models(good()[:6.0], jid.thesis_joint(), models=models, folds=2, windows=60)


def study() -> jid.Study:
    """With a trial that was refused: its penalty is not a number."""
    grid = {"windows": [50, 1_000_000], "model": ["coulomb_viscous"]}
    return jid.sweep(good()[:4.0], jid.thesis_joint(), grid=grid, trials=2, search="separable")


EXAMPLES: dict[str, Callable[[], Result]] = {
    "estimate": joint_estimate,
    "joints": several,
    "robot": lambda: robot_comparison().estimate,
    "servo": servo,
    "comparison": comparison,
    "robot comparison": robot_comparison,
    "servo comparison": servo_comparison,
    "design": lambda: designed(believed={"coulomb": (20.0, 30.0)}),
    "study": study,
    "rollout": lambda: jid.rollout(servo(), bench_runs(Truth(), seed=2)[:1]),
    "bootstrap": lambda: joint_estimate().bootstrap(20),
    "self-test": lambda: joint_estimate().selftest(trials=1),
    "causes": lambda: misfit().causes(),
    "commissioning": session,
    "online": online,
}
_SUBCLASS = re.compile(r"^class (\w+)\([^)]*\b(?:Kept)?Result\):", re.MULTILINE)
KEPT = [name for name in KINDS if issubclass(CLASSES[name], KeptResult)]


@cache
def example(name: str) -> Result:
    """Made once."""
    return EXAMPLES[name]()


def test_every_result_is_of_a_kind() -> None:
    assert {name: each._KIND for name, each in CLASSES.items()} == {name: name for name in KINDS}
    assert EXAMPLES.keys() == CLASSES.keys()
    texts = (path.read_text(encoding="utf-8") for path in Path(jid.__file__).parent.rglob("*.py"))
    found = {name for text in texts for name in _SUBCLASS.findall(text)}
    assert found - {"KeptResult"} == {each.__name__ for each in CLASSES.values()}


def test_the_homes_are_the_kept_kinds() -> None:
    assert [*_HOMES] == KEPT
    for name, home in _HOMES.items():
        module, _, cls = home.partition(":")
        assert getattr(import_module(module), cls) is CLASSES[name]


def has(cls: type[Result], method: str) -> bool:
    """Whether a class keeps the promise of a method: itself, or by a base that does more than to refuse."""
    if method in _KEPT and not issubclass(cls, KeptResult):
        return False
    found = next(vars(each)[method] for each in cls.__mro__ if method in vars(each))
    code = (getattr(found, "fget", None) or getattr(found, "__func__", found)).__code__
    return "NotImplementedError" not in code.co_names


def table() -> list[str]:
    """Which kinds are kept, in Markdown, as the guide shows them."""
    lines = ["| result | saved, loaded, `to_json`, `to_pandas` |", "|---|---|"]
    for name, cls in CLASSES.items():
        kept = "yes" if all(has(cls, method) for method in _KEPT) else f"no: {HOLES[name]}"
        lines.append(f"| `{cls.__name__}` | {kept} |")
    return lines


def test_every_hole_has_a_reason() -> None:
    holes = {
        name: {method for method in METHODS if not has(cls, method)}
        for name, cls in CLASSES.items()
    }
    assert {name: each for name, each in holes.items() if each} == dict.fromkeys(HOLES, _KEPT)
    own = {
        (name, method)
        for name in HOLES
        for method in _KEPT
        if any(method in vars(each) for each in CLASSES[name].__mro__ if each is not Result)
    }
    assert own == _BEYOND


def test_the_guide_has_the_table() -> None:
    text = _GUIDE.read_text(encoding="utf-8")
    assert "\n".join(table()) in text, "\n".join(table())


@pytest.mark.parametrize("name", KINDS)
def test_a_result_shows_itself(name: str) -> None:
    found = example(name)
    assert kind_of(found) == name
    assert found.report().strip()
    assert found.report(verbose=True).strip()
    assert "<" in found._repr_html_()
    document = found.to_dict()
    assert json.loads(json.dumps(document, allow_nan=False)) == document


@pytest.mark.parametrize("name", KINDS)
def test_an_overview_is_whole(name: str) -> None:
    """Each part is of its type, and says something."""
    found = example(name).overview
    assert isinstance(found, Overview)
    assert found.title
    assert found.verdict is None or isinstance(found.verdict, Verdict)
    assert found.verdict is not None or found.answer
    assert found.parameters
    assert all(isinstance(each, Quantity) and each.name for each in found.parameters)
    for each in found.parameters:
        assert each.value is None or np.isfinite(each.value)
        assert each.error is None or np.isfinite(each.error)
    for pair in (*found.fit, *found.facts, *found.settings):
        assert all(isinstance(text, str) and text for text in pair), pair
    assert all(isinstance(text, str) and text for text in found.answer)
    assert all(isinstance(each, Finding) for each in found.findings)
    for each_name, inner in found.inner.items():
        assert isinstance(each_name, str)
        assert isinstance(inner, Result)
    consists = name in ("joints", "commissioning") or "comparison" in name
    assert bool(found.inner) == consists


@pytest.mark.parametrize("name", KEPT)
def test_a_kept_result_comes_back(name: str, tmp_path: Path) -> None:
    found = example(name)
    assert isinstance(found, KeptResult)
    cls = type(found)
    text = found.to_json()
    assert json.loads(text) == found.to_dict()
    path = found.save(tmp_path / "result.json")
    assert path == tmp_path / "result.json"
    assert path.read_text(encoding="utf-8") == text
    for back in (cls.from_json(text), Result.from_json(text), cls.load(path), Result.load(path)):
        assert type(back) is cls
        assert isinstance(back, KeptResult)
        assert back.to_dict() == found.to_dict()
        assert back.report() == found.report()
        assert back.report(verbose=True) == found.report(verbose=True)
        assert back.overview.parameters == found.overview.parameters


@pytest.mark.parametrize("name", KEPT)
def test_a_kept_result_is_a_data_frame(name: str) -> None:
    pytest.importorskip("pandas")
    found = example(name)
    assert isinstance(found, KeptResult)
    frame = found.to_pandas()
    assert len(frame)
    assert frame.index.is_unique


@pytest.mark.parametrize(
    ("name", "ending"), [("design", ".toml"), ("study", ".jsonl"), ("study", ".json")]
)
def test_other_endings_come_back(name: str, ending: str, tmp_path: Path) -> None:
    found = example(name)
    assert isinstance(found, KeptResult)
    back = Result.load(found.save(tmp_path / f"result{ending}"))
    assert type(back) is type(found)
    assert back.to_dict() == found.to_dict()


def test_an_estimate_returns_the_path_of_a_joint_file(tmp_path: Path) -> None:
    path = joint_estimate().save(tmp_path / "joint.toml")
    assert jid.Joint.load(path).parameters["coulomb"].value is not None
    with pytest.raises(jid.InputError, match=r"joint\.toml: this is not a result of jointid"):
        Result.load(path)


# Files of each kind as an earlier version saved them.
_OLD = {
    "estimate.json": "estimate",
    "joints.json": "joints",
    "robot.json": "robot",
    "servo.json": "servo",
    "comparison.json": "comparison",
    "robot_comparison.json": "robot comparison",
    "design.toml": "design",
    "study.jsonl": "study",
}


def test_all_old_files_are_tried() -> None:
    assert {path.name for path in SAVED.iterdir()} == _OLD.keys()


@pytest.mark.parametrize("name", _OLD)
def test_files_from_before_are_read_and_written_alike(name: str, tmp_path: Path) -> None:
    path = SAVED / name
    found = Result.load(path)
    assert isinstance(found, KeptResult)
    assert kind_of(found) == _OLD[name]
    again = found.save(tmp_path / name)
    before, after = (each.read_text(encoding="utf-8") for each in (path, again))
    if path.suffix == ".json":
        assert json.loads(after) == found.to_dict()
        assert _unworded(json.loads(after)) == _unworded(json.loads(before))
    else:
        assert after == before
    assert found.report(verbose=True)


def _unworded(value: Any) -> Any:
    """Return a document without messages of findings and reasons of verdicts: today's words replace them."""
    if isinstance(value, dict):
        return {
            key: _unworded(each) for key, each in value.items() if key not in ("message", "reasons")
        }
    return [_unworded(each) for each in value] if isinstance(value, list) else value


def test_what_needs_the_recordings_says_so() -> None:
    names = ("joints", "comparison")
    found: list[Any] = [Result.load(SAVED / f"{name}.json") for name in names]
    robot: Any = Result.load(SAVED / "robot_comparison.json")
    for ask in (found[0]["1"].selftest, found[1].estimate.bootstrap, robot.estimate.bootstrap):
        with pytest.raises(jid.InputError, match="was read from a file"):
            ask()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[]", "not a result of jointid"),
        ('{"kind": "jointid"}', "not a result of jointid"),
        ('{"kind": "jointid self-test"}', "of the kind 'self-test' cannot be read"),
        ('{"kind": "jointid dream"}', "does not know the kind 'dream'"),
        ("{", "not JSON"),
    ],
)
def test_what_is_no_result_is_refused(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(jid.InputError, match=says):
        Result.from_json(text)
    path = tmp_path / "some.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(jid.InputError, match=rf"some\.json.*{says}"):
        Result.load(path)
    with pytest.raises(jid.InputError, match="there is no such file"):
        Result.load(tmp_path / "other.json")
    with pytest.raises(jid.InputError, match=r"read from \.json, \.toml or \.jsonl"):
        class_of_kind(tmp_path / "result.csv")


@pytest.mark.parametrize("name", KEPT)
def test_a_kind_refuses_another(name: str) -> None:
    other = "servo" if name != "servo" else "design"
    text = json.dumps(_document_of(other))
    with pytest.raises(jid.InputError):
        CLASSES[name].from_json(text)


def _document_of(name: str) -> dict[str, Any]:
    file = next(file for file, kind in _OLD.items() if kind == name)
    return Result.load(SAVED / file).to_dict()


def test_a_kind_that_is_not_kept_says_so() -> None:
    for name in HOLES:
        with pytest.raises(
            jid.InputError, match=f"of the kind '{name}' cannot be read from a file"
        ):
            CLASSES[name].from_json("{}")


def test_old_names_are_the_new_ones() -> None:
    for name, cls in CLASSES.items():
        if hasattr(cls, "document"):
            assert vars(cls)["document"] is vars(cls)["to_dict"], name
    assert example("servo").report(True) == example("servo").report(verbose=True)  # type: ignore[call-arg]
    design = example("design")
    assert isinstance(design, jid.Design)
    assert design.summary() == design.report(verbose=True)
