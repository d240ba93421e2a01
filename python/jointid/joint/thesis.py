"""The joint of the thesis."""

from jointid.joint.joint import Joint
from jointid.joint.link import Limits, Link
from jointid.joint.model import Model
from jointid.joint.parameters import Parameter


def thesis_joint() -> Joint:
    """Return the joint of the thesis: a strain-wave drive with a built-in torque sensor.

    The joint contains the drive's data and the search bounds, but no values for friction or sensor.

    Examples
    --------
    >>> jid.thesis_joint().gear_ratio
    101.0
    """
    domain = {
        "coulomb": (0.0, 50.0),
        "static": (0.0, 40.0),
        "stribeck": (0.0, 200.0),
        "viscous": (0.0, 40.0),
        "sensor_offset": (-30.0, 30.0),
        "sensor_gain": (0.1, 5.0),
    }
    mass, length = 3.0, 0.5  # a slender rod held at its end
    centre, inertia = length / 2.0, mass * length**2 / 3.0
    link = Link(mass=mass, centre_of_mass=centre, inertia=inertia, gravity=9.817)
    return Joint(
        name="thesis joint",
        rotor_inertia=2.472e-4,
        gear_ratio=101.0,
        torque_constant=0.198,
        torque_hold="zoh",
        sensor=True,
        # Gravity acts behind the sensor, so that the sensor measures it.
        model=Model("stribeck", gravity="none"),
        link=link,
        parameters={
            name: Parameter(name=name, min=low, max=high) for name, (low, high) in domain.items()
        },
        limits=Limits(torque=160.0, current=8.0),
    )
