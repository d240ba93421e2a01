"""A host that dies in the midst of an emulated session: nothing is sent any more, and the joint goes on."""

from contextlib import suppress
from dataclasses import replace

from jointid.hardware import Bench, DriveEnd, EmulatedBus, Session
from jointid.hardware.elmo.drive import ElmoDrive
from jointid.hardware.elmo.emulated_bench import elmo_devices

STEP = 2e-3  # [s] between two looks at the joint
RESTS = 1e-3  # [rad/s]


class KilledError(BaseException):
    """The host's program is gone."""


def waiting(bench: Bench, time: float) -> Bench:
    """The bench with another time of the drive's watchdog [s], and every travel allowed."""
    return replace(
        bench,
        drive=replace(bench.drive, heartbeat=time),
        limits=replace(bench.limits, watchdog_travel=1e6),
    )


def travel_after_death(bench: Bench, moment: float, seed: int = 0) -> float:
    """How far the emulated joint goes from where it was when the host died [rad].

    Parameters
    ----------
    bench : Bench
        With an Elmo drive.
    moment : float
        Of the run [s].
    """
    elmo, *others = elmo_devices(bench, seed)
    with EmulatedBus(elmo, *others, seed=seed) as bus:
        drive = ElmoDrive(bus, bench.joint, bench.drive)

        def die(phase: str, time: float, *_: object) -> None:
            if phase == "run" and time >= moment:
                drive.disable = lambda: DriveEnd(state="off")  # type: ignore[method-assign]
                drive.close = lambda: None  # type: ignore[method-assign]
                raise KilledError

        session = Session(
            *(drive, bench.controller, bench.trajectory, bench.limits),
            options=bench.options,
            observer=die,
        )
        with suppress(KilledError):
            session.run()
        assert elmo.motor_on
        begin, farthest = elmo.joint.position, 0.0
        off = bus.now() + bench.drive.heartbeat + 2e-3
        while bus.now() < off or abs(elmo.joint.velocity) > RESTS:
            bus.sleep_until(bus.now() + STEP)
            elmo.advance()
            farthest = max(farthest, abs(elmo.joint.position - begin))
        assert not elmo.motor_on
    return farthest
