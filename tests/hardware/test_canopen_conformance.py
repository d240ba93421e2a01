"""The emulated node passes what an independent CANopen client asks; a node that is broken does not."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import canopen_conformance as conformance

from jointid.hardware.elmo.emulated_objects import ElmoObjects
from jointid.hardware.emulated import object_dictionary, pdo, sdo_server
from jointid.hardware.emulated.emergencies import Emergencies

# An abort leaves the client's stream open, and its finaliser asks once more. Python 3.13 reports what that raises.
pytestmark = pytest.mark.filterwarnings(
    "ignore:.*WritableStream:pytest.PytestUnraisableExceptionWarning"
)


def lines(capsys: pytest.CaptureFixture[str]) -> list[str]:
    return capsys.readouterr().out.splitlines()


def test_the_emulated_node_conforms(capsys: pytest.CaptureFixture[str]) -> None:
    code = conformance.main(["--emulate"])
    said = lines(capsys)
    assert code == 0, [line for line in said if not line.startswith("ok")]
    total = len(said) - 1
    assert said[-1] == f"{total} of {total} checks passed"
    assert total > 80


Breakage = Callable[[pytest.MonkeyPatch], None]


def any_size(patch: pytest.MonkeyPatch) -> None:
    strict = object_dictionary.ObjectDictionary.write

    def write(self: Any, index: int, subindex: int, given: bytes) -> None:
        try:
            strict(self, index, subindex, given)
        except object_dictionary.AccessError as error:
            if error.code not in (object_dictionary.TOO_LONG, object_dictionary.TOO_SHORT):
                raise

    patch.setattr(object_dictionary.ObjectDictionary, "write", write)


def silent_recovery(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(Emergencies, "vanish", lambda self: setattr(self, "register", 0))


def free_mapping(patch: pytest.MonkeyPatch) -> None:
    def place(self: Any, at: int, value: int) -> None:
        self._mapped[at] = value

    patch.setattr(pdo.Pdo, "_set_place", place)


def no_toggle(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(sdo_server.SdoServer, "_check_toggle", lambda *_: None)


def every_emergency_is_kept_back(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(ElmoObjects, "emergency_wanted", lambda *_: False)


@pytest.mark.parametrize(
    ("break_it", "failing"),
    [
        (any_size, "abort: too long"),
        (silent_recovery, "emergency 0000h when it is back"),
        (free_mapping, "mapping refuses what cannot be mapped"),
        (no_toggle, "wrong toggle"),
        (every_emergency_is_kept_back, "emergency 8130h"),
    ],
)
def test_a_broken_node_does_not(
    break_it: Breakage,
    failing: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(conformance, "PATIENCE", 0.5)
    break_it(monkeypatch)
    assert conformance.main(["--emulate"]) == 1
    failed = [line for line in lines(capsys) if line.startswith("FAILED")]
    assert any(line.startswith(f"FAILED {failing}:") for line in failed), failed
