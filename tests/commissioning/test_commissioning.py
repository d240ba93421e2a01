"""The ring on an emulated bench: what is identified through the bus, and how far the error falls."""

import json
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

import jointid as jid
from jointid.cli.command_line import main
from jointid.commissioning import Commissioning, commission
from jointid.commissioning import cycles as ring_module
from jointid.estimate.findings import Finding
from jointid.hardware.bench.bench import Bench

EXAMPLE = Path(__file__).parents[2] / "examples" / "hardware" / "joint.toml"


def short(folder: Path, seconds: float = 3.0) -> Path:
    """The example's bench, with a motion of less than 12 s."""
    path = folder / "joint.toml"
    text = EXAMPLE.read_text(encoding="utf-8")
    assert "duration = 12.0" in text
    path.write_text(text.replace("duration = 12.0", f"duration = {seconds}"), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    return Bench.load(short(tmp_path_factory.mktemp("bench"), 6.0))


@pytest.fixture(scope="module", params=[1, pytest.param(2, marks=pytest.mark.slow)])
def ring(request: pytest.FixtureRequest, bench: Bench) -> Commissioning:
    chosen = bench if request.param == 1 else Bench.load(EXAMPLE)
    return commission(chosen, cycles=request.param, emulate=True, seed=1)


def test_the_error_falls_to_that_with_the_true_parameters(ring: Commissioning) -> None:
    assert ring.true_run is not None
    assert ring.runs[-1].tracking_error <= 1.05 * ring.true_run.tracking_error
    assert ring.improvement >= 3.0


def test_what_is_identified_is_the_emulators_truth(ring: Commissioning) -> None:
    last, brief = ring.estimates[-1], len(ring.estimates) == 1
    loose = {"stribeck": 0.05} | ({"static": 0.04} if brief else {})
    for name, value in ring.truth.items():
        within = loose.get(name, 0.02)
        assert last.parameters[name].value == pytest.approx(value, rel=within), name
    assert {each.code for each in last.warnings} <= ({"undetermined"} if brief else set())


def test_the_effect_of_ripple_is_reported(ring: Commissioning) -> None:
    assert ring.without_ripple is not None
    truth = ring.truth["static"]
    plain = abs(ring.without_ripple.parameters["static"].value / truth - 1.0)
    modelled = abs(ring.estimates[-1].parameters["static"].value / truth - 1.0)
    assert plain > 1.5 * modelled
    assert "Errors of an estimate without the sensor's ripple in the model" in ring.report()


def test_the_report_says_how_many_times_smaller_an_error_is(ring: Commissioning) -> None:
    head, _, first, second, *_ = ring.report().splitlines()
    assert head.endswith("than the first")
    assert "times" not in first
    assert second.endswith(" times smaller")
    worse = replace(ring, runs=ring.runs[::-1], true_run=None)
    assert " times larger" in worse.report()


def test_the_same_seed_gives_the_same_bits(tmp_path: Path) -> None:
    bench = Bench.load(short(tmp_path))
    first, again = (commission(bench, cycles=1, emulate=True, seed=1) for _ in range(2))
    assert again.to_dict() == first.to_dict()
    for name, recording in again.recordings().items():
        assert recording.fingerprint == first.recordings()[name].fingerprint


def test_another_seed_gives_other_bits(tmp_path: Path) -> None:
    bench = Bench.load(short(tmp_path))
    first, other = (commission(bench, cycles=0, emulate=True, seed=seed) for seed in (1, 2))
    assert other.runs[0].recording.fingerprint != first.runs[0].recording.fingerprint
    assert other.runs[0].tracking_error != first.runs[0].tracking_error


def test_a_session_is_no_simulation_but_close_to_it(ring: Commissioning) -> None:
    """The joint is moved by frames that take their time: errors differ, but by little."""
    bench = Bench.load(EXAMPLE)
    truth = bench.joint.replace(
        parameters=dict(ring.truth), model=bench.joint.model.replace(ripple=())
    )
    simulated = jid.simulate(
        truth,
        ring.runs[0].controller,
        bench.trajectory,
        control_period=bench.options.period,
        sensors=jid.Sensors(torque_noise=0.5, ripple=2.6, encoder_counts=8000),
    )
    assert simulated.reference is not None
    late = simulated.time > 2.0
    error = float(((simulated.position - simulated.reference)[late] ** 2).mean() ** 0.5)
    assert error == pytest.approx(ring.runs[0].tracking_error, rel=0.05)


def test_a_controller_that_believes_nothing_is_refused() -> None:
    bench = replace(Bench.load(EXAMPLE), controller=jid.Pd(stiffness=8000.0, damping=400.0))
    with pytest.raises(jid.InputError, match="uses no estimates"):
        commission(bench, emulate=True)


def test_the_command_writes_runs_and_saves_the_bench(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runs, saved = tmp_path / "runs", tmp_path / "found.toml"
    bench = short(tmp_path)
    words = ["run", str(bench), "--emulate", "--cycles", "1", "--output", str(runs)]
    assert main([*words, "--save", str(saved), "--json", "--quiet"]) == 0
    wording = json.loads(capsys.readouterr().out)
    assert wording["improvement"] >= 3.0
    found = Bench.load(saved)
    assert found.joint.parameters["coulomb"].value == pytest.approx(25.0, rel=0.02)
    assert "docs/hardware.md first" in saved.read_text(encoding="utf-8")
    recording = jid.load(runs / "cycle_1.csv")
    assert recording.duration == pytest.approx(3.0, abs=0.01)
    for name in ("initial.log", "cycle_1.json", "report.html", "ring.txt"):
        assert (runs / name).stat().st_size > 0
    assert main([*words, "--quiet"]) == 2
    assert "does not overwrite files" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code", "wording"),
    [
        (["--emulate", "--cycles", "-1"], 2, "--cycles -1: at least 0"),
        (["--emulate", "--save", "x.csv"], 2, "a joint file ends in .toml"),
        (["--emulate", "--output", "no/such/folder"], 2, "no/such"),
        (["--emulate", "--dry-run"], 0, ""),
        (["--cycles", "1"], 3, "--force"),
    ],
)
def test_the_command_refuses_before_it_moves(
    words: list[str], code: int, wording: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(EXAMPLE), *words]) == code
    assert wording in capsys.readouterr().err


