"""Figures 6-2 and 6-3: the torque sensor's converter, one conversion a reading and many averaged."""

import numpy as np
from gallery import Gallery, titled
from scenario import TRUTH, hanging_joint

import jointid as jid

RANGE, BITS, NOISE = 217.34, 12, 3.0  # readings, bits, and steps of one conversion's noise
STEP = 2.0 * RANGE / 2**BITS


def draw(gallery: Gallery) -> None:
    """Read a joint at rest."""
    joint = hanging_joint().with_parameters(TRUTH)
    rest = jid.Trajectory.step(0.0, duration=1.0 if gallery.quick else 4.0)
    chain = jid.Sensors(converter_bits=BITS, converter_range=RANGE, converter_noise=NOISE)
    runs = {
        f"{samples} conversion{'s' if samples > 1 else ''} a reading": jid.simulate(
            joint,
            jid.OpenLoop(),
            rest,
            control_period=2e-3,
            sensors=chain.replace(converter_samples=samples),
        )
        for samples in (1, 16, 128)
    }
    with gallery.picture("6-2_6-3_converter", 1, 3, size=(11.0, 3.0), sharey=True) as panels:
        for axes, (name, run) in zip(panels, runs.items(), strict=True):
            assert run.sensor is not None
            shown = slice(0, 500)
            axes.plot(run.time[shown], run.sensor[shown], color="#0072B2", linewidth=0.7)
            axes.set_xlabel("time [s]")
            axes.set_ylabel("sensor [raw]")
            titled(axes, f"{'6-2' if name.startswith('1 ') else '6-3'}: {name}")
            samples = int(name.split()[0])
            spread = float(np.std(run.sensor)) / STEP
            gallery.note(
                "6-2" if samples == 1 else "6-3", f"{name}: standard deviation", spread, "steps"
            )
            estimated = float(np.sqrt((NOISE**2 + 1.0 / 12.0) / samples))
            gallery.note("6-2" if samples == 1 else "6-3", f"{name}: estimated", estimated, "steps")
