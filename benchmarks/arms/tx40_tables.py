"""TX40: friction of both methods next to the published values, and their predictions of held-out blocks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from measured import Part

import jointid as jid
from arms import classical, ours, tx40
from arms.classical import Array, Mask
from arms.held_out import Share, Windows, folds

FOLDS = 5
CUTOFFS = (
    (20.0, 50),
    (40.0, 25),
    (60.0, 25),
    (100.0, 25),
)  # [Hz], and the interval between rows in samples
THIN = 5  # samples, for predictions: 1 kHz
CUTOFF, EVERY = 20.0, 50  # for the parameters
PUBLISHED_MODEL = "coulomb_viscous"
MOTION = 40.0  # cutoff of the motion for our prediction [Hz]
OURS: dict[str, dict[str, Any]] = {
    "jointid, inertia free, Coulomb and viscous": {
        "cutoff": MOTION,
        "inertia": "free",
        "model": PUBLISHED_MODEL,
    },
    "jointid, inertia free, model chosen": {"cutoff": MOTION, "inertia": "free"},
    "jointid, inertia free, model chosen, its own velocity": {"cutoff": None, "inertia": "free"},
    "jointid, inertia scaled, model chosen": {"cutoff": MOTION, "inertia": "scaled"},
    "jointid, inertia scaled, model chosen, its own velocity": {
        "cutoff": None,
        "inertia": "scaled",
    },
}
FRICTION = Part(
    title="Robot TX40: friction",
    asked="Does the identified friction agree with the values that Janot, Vandanjon and Gautier published? Raw log at "
    "the motors, 5 kHz, 9 s; model with Coulomb and viscous friction. The peer is filtered least squares with a "
    "cutoff of 20 Hz.",
    header=(
        "friction [N·m, N·m·s/rad]",
        "published",
        "jointid",
        "jointid − published [%]",
        "two standard errors of jointid [%]",
        "filtered least squares",
        "filtered − published [%]",
    ),
)
BLOCKS = Part(
    title="Robot TX40: held-out data",
    asked="How well are five held-out blocks of 1.5 s predicted? The torque integrals are taken over windows of 25 "
    "and 100 ms. The residual of these integrals is in percent of the measured integrals of all joints.",
    header=(
        "method",
        "residual, 25 ms [%]",
        "joints not worse",
        "residual, 100 ms [%]",
        "joints not worse",
    ),
    reading="*Joints not worse*: number of joints with a residual that is at most the residual of the best filtered "
    "least squares. jointid predicts along the motion that the 40 Hz filter gives. So only the identified values "
    "differ. Rows with *its own velocity* predict along jointid's own motion.",
)
LENGTHS = (0.025, 0.1)  # of the windows [s]


@dataclass(frozen=True)
class Log:
    """The log at the joints, and the mask of moving samples."""

    folder: Path
    time: Array
    position: Array
    torque: Array

    @staticmethod
    def read(folder: Path) -> Log:
        """Return the log from the folder with it and the URDF."""
        return Log(folder, *tx40.log(folder))

    @property
    def moving(self) -> Mask:
        """Return the mask of samples before the standstill at the end."""
        begin, end = tx40.MOVING
        return np.asarray((self.time >= begin) & (self.time < end))

    @property
    def robot(self) -> jid.Robot:
        """Return the facts for our call: the URDF, ratios, couplings, zeros."""
        ratios = np.array(tx40.GEAR_RATIOS)
        return jid.Robot.from_urdf(
            self.folder / "tx40.urdf",
            gear_ratios=tx40.GEAR_RATIOS,
            couplings=tx40.COUPLINGS / ratios[:, None],
            zero_offsets=tx40.ZEROS,
        )

    def velocity(self) -> Array:
        """Return the joint velocities, as `Recording` derives them from the positions."""
        joints = [jid.Recording(time=self.time, position=each) for each in self.position.T]
        return np.column_stack([joint.velocity for joint in joints])

    def recording(self) -> jid.RobotRecording:
        """Return the raw log at the motors."""
        return jid.load_robot(self.folder / "tx40.csv.gz", gear_ratio=list(tx40.GEAR_RATIOS))


def held_out_of_classical(log: Log, cutoff: float, every: int) -> dict[float, Share]:
    """Return residuals of the classical method by the windows' length."""
    model, sources = tx40.urdf(log.folder), tx40.sources()
    signals = classical.filtered(log.time, log.position, log.torque, cutoff)
    rows = classical.rows_of(model, sources, signals, every)
    thin = classical.Signals(
        *(
            values[::THIN]
            for values in (
                signals.time,
                signals.position,
                signals.velocity,
                signals.acceleration,
                signals.torque,
            )
        )
    )
    columns, _ = classical.regressor(model, sources, thin)
    pairs: dict[float, tuple[list[Array], list[Array]]] = {length: ([], []) for length in LENGTHS}
    for block in folds(log.time, *tx40.MOVING, FOLDS):
        fit = classical.fit(rows, (log.moving & ~block)[::every])
        torque = fit.torque(columns)
        for length, (measured, told) in pairs.items():
            windows = Windows.of(thin.time, block[::THIN], length)
            measured.append(windows.integrals(thin.time, thin.torque))
            told.append(windows.integrals(thin.time, torque))
    return {length: Share.gathered(*pair) for length, pair in pairs.items()}


