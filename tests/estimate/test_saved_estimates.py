"""A saved estimate is read again whatever stands in it: values, one sentence, and no script in a page."""

import dataclasses
import functools
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from dealt_places import dealt

import jointid as jid
from jointid.base import html
from jointid.base.advice import Action
from jointid.cli.demonstration import data_folder
from jointid.estimate.findings import Finding
from jointid.report.renderers import html_page
from jointid.report.saving import report_page

FOLDER = Path(__file__).parent
SAVED = FOLDER / "estimate_schema_1.json"
SCRIPT = "<script>alert(1)</script>"
DEEP = "[" * 100_000 + "]" * 100_000
# By name, as it stands in the file: JSON knows no 1e400 and no NaN, Python's reader does.
JUNK = {
    "script": json.dumps(SCRIPT),
    "null": "null",
    "table": "{}",
    "list": "[]",
    "huge": "1e400",
    "nan": "NaN",
    "deep": DEEP,
    "many digits": "1" * 5000,
    "half a letter": '"\\ud800"',
    "negative": "-1",
    "large": "1e99",
    "tiny": "1e-250",
}
NEVER = ("huge", "nan", "deep", "many digits", "half a letter")
Path_ = tuple[str | int, ...]


@functools.cache
def text_of(schema: int) -> str:
    """An estimate as this code saves it, and those saved by code with an older schema."""
    if schema < 3:
        return (FOLDER / f"estimate_schema_{schema}.json").read_text(encoding="utf-8")
    run = jid.load(data_folder() / "kr300_joint1.csv.gz")
    joint = jid.Joint.load(data_folder() / "kr300_joint1.toml")
    ga = jid.GaOptions(population=20, generations=3)
    return jid.identify(
        run, joint, model="stribeck", windows=12, search=jid.Search(ga=ga)
    ).to_json()


def document(schema: int = 3) -> dict[str, Any]:
    return dict(json.loads(text_of(schema)))


