"""A simulated joint that another program moves step by step, e.g. an emulated drive."""

from jointid import _core
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.simulation.plant import Bristle, Values, simulated_joint


def stepped_joint(
    joint: Joint,
    *,
    sensors: _core.Sensors | None = None,
    payload: Link | float = 0.0,
    bristle: Bristle | None = None,
    period: float = 1e-3,
    integration_step: float = 2.5e-4,
    position: float = 0.0,
    velocity: float = 0.0,
    seed: int = 0,
) -> _core.SteppedJoint:
    """Return a joint to step, made as in `simulate`. It is at rest unless `velocity` [rad/s] is set.

    `period` is the time between observations [s], and `integration_step` is the longest step [s].
    """
    values = Values(joint)
    return _core.SteppedJoint(
        joint=simulated_joint(joint, values, payload, bristle),
        sensors=_core.Sensors() if sensors is None else sensors,
        gear_ratio=joint.gear_ratio,
        sensor_gain=values.need("sensor_gain") if joint.sensor else 1.0,
        sensor_offset=values.need("sensor_offset") if joint.sensor else 0.0,
        period=period,
        step=integration_step,
        position=position,
        velocity=velocity,
        seed=seed,
    )
