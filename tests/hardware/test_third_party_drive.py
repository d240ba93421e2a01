"""A drive of a package of its own, found by its entry point: run from the command line, recorded, replayed."""

import inspect
import json
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import jointid as jid

PACKAGE = Path(__file__).parents[1] / "third_party_drive"
JOINT = """
schema = 1
name = "acme bench"
[drive]
rotor_inertia = 2.5e-4
gear_ratio = 100
torque_hold = "zoh"
[model]
friction = "coulomb_viscous"
gravity = "none"
[parameters]
coulomb = { value = 10.0, min = 0.0, max = 50.0 }
viscous = { value = 10.0, min = 0.0, max = 40.0 }
[limits]
position = [-1.4, 1.4]
velocity = 4.0
torque = 160.0
[session.drive]
type = "acme"
counts = 800000
[session.trajectory]
amplitude = "60deg"
cycle = 3.0
duration = 6.0
[session.controller]
law = "adaptive_robust"
friction_velocity = "reference"
[session.emulated.truth]
coulomb = 25.0
viscous = 20.0
"""


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder that holds what an installation of the package leaves; both are on the path."""
    project = tomllib.loads((PACKAGE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    site = tmp_path / "site"
    about = site / "acme_drive-1.0.dist-info"
    about.mkdir(parents=True)
    name, version = project["name"], project["version"]
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [
        f"[{group}]\n" + "".join(f"{key} = {value}\n" for key, value in entries.items())
        for group, entries in project["entry-points"].items()
    ]
    (about / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(PACKAGE))
    monkeypatch.syspath_prepend(str(site))
    yield site
    sys.modules.pop("acme_drive", None)


def jointid_run(site: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """`jointid run` in a process of its own."""
    path = os.pathsep.join((str(site), str(PACKAGE), *filter(None, sys.path)))
    return subprocess.run(
        [sys.executable, "-m", "jointid", "run", "joint.toml", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        timeout=300.0,
    )


def test_it_runs_is_recorded_and_replayed(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "joint.toml").write_text(JOINT, encoding="utf-8")
    done = jointid_run(
        installed,
        tmp_path,
        *("--emulate", "--cycles", "1", "--output", "runs", "--json", "--quiet"),
    )
    assert done.returncode == 0, done.stderr
    outcome = json.loads(done.stdout)
    assert outcome["estimates"][0]["coulomb"] == pytest.approx(25.0, rel=0.02)
    assert outcome["estimates"][0]["viscous"] == pytest.approx(20.0, rel=0.02)
    assert outcome["improvement"] > 2.0

    recording = jid.load(tmp_path / "runs" / "initial.csv")
    assert recording.metadata["drive_type"] == "acme"
    assert recording.metadata["drive_options"]["counts"] == 800_000
    assert recording.metadata["options"]["resolution"] == 2.0 * np.pi / 800_000
    assert recording.metadata["motor_off"] is True
    joint = jid.Joint.load(tmp_path / "joint.toml")
    again = jid.hardware.replay(tmp_path / "runs" / "initial.log", joint)
    assert recording.torque is not None
    assert again.torque is not None
    assert np.allclose(again.position, recording.position, rtol=0.0, atol=1e-12)
    assert np.allclose(again.time, recording.time, rtol=0.0, atol=3e-9)
    assert np.allclose(again.torque, recording.torque, rtol=0.0, atol=1e-3)
    assert np.array_equal(again.reference, recording.reference)  # type: ignore[arg-type]


def test_its_options_are_checked_with_their_place(installed: Path, tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    for before, after, argument, reason in (
        ("counts = 800000", "counts = 0", "counts", "at least 1 is expected"),
        ("counts = 800000", "count = 8", "count", "unknown key; did you mean 'counts'?"),
        ("counts = 800000\n", 'counts = "many"\n', "counts", "a whole number is expected"),
    ):
        path.write_text(JOINT.replace(before, after), encoding="utf-8")
        with pytest.raises(jid.InputError) as refused:
            jid.hardware.Bench.load(path)
        error = refused.value
        assert (error.argument, error.reason) == (argument, reason)
        assert error.place == f"{path}: [session.drive]"


def test_what_it_does_not_emulate_is_said(installed: Path, tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(JOINT, encoding="utf-8")
    bench = jid.hardware.Bench.load(path)
    assert "/dev/ttyACM0" in bench.address
    with pytest.raises(jid.InputError, match="cannot emulate this type of drive on a CAN bus"):
        jid.hardware.emulated_devices(bench)
    path.write_text(
        JOINT.replace(
            "[session.emulated.truth]",
            "[session.emulated]\nidle_loop = 0.1\n[session.emulated.truth]",
        ),
        encoding="utf-8",
    )
    with pytest.raises(jid.InputError, match=r"\[session.emulated\]: idle_loop: unknown key"):
        jid.hardware.Bench.load(path)
    port = "port is '/dev/ttyACM0': there is no drive"
    with pytest.raises(jid.InputError, match=port), jid.hardware.open_drive(bench):
        pass


def test_it_needs_public_names_alone(repo: Path) -> None:
    texts = [(PACKAGE / "acme_drive.py").read_text(encoding="utf-8")]
    page = (repo / "docs" / "hardware.md").read_text(encoding="utf-8")
    texts.append(page.partition("\n## Writing your own drive")[2])
    for text in texts:
        assert "from jointid.hardware import " in text
        assert not re.search(r"(from|import) jointid\.(?!hardware import )", text)


def test_the_types_in_the_signatures_of_a_drive_type_are_public() -> None:
    written = [
        annotation
        for _, method in inspect.getmembers(jid.hardware.DriveType, inspect.isfunction)
        for annotation in method.__annotations__.values()
    ]
    named = {*re.findall(r"[A-Z]\w+", " ".join(written)), "Clock"}
    named -= {"AbstractContextManager", "Any", "Iterable", "Mapping", "Sequence"}
    assert {"Table", "Bench"} <= named
    # An emulated device is one on our own emulated bus.
    assert named - {"Device"} <= {*jid.hardware.__all__, *jid.__all__}


def test_it_is_short() -> None:
    code = (PACKAGE / "acme_drive.py").read_text(encoding="utf-8").splitlines()
    assert len(code) + len((PACKAGE / "pyproject.toml").read_text().splitlines()) <= 200
