"""One description of a model gets the same verdict, argument, value and reason from every face that takes one."""

from __future__ import annotations

import contextlib
import io
import json
import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomlkit

import jointid as jid
from jointid.cli import main
from jointid.cli.wording import Wording
from jointid.joint.joint_file import joint_document, joint_from_document

COUNT = 200

Verdict = tuple[str, str, str] | None
"""Argument, value and reason of a refusal; None where the description is accepted."""

_ORDERS = [
    *([], [1], [2], [0.5, 2], [3, 4], [1, 2.5, 4]),
    *([0], [-2], [10**400], ["1_0"], [2, 2], [2.0000001], ["two"], [True], [1e-9]),
    *(2, "2", {"2": 1}),
]
VALUES: dict[str, list[Any]] = {
    "name": [
        *("coulomb_viscous", "stribeck", "stribeck_general"),
        *("strybeck", "", "Stribeck", 5, True),
    ],
    "gravity": ["none", "none", "free", "known", "up", 9.81, False, ""],
    "asymmetric": [True, False, True, False, "no", 1, 0.0, [], "yes please"],
    "ripple": _ORDERS,
    "harmonics": _ORDERS,
    "load_friction": [True, False, True, False, "no", 1, 0.0, [], "yes please"],
    "per_recording": [
        *([], ["torque_offset"], ["viscous"], ["coulomb", "viscous"]),
        *(["nonsense"], ["stribeck"], ["coulomb", "coulomb"], [3], ["coulomb[1]"]),
        "torque_offset",
    ],
}


def described() -> list[dict[str, Any]]:
    """The table: some values of some fields, the same at every run."""
    drawn = random.Random(1)
    found: dict[str, dict[str, Any]] = {}
    while len(found) < COUNT:
        fields = [name for name in VALUES if drawn.random() < 0.4]
        description = {name: drawn.choice(VALUES[name]) for name in fields}
        found[repr(description)] = description
    return list(found.values())


TABLE = described()
# All that a model may refer to.
KNOWN = jid.Joint(gear_ratio=50.0, link=jid.Link(mass=1.0, centre_of_mass=0.1))
# Arguments that each call is refused for beside the description: those that are wrong here on purpose; a compared
# model without a name; on line, two shapes and several recordings' coefficients.
ELSEWHERE = {
    "identify": {"windows", "per_recording"},
    "compare": {"folds", "models"},
    "sweep": {"trials"},
    "sweep grid": {"trials"},
    "on line": {"", "callback", "model", "per_recording", "load_friction"},
    "joint": set(),
}


@pytest.fixture(scope="module")
def recording() -> jid.Recording:
    time = np.arange(0.0, 4.0, 2e-3)
    position = np.sin(2.3 * time) + 0.3 * np.sin(5.1 * time)
    velocity = 2.3 * np.cos(2.3 * time) + 1.53 * np.cos(5.1 * time)
    noise = np.random.default_rng(2).normal(0.0, 0.05, time.size)
    torque = 3.0 * np.sign(velocity) + 5.0 * velocity + noise
    return jid.Recording(time=time, position=position, torque=torque)


