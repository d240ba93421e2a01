"""`jointid new`: a joint file from options, a recording, and answers at a terminal."""

import json
import os
import pty
import select
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from command_line_answers import answer
from example_recordings import WELL_EXCITED as WELL
from plain_joint import motion

import jointid as jid
from jointid.cli.command_line import main
from jointid.joint.new_file import FACTS


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_what_is_not_known_is_a_comment_that_says_what_to_put_there(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["new", "elbow.toml", "--no-questions"]) == 0
    assert jid.Joint.load("elbow.toml") == jid.Joint(name="elbow")
    text = Path("elbow.toml").read_text(encoding="utf-8")
    for fact in FACTS:
        assert f"# {fact.key} = {fact.example}  # {fact.meaning}" in text
    assert "next: jointid identify run.csv --joint elbow.toml" in capsys.readouterr().out


def test_every_commented_line_can_be_used() -> None:
    """Taking all marks away gives a joint file, with the example of each fact."""
    assert main(["new", "elbow.toml", "--no-questions"]) == 0
    lines = Path("elbow.toml").read_text(encoding="utf-8").splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("schema"))
    plain = "\n".join(line.removeprefix("# ") for line in lines[head:])
    Path("full.toml").write_text(plain, encoding="utf-8")
    joint = jid.Joint.load("full.toml")
    assert (joint.gear_ratio, joint.sensor, joint.torque_hold) == (101.0, True, "zoh")
    assert joint.link is not None
    assert {fact.key for fact in FACTS if fact.table == "limits"} == set(
        tomllib.loads(plain)["limits"]
    )


def test_options_are_lines() -> None:
    line = "new a.toml --no-questions --name arm --gear-ratio -48 --rotor-inertia 2e-4 --mass 2"
    line += " --centre-of-mass 0.3 --link-angle -90deg --position -60deg,60deg --torque 30"
    assert main(shlex.split(line)) == 0
    joint = jid.Joint.load("a.toml")
    assert (joint.name, joint.gear_ratio, joint.rotor_inertia) == ("arm", -48.0, 2e-4)
    assert joint.link == jid.Link(mass=2.0, centre_of_mass=0.3, angle=-np.pi / 2)
    assert joint.model.gravity == "known"
    assert joint.limits == jid.Limits(position=(-np.pi / 3, np.pi / 3), torque=30.0)


