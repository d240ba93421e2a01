"""The on-line identifier's thread at its edges, and what it refuses before the first estimate."""

import gc
import subprocess
import sys
import threading

import pytest
from example_recordings import WELL_EXCITED
from online_feeding import blocks

import jointid as jid


@pytest.fixture(scope="module")
def excited() -> jid.Recording:
    return jid.load(WELL_EXCITED).crop(0.0, 4.0)


@pytest.mark.parametrize("kind", [SystemExit, KeyboardInterrupt, RuntimeError])
def test_errors_of_the_callback_are_reported(
    excited: jid.Recording, kind: type[BaseException]
) -> None:
    calls: list[int] = []

    def broken(estimate: jid.OnlineEstimate) -> None:
        calls.append(estimate.update)
        if len(calls) == 1:
            raise kind("the user's own")

    with jid.OnlineIdentifier(jid.thesis_joint(), callback=broken) as identifier:
        first, *others = blocks(excited, 2000)
        identifier.feed(**first)
        with pytest.raises(kind, match="the user's own"):
            identifier.wait(30.0)
        for block in others:
            identifier.feed(**block)
        identifier.wait(30.0)
    assert calls == list(range(1, len(calls) + 1))
    assert len(calls) > 1


def fails_unheard(excited: jid.Recording, error: Exception | None) -> None:
    """A block whose callback fails after its last call to the identifier."""
    called = threading.Event()

    def broken(_: jid.OnlineEstimate) -> None:
        called.set()
        raise RuntimeError("the user's own")

    with jid.OnlineIdentifier(jid.thesis_joint(), callback=broken) as identifier:
        identifier.feed(**next(blocks(excited, 4000)))
        assert called.wait(30.0)
        if error is not None:
            raise error


def test_the_end_of_the_block_tells_what_nobody_asked_for(excited: jid.Recording) -> None:
    with pytest.raises(RuntimeError, match="the user's own"):
        fails_unheard(excited, None)


def test_the_end_of_the_block_hides_no_other_error(excited: jid.Recording) -> None:
    with pytest.raises(ZeroDivisionError):
        fails_unheard(excited, ZeroDivisionError())


def test_the_callback_cannot_wait_for_itself(excited: jid.Recording) -> None:
    with jid.OnlineIdentifier(
        jid.thesis_joint(), callback=lambda _: identifier.wait()
    ) as identifier:
        identifier.feed(**next(blocks(excited, 4000)))
        with pytest.raises(jid.InputError, match="cannot wait for this thread"):
            identifier.wait(30.0)


def test_an_identifier_that_is_dropped_ends_its_thread(excited: jid.Recording) -> None:
    identifier = jid.OnlineIdentifier(jid.thesis_joint())
    identifier.feed(**next(blocks(excited, 4000)))
    identifier.wait(30.0)
    thread = identifier._worker.thread
    assert thread is not None
    assert thread.is_alive()
    del identifier
    gc.collect()
    thread.join(30.0)
    assert not thread.is_alive()


def test_the_first_update_loads_no_module() -> None:
    program = """
import sys
import jointid as jid
part = jid.load(sys.argv[1]).crop(0.0, 3.0)
signals = {name: getattr(part, name) for name in part.signals}
with jid.OnlineIdentifier(jid.thesis_joint()) as identifier:
    before = set(sys.modules)
    identifier.feed(**signals)
    assert identifier.wait(60.0) is not None
    print(sorted(set(sys.modules) - before))
"""
    wording = subprocess.run(
        [sys.executable, "-c", program, str(WELL_EXCITED)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert wording.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("changes", "wording"),
    [
        ({"model": "foo"}, "name is 'foo': it is unknown"),
        ({"residual": "foo"}, "residual is 'foo': it is unknown"),
        ({"model": {"ripple": "x"}}, "ripple is 'x'"),
        ({"model": {"load_friction": "yes"}}, "load_friction is 'yes'"),
        ({"model": {"asymmetric": 2}}, "asymmetric is 2"),
        ({"mask_standstill": "no"}, "mask_standstill is 'no'"),
        ({"parameters": {"nope": 1.0}}, "nope: there is no such parameter"),
        ({"parameters": {"load_friction": 1.0}}, "load_friction: this identification has no such"),
        ({"parameters": {"coulomb": {"min": 3.0, "max": 1.0}}}, "above max"),
        ({"torque_hold": "foo"}, "torque_hold is 'foo'"),
        ({"window": "30"}, "window is '30'"),
        ({"update": None}, "update is None"),
        ({"windows": "cumulative"}, "windows is 'cumulative'"),
        ({"windows": 200}, "windows is 200: the duration of a window in seconds"),
        ({"windows": 2.2}, "windows is 2.2: 7 parameters need more than 14 integration windows"),
    ],
)
def test_refuses_settings_at_once(changes: dict[str, object], wording: str) -> None:
    with pytest.raises(jid.InputError, match=wording):
        jid.OnlineIdentifier(jid.thesis_joint(), **changes)  # type: ignore[arg-type]


def test_without_a_joint_the_first_sample_says_whether_there_is_a_sensor() -> None:
    with jid.OnlineIdentifier(parameters={"sensor_gain": 2.0}) as identifier:
        with pytest.raises(jid.InputError, match="sensor_gain: this identification has no such"):
            identifier.feed(time=0.0, position=0.0, torque=0.0)
        identifier.feed(time=0.0, position=0.0, torque=0.0, sensor=0.0)


@pytest.mark.parametrize(
    ("sample", "wording"),
    [
        (
            {"motor_position": 0.0, "torque": 0.0, "sensor": 0.0},
            "motor_position: there is no such signal; did you mean",
        ),
        ({"position": 0.0, "sensor": 0.0}, "samples: torque: this signal is missing"),
        ({"position": 0.0, "torque": 0.0}, "the samples have no signal sensor"),
    ],
)
def test_refuses_the_first_sample(sample: dict[str, float], wording: str) -> None:
    with (
        jid.OnlineIdentifier(jid.thesis_joint()) as identifier,
        pytest.raises(jid.InputError, match=wording),
    ):
        identifier.feed(time=0.0, **sample)


def test_the_motors_torque_will_do(excited: jid.Recording) -> None:
    joint = jid.thesis_joint()
    assert excited.torque is not None
    with jid.OnlineIdentifier(joint) as identifier:
        for block in blocks(excited, 500):
            torque = block.pop("torque")
            identifier.feed(**block, motor_torque=torque / joint.gear_ratio)
        found = identifier.wait(30.0)
    assert found is not None
    assert found.parameters["coulomb"].value == pytest.approx(25.0, rel=0.01)


@pytest.mark.parametrize("name", ["window", "update", "windows"])
def test_a_duration_beyond_all_floats_is_refused(name: str) -> None:
    durations = {"window": 10.0, "update": 1.0} | {name: 10**400}
    with pytest.raises(jid.InputError, match=f"{name} is inf: a finite duration above 0"):
        jid.OnlineIdentifier(None, **durations)  # type: ignore[arg-type]


def test_a_simulation_beyond_all_floats_is_refused() -> None:
    from jointid.simulation.arguments import finite

    with pytest.raises(jid.InputError, match="duration is inf: a finite number is expected"):
        finite("duration", 10**400)