@pytest.fixture(scope="module")
def csv(recording: jid.Recording, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("model") / "run.csv"
    recording.save(path)
    return path


def verdict(call: Callable[[], object]) -> Verdict:
    """What a face says of a description itself."""
    try:
        call()
    except jid.InputError as error:
        return error.argument, repr(error.value), error.reason
    return None


def text_of(description: dict[str, Any]) -> str | None:
    """The description as text, where text can say it."""
    parts = [description.get("name", "")]
    if not isinstance(parts[0], str) or not re.fullmatch(r"\w*", parts[0]):
        return None
    if "name" in description and not parts[0]:
        return None
    for key, value in description.items():
        if key == "name":
            continue
        word = _word(key, value)
        if word is None:
            return None
        parts.append(f"{key}={word}")
    return ":".join(parts)


def _word(key: str, value: Any) -> str | None:
    if key in ("ripple", "harmonics", "per_recording"):
        if not isinstance(value, list):
            return None
        words = [_word("", entry) for entry in value]
        if any(word is None or isinstance(v, bool) for word, v in zip(words, value, strict=True)):
            return None
        # A text of digits is a number, and a coefficient is text.
        if any(isinstance(v, str) == (key != "per_recording") for v in value) and value not in (
            ["two"],
            ["1_0"],
        ):
            return None
        return ",".join(map(str, words)) or "none"
    if key == "gravity" and not isinstance(value, str):
        return None
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    return value if isinstance(value, str) and re.fullmatch(r"[\w ]+", value) else None


def expected() -> Iterator[tuple[dict[str, Any], Verdict]]:
    for description in TABLE:
        yield description, verdict(lambda d=description: jid.Model(**d))  # type: ignore[misc]


def test_the_table_has_both_kinds_and_every_field() -> None:
    verdicts = [found for _, found in expected()]
    assert len(TABLE) == COUNT
    assert 25 <= sum(found is None for found in verdicts) <= COUNT - 100
    refused = {found[0] for found in verdicts if found is not None}
    orders = [description.get("ripple") for description in TABLE]
    assert [10**400] in orders
    assert ["1_0"] in orders
    # Own terms need extra signals: test_terms_of_model.py and test_cli_own_terms.py have theirs.
    assert refused == set(jid.Model("stribeck").resolved.__dataclass_fields__) - {"terms"}


def test_python_calls_agree(recording: jid.Recording) -> None:
    """identify, compare, sweep, the on-line identifier and a joint, with the description as a mapping."""

    def refuse(*_: object, **__: object) -> object:
        raise AssertionError("the model is checked before anything is computed")

    for description, wanted in expected():
        faces: dict[str, Callable[[Any], object]] = {
            "identify": lambda d: jid.identify(recording, KNOWN, model=d, windows=refuse),  # type: ignore[call-overload]
            "compare": lambda d: jid.compare_models(recording, KNOWN, models=[d], folds=0),
            "sweep": lambda d: jid.sweep(recording, KNOWN, model=d, trials=0),
            "sweep grid": lambda d: jid.sweep(recording, KNOWN, grid={"model": {"a": d}}, trials=0),
            "on line": lambda d: jid.OnlineIdentifier(KNOWN, model=d, callback=refuse).close(),
            "joint": lambda d: KNOWN.replace(model=d),
        }
        for face, call in faces.items():
            found = verdict(lambda c=call, d=description: c(d))  # type: ignore[misc]
            if wanted is None:  # what is wrong then is not the description by itself
                assert found is None or found[0] in ELSEWHERE[face], (face, found)
                assert face not in ("compare", "sweep", "sweep grid") or found is not None
            else:
                assert found == wanted, (face, description)


def test_text_agrees() -> None:
    said = 0
    for description, wanted in expected():
        text = text_of(description)
        if text is None:
            continue
        said += 1
        assert verdict(lambda t=text: jid.Model.parse(t)) == wanted, text  # type: ignore[misc]
    assert said > 60


def test_a_joint_file_agrees(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    for key in ("name", "friction"):
        for description, wanted in expected():
            table = {key if name == "name" else name: v for name, v in description.items()}
            link = {"mass": 1.0, "centre_of_mass": 0.1}
            path.write_text(tomlkit.dumps({"schema": 2, "model": table, "link": link}))
            found = verdict(lambda: jid.Joint.load(path))
            assert found == wanted, (key, description)


def test_json_agrees() -> None:
    document = joint_document(jid.Joint(link=jid.Link(mass=1.0, centre_of_mass=0.1)))
    for description, wanted in expected():
        read = json.loads(json.dumps(document | {"model": description}))
        assert verdict(lambda r=read: joint_from_document(r, "x", jid.Joint)) == wanted, description  # type: ignore[misc]


def test_a_saved_estimate_agrees(recording: jid.Recording) -> None:
    saved = json.loads(jid.identify(recording, search="separable").to_json())
    said = 0
    for description, wanted in expected():
        text = text_of(description)
        if text is None:
            continue
        said += 1
        saved["settings"]["model"] = text
        read = json.dumps(saved)
        assert verdict(lambda r=read: jid.Estimate.from_json(r)) == wanted, text  # type: ignore[misc]
    assert said > 60


def test_the_command_line_agrees(csv: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same refusal reaches the shell, whose wording is its own."""
    monkeypatch.chdir(csv.parent)
    refused: list[jid.InputError] = []
    word = Wording.of_error

    def recorded(self: Wording, error: jid.InputError) -> str:
        refused.append(error)
        return word(self, error)

    monkeypatch.setattr(Wording, "of_error", recorded)
    seen = 0
    for description, wanted in expected():
        text = text_of(description)
        if text is None or wanted is None:
            continue
        seen += 1
        for command in ("identify", "compare"):
            errors = io.StringIO()
            with contextlib.redirect_stderr(errors), contextlib.redirect_stdout(io.StringIO()):
                assert main([command, "run.csv", "--model", text, "--quiet"]) == 2, text
            assert errors.getvalue().count("\n") == 1, errors.getvalue()
            error = refused.pop()
            assert (error.argument, repr(error.value), error.reason) == wanted, text
    assert seen > 30


@pytest.mark.parametrize(
    "text",
    [
        "coulomb_viscous",
        "stribeck:asymmetric",
        "coulomb_viscous:harmonics=2,4",
        "coulomb_viscous:load_friction=false:per_recording=none",
        ":gravity=free",
    ],
)
def test_the_command_line_accepts(text: str, csv: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(csv.parent)
    arguments = ["identify", "run.csv", "--model", text, "--quiet", "--method", "separable"]
    with contextlib.redirect_stdout(io.StringIO()):
        assert main(arguments) == 0
