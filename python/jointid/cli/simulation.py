"""Command `simulate`."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from jointid.cli.arguments import whole_seed
from jointid.cli.outputs import check_recording_file
from jointid.cli.scenario import scenario_arguments, scenario_of


def add_simulate(simulate: argparse.ArgumentParser) -> None:
    """Add the command's grammar."""
    simulate.epilog = (
        "examples:\n"
        "  jointid simulate joint.toml --trajectory thesis:amplitude=60deg,cycle=3 --output run.csv\n"
        "  jointid simulate joint.toml --believe guess.toml --sensor torque_noise=0.5 --output run.csv\n"
        "  jointid simulate joint.toml --controller pd --gain stiffness=8000 --gain damping=400 \\\n"
        "      --trajectory sine:amplitude=0.3,frequency=0.5,duration=10 --output run.csv\n"
        "the joint file needs a value for each parameter, as `identify --save joint.toml` writes them"
    )
    simulate.add_argument("joint", type=Path, help="joint file (.toml) with parameter values")
    scenario_arguments(simulate)
    simulate.add_argument(
        "--seed", type=whole_seed, default=0, help="seed of the sensors' noise (default 0)"
    )
    simulate.add_argument(
        "--output", type=Path, help="file for the recording: .csv, .csv.gz or .npz"
    )
    simulate.add_argument("--json", action="store_true", help="print the outcome as JSON")


def simulate(arguments: argparse.Namespace) -> None:
    """Simulate a joint and write the recording of its sensors."""
    check_recording_file("output", arguments.output)
    scenario = scenario_of(arguments.joint, arguments)
    batch = scenario.simulate(arguments.seed)
    recording = batch.recordings[0]
    if arguments.output is not None:
        recording.save(arguments.output)
    tracked = recording.reference is not None
    outcome = {
        "samples": len(recording),
        "duration": recording.duration,
        "tracking_error": float(batch.error[0]) if tracked else None,
        "peak_error": float(batch.peak_error[0]) if tracked else None,
        "peak_velocity": float(abs(recording.truth.signals["velocity"]).max()),
        "saturations": int(batch.saturations[0]),
        "truth": dict(recording.truth),
        "output": None if arguments.output is None else str(arguments.output),
    }
    if arguments.json:
        print(json.dumps(outcome, indent=1, ensure_ascii=False))
        return
    unit = "m" if recording.kind == "prismatic" else "rad"
    print(f"{len(recording)} samples in {recording.duration:g} s")
    if tracked:
        print(
            f"tracking error, without the first sixth of the motion: rms {outcome['tracking_error']:.3g} {unit}, "
            f"largest {outcome['peak_error']:.3g} {unit}"
        )
    print(f"largest velocity {outcome['peak_velocity']:.3g} {unit}/s")
    if outcome["saturations"]:
        print(f"the torque limit cut the command in {outcome['saturations']} control periods")
    if arguments.output is not None:
        print(f"recording: {arguments.output}")