def held_out_of_ours(log: Log, cutoff: float | None, **options: Any) -> dict[float, Share]:
    """Return residuals of our method by the windows' length; the call knows only the robot.

    The motion for the prediction is filtered as in the classical method, so that only the identified values differ.
    Without a cutoff, it is the package's own motion.
    """
    model, whole = tx40.urdf(log.folder), log.recording()
    thin, torque = log.time[::THIN], log.torque[::THIN]
    if cutoff is None:
        position, velocity = log.position[::THIN], log.velocity()[::THIN]
    else:
        signals = classical.filtered(log.time, log.position, log.torque, cutoff)
        position, velocity = signals.position[::THIN], signals.velocity[::THIN]
    pairs: dict[float, tuple[list[Array], list[Array]]] = {length: ([], []) for length in LENGTHS}
    begin, end = tx40.MOVING
    for block in folds(log.time, begin, end, FOLDS):
        low, high = log.time[block][[0, -1]]
        ends = [(begin, low), (high, end)]
        parts = [whole.crop(*pair) for pair in ends if pair[1] - pair[0] > max(LENGTHS)]
        found = jid.identify_robot(parts, log.robot, **options)
        for length, (measured, told) in pairs.items():
            windows = Windows.of(thin, block[::THIN], length)
            measured.append(windows.integrals(thin, torque))
            told.append(ours.predicted(found, model, thin, position, velocity, windows))
    return {length: Share.gathered(*pair) for length, pair in pairs.items()}


def parameters(log: Log) -> Iterator[list[str]]:
    """Publish the friction next to the published values."""
    ours_found = jid.identify_robot(
        log.recording(), log.robot, inertia="free", model=PUBLISHED_MODEL
    )
    model, sources = tx40.urdf(log.folder), tx40.sources()
    signals = classical.filtered(log.time, log.position, log.torque, CUTOFF)
    rows = classical.rows_of(model, sources, signals, EVERY)
    fit = classical.fit(rows, log.moving[::EVERY])
    theirs, own = tx40.as_published(fit.value), ours_of(ours_found)
    for kind, published in (("viscous", tx40.VISCOUS), ("coulomb", tx40.COULOMB)):
        for name, value in published.items():
            mine = own[f"{kind} {name}"]
            other = theirs[f"{kind} {name}"]
            yield [
                f"{kind} friction of {'joint ' if name.isdigit() else ''}{name}",
                f"{value:g}",
                f"{mine.value:.3f}",
                percent(mine.value / value - 1.0),
                percent(2.0 * (mine.stderr or np.nan) / mine.value, sign=False),
                f"{other:.3f}",
                percent(other / value - 1.0),
            ]


def ours_of(found: jid.RobotEstimate) -> dict[str, Any]:
    """Return parameters by the names of the published ones; jointid's viscous friction includes the motor's."""
    values = {}
    for number in range(1, tx40.JOINTS + 1):
        for kind in ("viscous", "coulomb"):
            values[f"{kind} {number}"] = found.joints[f"joint_{number}"].parameters[kind]
    for kind in ("viscous", "coulomb"):
        last = found.joints[f"joint_{tx40.JOINTS}"].parameters
        values[f"{kind} {tx40.MOTOR_6}"] = last[f"motor_{kind}"]
    return values


def held_out(log: Log) -> Iterator[list[str]]:
    """Publish the residuals of both methods on held-out blocks."""
    theirs = {
        f"filtered least squares, {cutoff:g} Hz, every {every}th sample": held_out_of_classical(
            log, cutoff, every
        )
        for cutoff, every in CUTOFFS
    }
    mine = {name: held_out_of_ours(log, **options) for name, options in OURS.items()}
    best = {
        length: min(theirs.values(), key=lambda each: each[length].total)[length].joints
        for length in LENGTHS
    }
    for name, found in {**theirs, **mine}.items():
        cells = [name]
        for length in LENGTHS:
            below = f"{int(np.sum(found[length].joints <= best[length]))}/{tx40.JOINTS}"
            cells += [percent(found[length].total, sign=False), below if name in mine else "–"]
        yield cells


def percent(share: float, sign: bool = True) -> str:
    """Return a share in %, with one decimal."""
    return f"{100.0 * share:{'+' if sign else ''}.1f}"
