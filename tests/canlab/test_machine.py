"""The guest itself: what it lacks, what it says when its job fails, how its time passes, how it ends."""

from __future__ import annotations

from pathlib import Path

import pytest

from canlab import machine
from canlab.machine import REQUIRED, Guest, GuestError, missing

pytest_plugins = ["pytester"]
pytestmark = pytest.mark.slow
PATIENCE = 300.0  # [s]


def booted(folder: Path, *command: str, patience: float = PATIENCE) -> str:
    """What a command wrote in a guest."""
    Guest(folder, ("sh", "-c", *command), {"WORD": "it's"}).wait(patience)
    return (folder / "guest.txt").read_text()


def test_a_job_gets_its_environment_and_a_vcan(kernel: None, tmp_path: Path) -> None:
    said = booted(tmp_path, 'ip link add dev vcan0 type vcan && ip link show vcan0 && echo "$WORD"')
    assert "vcan0: <NOARP>" in said
    assert "it's\n" in said


def test_waiting_takes_the_guest_no_time(kernel: None, tmp_path: Path) -> None:
    """An hour by its own clock."""
    before, after = (
        float(line.split()[0])
        for line in booted(tmp_path, "cat /proc/uptime; sleep 3600; cat /proc/uptime").splitlines()
        if line[0].isdigit()
    )
    assert after - before == pytest.approx(3600.0, abs=5.0)


def test_a_failing_job_is_shown(kernel: None, tmp_path: Path) -> None:
    with pytest.raises(GuestError, match=r"(?s)the job ended with status 7.*the reason"):
        booted(tmp_path, "echo the reason; exit 7")


def test_a_guest_that_hangs_is_ended_and_shown(kernel: None, tmp_path: Path) -> None:
    with pytest.raises(GuestError, match="has not ended within 1 s"):
        booted(tmp_path, "while true; do true; done", patience=1.0)


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(machine, "_SYSTEM", "")
    monkeypatch.setenv("PATH", str(tmp_path))
    assert "no C compiler" in missing()
    for program in ("cc", "linux.uml", "insmod", "ip"):
        (tmp_path / program).touch(0o755)
    monkeypatch.setattr(machine, "_MODULES", tmp_path)
    assert "no CAN modules" in missing()
    (tmp_path / "insmod").unlink()
    assert "insmod is not installed: apt-get install user-mode-linux" in missing()


@pytest.mark.parametrize("required", [False, True])
def test_a_missing_kernel_is_skipped_unless_it_is_required(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, required: bool
) -> None:
    monkeypatch.setattr(machine, "missing", lambda: "linux.uml is not installed")
    monkeypatch.delenv(REQUIRED, raising=False)
    if required:
        monkeypatch.setenv(REQUIRED, "1")
    pytester.makeconftest(Path(__file__).with_name("conftest.py").read_text())
    pytester.makepyfile("def test_it(kernel):\n    pass\n")
    outcome = pytester.runpytest_inprocess("-rs", "-p", "no:cacheprovider")
    if required:
        outcome.assert_outcomes(errors=1)
        outcome.stdout.fnmatch_lines([f"*{REQUIRED} is set, but linux.uml is not installed*"])
    else:
        outcome.assert_outcomes(skipped=1)
        outcome.stdout.fnmatch_lines(["*linux.uml is not installed*"])