def paths(value: Any, here: Path_ = ()) -> Iterator[Path_]:
    """Every place of a document: tables, lists and what they hold; of a long list of numbers, three."""
    yield here
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from paths(inner, (*here, key))
    elif isinstance(value, list):
        numbers = len(value) > 4 and all(isinstance(inner, float | int) for inner in value)
        for i in (0, len(value) // 2, len(value) - 1) if numbers else range(len(value)):
            yield from paths(value[i], (*here, i))


def damaged(path: Path_, junk: str, schema: int = 3) -> str:
    """The saved estimate with one place set to this JSON text."""
    changed: Any = {"all": document(schema)}
    inner = changed
    for key in ("all", *path)[:-1]:
        inner = inner[key]
    inner[("all", *path)[-1]] = "JUNK"
    return json.dumps(changed["all"]).replace('"JUNK"', junk)


def renamed(path: Path_, name: str) -> str:
    """The saved estimate with one key replaced."""
    changed = document()
    inner: Any = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[name] = inner.pop(path[-1])
    return json.dumps(changed)


def read(text: str) -> jid.Estimate | None:
    """The estimate, or None when one sentence refused it."""
    try:
        return jid.Estimate.from_json(text)
    except jid.InputError as error:
        sentence = str(error)
        assert "\n" not in sentence
        assert 10 < len(sentence) < 600, sentence
        return None


def pages(estimate: jid.Estimate) -> list[str]:
    estimate.report(verbose=True)
    return [report_page(estimate), estimate._repr_html_()]


@pytest.fixture
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures have tests of their own below, and take most of the time."""
    monkeypatch.setattr(html_page, "drawn", lambda *_: html.element("p"))


@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize("schema", [1, 2, 3])
@pytest.mark.parametrize("junk", JUNK)
def test_every_place_of_a_saved_estimate(
    junk: str, schema: int, every: bool, no_pictures: None
) -> None:
    accepted = 0
    places = list(paths(document(schema)))
    for path in places if every else dealt(places, [*JUNK].index(junk), len(JUNK)):
        estimate = read(damaged(path, JUNK[junk], schema))
        if estimate is not None:
            accepted += 1
            for page in pages(estimate):
                assert "<script" not in page.lower(), path
    assert accepted == 0 if junk in NEVER else accepted or not every


def test_every_key_of_a_saved_estimate(no_pictures: None) -> None:
    for path in paths(document()):
        if path and isinstance(path[-1], str):
            for page in pages(found) if (found := read(renamed(path, SCRIPT))) else ():
                assert "<script" not in page.lower(), path


def test_a_script_reaches_the_page_where_nothing_escapes(
    no_pictures: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the tests above look for would be found."""
    monkeypatch.setattr(html, "escape", lambda text: text)
    for path in (("joint", "name"), ("settings", "version"), ("findings", 0, "title")):
        estimate = read(damaged(path, JUNK["script"]))
        assert estimate is not None
        assert any("<script>" in page for page in pages(estimate)), path


@pytest.mark.filterwarnings("ignore:.*(overflow|invalid value):RuntimeWarning")
@pytest.mark.parametrize("junk", ["null", "table", "list", "negative", "large", "script"])
def test_whole_pages_of_what_was_accepted(junk: str) -> None:
    """Every picture is drawn, too, from the places that pictures are drawn from."""
    drawn = ("convergence", "covariance", "settings", "windows")
    most = 12 if junk in ("negative", "large") else 2  # else hardly any number is accepted
    seen: set[tuple[str, ...]] = set()
    for path in paths(document()):
        kind: tuple[str, ...] = tuple("0" if isinstance(key, int) else key for key in path)
        if path and path[0] in drawn and kind not in seen and len(seen) < most:
            estimate = read(damaged(path, JUNK[junk]))
            if estimate is not None:
                seen.add(kind)
                assert all("<script" not in page for page in pages(estimate))


def test_the_path_is_named() -> None:
    places: dict[tuple[str | int, ...], str] = {
        ("parameters", "coulomb", "value"): r"^parameters\.coulomb\.value: this is None: a number",
        ("windows", "start", 3): r"^windows\.start\[3\]: ",
        ("settings", "seed"): r"^settings\.seed: ",
        ("joint", "drive", "gear_ratio"): r"^joint: \[drive\]: gear_ratio",
    }
    for path, named in places.items():
        with pytest.raises(jid.InputError, match=named):
            jid.Estimate.from_json(damaged(path, "null"))


@pytest.mark.parametrize(
    ("path", "junk", "reason"),
    [
        (("free", 0), '"coulomb"', "has it twice"),
        (("free", 0), '"current"', "this is not a parameter"),
        (("settings", "terms", 0), '"ripple_cos_2"', "this term is unknown, or its"),
        (("settings", "terms", 0), '"friction"', "this term is unknown, or its"),
        (("parameters", "coulomb", "name"), '"static"', "differs from the key"),
        (("covariance",), "[[1.0]]", "4 rows of 4"),
        (("covariance", 1), "[1.0]", "4 rows of 4"),
        (("windows", "start"), "[1.0]", "same length"),
        (("convergence", "best"), "[1.0]", "same length"),
        (("windows", "recording", 0), "1", "no recording with this number"),
        (("findings", 0, "advice", 0, "kind"), '"shout"', "choose one of call, record, inspect"),
        (("findings", 0, "advice", 0, "arguments"), "{}", "a call needs arguments"),
        (("findings", 0, "severity"), '"mild"', "choose one of info, warning, blocking"),
    ],
)
def test_fields_that_contradict_each_other(path: Path_, junk: str, reason: str) -> None:
    with pytest.raises(jid.InputError, match=reason):
        jid.Estimate.from_json(damaged(path, junk))


def test_the_information_is_saved() -> None:
    estimate = jid.Estimate.from_json(text_of(3))
    assert estimate.information is not None
    product = estimate.information @ estimate.covariance
    assert abs(product - np.eye(len(estimate.free))).max() < 1e-9
    changed = json.dumps(document() | {"information": [[1.0]]})
    with pytest.raises(jid.InputError, match=r"information: \d rows of"):
        jid.Estimate.from_json(changed)


def test_an_estimate_saved_before_is_still_read() -> None:
    estimate = jid.Estimate.from_json(SAVED.read_text(encoding="utf-8"))
    assert estimate.parameters["inertia"].value == 2027.8341819264738
    assert math.isinf(jid.Estimate.from_json(damaged(("condition",), '"inf"')).condition)
    assert [warning.code for warning in estimate.warnings] == [
        *("signal_lag", "model_too_rich", "undetermined", "few_windows"),
    ]
    assert "leave the column out" in estimate.report(verbose=True)
    assert jid.Estimate.from_json(estimate.to_json()).report(verbose=True) == estimate.report(
        verbose=True
    )


def test_no_control_character_reaches_a_terminal() -> None:
    estimate = read(damaged(("joint", "name"), '"a\\u001b[2Jb\\rc\\u009b"'))
    assert estimate is not None
    assert estimate.report(verbose=True).startswith("jointid estimate — a\ufffd[2Jb\ufffdc\ufffd\n")


def test_a_file_is_read_and_named(tmp_path: Path) -> None:
    assert jid.Estimate.load(SAVED).joint.gear_ratio == 256.86
    path = tmp_path / "bad.json"
    path.write_text(damaged(("penalty",), "true"))
    with pytest.raises(jid.InputError, match=r"bad\.json: penalty: this is True"):
        jid.Estimate.load(path)
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(jid.InputError, match="not text in UTF-8"):
        jid.Estimate.load(path)
    with pytest.raises(jid.InputError, match="there is no such file"):
        jid.Estimate.load(tmp_path / "none.json")


def test_what_a_finding_may_hold_is_read_again() -> None:
    estimate = jid.Estimate.from_json(text_of(3))
    unknown = {"columns": {"sensor": ...}, "models": ["stribeck", ...]}
    found = Finding(
        code="undetermined", title="x" * 50_000, advice=(Action("call", unknown, function="load"),)
    )
    again = jid.Estimate.from_json(dataclasses.replace(estimate, findings=(found,)).to_json())
    assert again.findings == (found,)


@pytest.mark.parametrize("order", ["9" * 400, "1_0", "9" * 5000])
def test_a_saved_model_with_an_order_that_is_no_number(order: str) -> None:
    record = document()
    record["settings"]["model"] = f"stribeck:ripple={order}"
    assert read(json.dumps(record)) is None