def test_a_stop_is_exit_code_three(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "joint.toml"
    text = EXAMPLE.read_text(encoding="utf-8")
    path.write_text(
        text.replace("tracking_error = 0.1 ", "tracking_error = 0.001 "), encoding="utf-8"
    )
    output = tmp_path / "runs"
    assert main(["run", str(path), "--emulate", "--output", str(output), "--quiet"]) == 3
    wording = capsys.readouterr().err
    assert "tracking_error" in wording
    first, second, third = wording.splitlines()
    assert first.startswith("jointid run: stopped by tracking_error")
    assert (
        second == f"the drive confirmed that the motor is off; recorded: {output / 'initial.csv'}"
    )
    assert (output / "initial.csv").exists()
    assert third == f"report: {output / 'report.html'}"
    assert (output / "report.html").exists()


def test_what_was_recorded_is_kept_by_what_ends_a_commissioning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench, runs = Bench.load(short(tmp_path)), list[str]()
    monkeypatch.setattr(ring_module, "identify", lambda *_, **__: Identified(bench.joint))

    def callback(text: str) -> None:
        if text.startswith("run: "):
            runs.append(text)

    def observer(phase: str, when: float, *_: object) -> None:
        if len(runs) == 2 and phase == "run" and when > 1.0:
            raise KeyError("a bug")

    with pytest.raises(KeyError) as found:
        commission(bench, emulate=True, observer=observer, callback=callback)
    kept = vars(found.value)["recordings"]
    assert [*kept] == ["initial", "cycle 1"]
    whole, part = kept.values()
    assert whole.metadata["stop"] is None
    assert part.metadata["stopped"]["limit"] == "error"
    assert 400 < part.time.size < whole.time.size
    assert any("`recordings`" in note for note in found.value.__notes__)


@dataclass(frozen=True)
class Identified:
    """As much of an estimate as a commissioning needs to move the joint."""

    joint: jid.Joint
    findings: tuple[Finding, ...] = ()


def test_no_cycles_only_record(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bench = short(tmp_path)
    text = bench.read_text(encoding="utf-8")
    head, tail = text.split('law = "adaptive_robust"')
    gains = 'law = "pd"\nstiffness = 8000.0\ndamping = 400.0\n'
    bench.write_text(head + gains + tail[tail.index("\n[session.") :], encoding="utf-8")
    runs = tmp_path / "runs"
    words = ["run", str(bench), "--emulate", "--cycles", "0", "--quiet"]
    assert main([*words, "--output", str(runs)]) == 0
    said = capsys.readouterr().out
    assert "late or lost" in said
    assert "estimates and" not in said
    assert {each.name for each in runs.iterdir()} == {
        *("initial.csv", "initial.log", "ring.json", "ring.txt", "report.html"),
    }
    assert json.loads((runs / "ring.json").read_text())["estimates"] == []
    recording = jid.load(runs / "initial.csv")
    assert jid.identify(recording, Bench.load(bench).joint, search="separable").parameters
    assert main([*words, "--save", str(tmp_path / "found.toml")]) == 2
    assert "nothing is identified" in capsys.readouterr().err


def test_the_joint_is_not_moved_with_values_that_cannot_be_used(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bench, runs, saved = short(tmp_path), tmp_path / "runs", tmp_path / "found.toml"
    text = bench.read_text(encoding="utf-8")
    wrong = text.replace("[session.emulated] ", "[session.emulated]\nsensor_sign = -1\n# ")
    assert wrong != text
    bench.write_text(wrong, encoding="utf-8")
    words = ["run", str(bench), "--emulate", "--cycles", "1", "--output", str(runs), "--quiet"]
    assert main([*words, "--save", str(saved)]) == 3
    shown = capsys.readouterr()
    assert "fell by a factor" not in shown.out
    assert "reversed_sign is blocking" in shown.out
    (gain,) = (line for line in shown.out.splitlines() if line.startswith("sensor_gain "))
    assert "0.1 (bound)" in gain
    assert f"{saved} was not written" in shown.err
    assert not saved.exists()
    assert [each.name for each in runs.glob("*.csv")] == ["initial.csv"]
    found = commission(Bench.load(bench), cycles=2, emulate=True)
    assert [run.name for run in found.runs] == ["initial"]
    assert found.blocked is not None
    assert found.to_dict()["blocked"] == found.blocked.code == "reversed_sign"


def test_a_recording_that_nobody_keeps_is_not_made(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(EXAMPLE), "--emulate", "--cycles", "0"]) == 2
    assert "--cycles 0: with 0 cycles, the session only records" in capsys.readouterr().err


def test_json_tells_how_a_run_ended(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bench, runs = short(tmp_path), tmp_path / "runs"
    text = bench.read_text(encoding="utf-8")
    words = ["run", str(bench), "--emulate", "--json", "--quiet", "--cycles", "0"]
    assert main([*words, "--output", str(runs)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["status"], found["motor_off"]) == ("done", True)
    assert found["recording"] == [str(runs / "initial.csv")]
    assert found["timing"]["initial"]["cycles"] > 1500
    assert found["warnings"] == []
    bench.write_text(text.replace("tracking_error = 0.1 ", "tracking_error = 0.001 "), "utf-8")
    assert main([*words, "--output", str(tmp_path / "stopped")]) == 3
    found = json.loads(capsys.readouterr().out)
    assert (found["status"], found["reason"]) == ("stopped", "tracking_error")
    assert found["motor_off"] is True
    assert found["recording"] == [str(tmp_path / "stopped" / "initial.csv")]
    bench.write_text(text.replace("[session.limits]", "[session.limits]\ntorque = 50.0"), "utf-8")
    folder = tmp_path / "refused"
    assert main([*words, "--output", str(folder)]) == 3
    shown = capsys.readouterr()
    found = json.loads(shown.out)
    assert (found["status"], found["reason"]) == ("refused", "preflight")
    assert found["motor_off"] is None
    assert found["recording"] == []
    assert "PL[1]" in found["message"]
    assert shown.err.endswith("; the motor has not been on\n")
    assert not folder.exists()


def test_ctrl_c_between_two_motions_says_where_the_recording_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ring_module, "identify", interrupted)
    runs, bench = tmp_path / "runs", short(tmp_path)
    assert main(["run", str(bench), "--emulate", "--output", str(runs), "--quiet"]) == 130
    said = capsys.readouterr().err
    assert f"the drive confirmed that the motor is off; recorded: {runs / 'initial.csv'}" in said