def test_nothing_is_overwritten(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.toml").write_text("mine", encoding="utf-8")
    code, sentence = answer(["new", "a.toml"], capsys)
    assert code == 2
    assert "a.toml: the file exists and is not overwritten" in sentence
    assert Path("a.toml").read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ("--gear-ratio 0", "--gear-ratio 0"),
        ("--mass 2", "--centre-of-mass"),
        ("--mass -2 --centre-of-mass 1", "--mass -2"),
        ("--position 1", "--position 1"),
        ("--position 2,1", "--position"),
        ("--inertia much", "--inertia much"),
        ("--kind bent", "--kind bent"),
        ("--torque -1", "--torque -1"),
        ("nothing.csv", "nothing.csv"),
    ],
)
def test_bad_facts_name_the_option(
    options: str, says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, sentence = answer(["new", "a.toml", "--no-questions", *options.split()], capsys)
    assert (code, Path("a.toml").exists()) == (2, False)
    assert says in sentence


def test_a_recording_shows_kind_and_sensor() -> None:
    assert main(["new", "a.toml", str(WELL), "--no-questions"]) == 0
    assert jid.Joint.load("a.toml").sensor
    Path("slide.csv").write_text(
        "time_s,position_m,force_N\n" + "".join(f"{k / 100},{k % 7},1\n" for k in range(50)),
        encoding="utf-8",
    )
    assert main(["new", "b.toml", "slide.csv", "--no-questions"]) == 0
    assert jid.Joint.load("b.toml").kind == "prismatic"
    assert "rad/s" not in Path("b.toml").read_text(encoding="utf-8").partition("schema")[2]


def test_columns_and_units_are_proposed(capsys: pytest.CaptureFixture[str]) -> None:
    """What is proposed is in the command that is printed, and that command gives the estimate."""
    run = jid.load(WELL)
    table = [run.time, np.degrees(run.position), run.velocity * 30 / np.pi, run.torque]
    np.savetxt(
        "log.csv",
        np.column_stack(table),  # type: ignore[arg-type]
        delimiter=",",
        header="t,enc1,speed,drive_trq",
        comments="",
    )
    assert main(["new", "a.toml", "log.csv", "--no-questions"]) == 0
    said = capsys.readouterr().out
    command = shlex.split(said.rpartition("next: ")[2])
    assert "position=enc1" in command
    assert command[0] == "jointid"
    assert {"position=deg", "velocity=rpm"} <= set(command)
    assert f"# {shlex.join(command)}" in Path("a.toml").read_text(encoding="utf-8")
    assert main([*command[1:], "--quiet", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["parameters"]
    assert found["coulomb"]["value"] == pytest.approx(25.0, rel=0.2)


def test_the_next_command_reads_as_this_one_did(capsys: pytest.CaptureFixture[str]) -> None:
    _, angle, speed, rise = motion(4.0)
    rows = np.column_stack([angle, 50.0 * speed, rise + 3.0 * np.sign(speed) + speed])
    np.savetxt("a.csv", rows, delimiter=",", header="angle_rad,speed_rad_s,torque_Nm", comments="")
    options = ["--rate", "200", "--side", "velocity=motor", "--drop-invalid"]
    assert main(["new", "a.toml", "a.csv", "--no-questions", "--gear-ratio", "50", *options]) == 0
    said = capsys.readouterr().out.rpartition("next: ")[2].strip()
    assert said == (
        "jointid identify a.csv --joint a.toml --side velocity=motor --rate 200 --drop-invalid"
    )
    assert main(shlex.split(said)[1:]) == 0
    assert "velocity_mismatch" not in capsys.readouterr().out


def test_it_asks_at_a_terminal() -> None:
    """A wrong answer is said and asked again; Enter leaves a fact out."""
    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "jointid", "new", "asked.toml"]
    with subprocess.Popen(command, stdin=follower, stdout=follower, stderr=follower) as child:
        os.close(follower)
        said = ""
        answers = {
            "gear ratio": "0",
            "gear ratio again": "101",
            "torque constant": "",
            "rotor inertia": "2.5e-4",
            "position": "-60deg,60deg",
            "velocity": "",
            "torque (": "100",
        }
        for asked, given in answers.items():
            while f"{asked.removesuffix(' again')}" not in said.rpartition("\n")[
                2
            ] or not said.endswith(": "):
                assert select.select([leader], [], [], 60)[0], said
                said += os.read(leader, 4096).decode()
            said = ""
            os.write(leader, f"{given}\n".encode())
        assert child.wait(60) == 0
    os.close(leader)
    joint = jid.Joint.load("asked.toml")
    assert (joint.gear_ratio, joint.rotor_inertia, joint.torque_constant) == (101.0, 2.5e-4, None)
    assert joint.limits == jid.Limits(position=(-np.pi / 3, np.pi / 3), torque=100.0)


def test_the_next_command_reads_the_recording_as_this_one(
    capsys: pytest.CaptureFixture[str],
) -> None:
    run = jid.load(WELL)
    columns = np.column_stack([run.position, 50.0 * run.velocity, run.torque])  # type: ignore[list-item]
    header = "position_rad,velocity_rad_s,torque_Nm"
    np.savetxt("log.csv", columns, delimiter=",", header=header, comments="")
    reading = f"--rate {1.0 / run.sample_period:.15g} --side velocity=motor --side torque=joint"
    assert (
        main(["new", "a.toml", "log.csv", *f"--gear-ratio 50 --no-questions {reading}".split()])
        == 0
    )
    following = capsys.readouterr().out.partition("next: jointid ")[2]
    assert main(shlex.split(following)) == 0
    assert "velocity_mismatch" not in capsys.readouterr().out
