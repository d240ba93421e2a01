"""Random serial arms, simulated by pinocchio's dynamics. At standstill friction takes any value up to its bound.

The package's balance is not used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_PERIOD = 1e-3  # of control and of the log [s]
_STEPS = 2  # of the simulation in a period
_SWEEPS = 60
_STILL = 1e-9  # [rad/s]
_BANDWIDTH = 30.0  # of the position loop [rad/s]
_TRUST = 0.9  # of the arm's own torque, commanded ahead
_FADE = 1.0  # from standstill to the full motion [s]


@dataclass(frozen=True, kw_only=True)
class SerialArm:
    """The URDF of an arm, and the friction and rotor of each joint.

    Friction is (coulomb · rise(v) + load · |torque of the links|) sgn v + viscous · v. `rise` is tanh(|v| / rise), or 1
    where it is 0.
    """

    urdf: str
    coulomb: Array  # [N·m]
    viscous: Array  # [N·m·s/rad]
    rotor: Array  # [kg·m²], at the joint
    load: Array
    rise: Array  # [rad/s]

    @property
    def joints(self) -> int:
        """Number of joints."""
        return int(self.coulomb.size)


@dataclass(frozen=True, kw_only=True)
class Signals:
    """True signals at each period, (ticks, joints); the torque is held until the next one."""

    time: Array
    position: Array
    velocity: Array
    torque: Array


def random_arm(rng: np.random.Generator, *, load: bool = False, rise: bool = False) -> SerialArm:
    """Draw an arm that stands upright; its links and friction become smaller towards its end."""
    n = int(rng.integers(3, 8))
    reach = rng.uniform(0.7, 1.4)
    shares = np.linspace(1.0, 0.35, n) * rng.uniform(0.7, 1.3, n)
    lengths = reach * shares / shares.sum()
    masses = rng.uniform(5.0, 14.0) * np.geomspace(1.0, rng.uniform(0.06, 0.2), n)
    masses *= rng.uniform(0.75, 1.3, n)
    axes = ["z", "y", "y"] + [str(rng.choice(["x", "y", "z"])) for _ in range(n - 3)]
    for place in range(3, n):  # no axis twice in a row if gravity cannot separate the two
        if axes[place] == axes[place - 1] == "z":
            axes[place] = "y"
    below = np.cumsum(masses[::-1])[::-1]
    arms = np.cumsum(lengths[::-1])[::-1]
    weight = 9.81 * below * 0.4 * arms  # about the gravity torque of the joint
    coulomb = weight * rng.uniform(0.1, 0.35, n) + 0.15
    viscous = coulomb * rng.uniform(0.5, 1.5, n)
    rotor = 0.4 * below * (0.4 * arms) ** 2 * rng.uniform(0.3, 1.5, n) + 0.01
    return SerialArm(
        urdf=_urdf(lengths, masses, axes, rng),
        coulomb=coulomb,
        viscous=viscous,
        rotor=rotor,
        load=rng.uniform(0.06, 0.2, n) if load else np.zeros(n),
        rise=rng.uniform(0.08, 0.3, n) if rise else np.zeros(n),
    )


def _urdf(lengths: Array, masses: Array, axes: list[str], rng: np.random.Generator) -> str:
    lines = ['<robot name="serial">', '  <link name="base"/>']
    parent, height = "base", 0.3
    for number, (length, mass, axis) in enumerate(zip(lengths, masses, axes, strict=True), 1):
        place = (*rng.uniform(-0.02, 0.02, 2), height)
        centre = (*rng.uniform(-0.03, 0.03, 2), length * rng.uniform(0.35, 0.6))
        slim = mass * length**2 / 12.0 + 0.4 * mass * 0.05**2
        across = 0.5 * mass * rng.uniform(0.04, 0.07) ** 2
        numbers = " ".join(str(int(axis == each)) for each in "xyz")
        lines += [
            f'  <joint name="joint_{number}" type="revolute"><parent link="{parent}"/>'
            f'<child link="link_{number}"/><origin xyz="{_text(place)}"/><axis xyz="{numbers}"/>',
            '    <limit effort="1000" velocity="10" lower="-3.1" upper="3.1"/></joint>',
            f'  <link name="link_{number}"><inertial><mass value="{mass:.6g}"/>'
            f'<origin xyz="{_text(centre)}"/><inertia ixx="{slim:.6g}" ixy="0" ixz="0" '
            f'iyy="{slim:.6g}" iyz="0" izz="{across:.6g}"/></inertial></link>',
        ]
        parent, height = f"link_{number}", length
    return "\n".join([*lines, "</robot>"]) + "\n"


def _text(values: tuple[float, ...]) -> str:
    return " ".join(f"{each:.6g}" for each in values)


def random_reference(n: int, duration: float, rng: np.random.Generator) -> tuple[Array, ...]:
    """Draw sums of sines about a posture: time, positions, velocities and accelerations, (ticks, joints)."""
    time = np.arange(0.0, duration, _PERIOD)
    sines = int(rng.integers(4, 7))
    rates = 2.0 * np.pi * rng.uniform(0.08, 0.13) * np.arange(1, sines + 1)
    size = rng.uniform(0.3, 1.0, (n, sines)) / rates
    phase = rng.uniform(0.0, 2.0 * np.pi, (n, sines))
    fast = np.abs((size * rates * np.cos(rates * time[::20, None, None] + phase)).sum(axis=2))
    size *= (rng.uniform(0.7, 1.4) * rng.uniform(0.8, 1.2, n) / fast.max(axis=0))[:, None]
    share = np.clip(time / _FADE, 0.0, 1.0)
    rate = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    change = 30.0 * share**2 * (1.0 - share) ** 2 / _FADE
    clock = np.where(
        time < _FADE, _FADE * (2.5 * share**4 - 3.0 * share**5 + share**6), time - 0.5 * _FADE
    )
    angle = rates * clock[:, None, None] + phase
    place = rng.uniform(-0.6, 0.6, n) + (size * np.sin(angle)).sum(axis=2)
    speed = (size * rates * np.cos(angle)).sum(axis=2)
    gain = -(size * rates**2 * np.sin(angle)).sum(axis=2)
    return (
        time,
        place,
        speed * rate[:, None],
        gain * rate[:, None] ** 2 + speed * change[:, None],
    )


def simulated(arm: SerialArm, duration: float, rng: np.random.Generator) -> Signals:
    """Simulate a controller that follows a random reference: most of the arm's own torque ahead, and stiffness.

    The impulses of friction in a step are within their bounds, and stop as many joints as they can.
    """
    import pinocchio

    model = pinocchio.buildModelFromXML(arm.urdf)
    state = model.createData()
    time, place, speed, gain = random_reference(arm.joints, duration, rng)
    step, upper = _PERIOD / _STEPS, np.triu_indices(arm.joints, 1)

    def inertia(position: Array) -> Array:
        found = np.array(pinocchio.crba(model, state, position))
        found.T[upper] = found[upper]
        return found + np.diag(arm.rotor)

    mass = np.diag(inertia(place[0]))
    stiffness, damping = mass * _BANDWIDTH**2, 2.0 * mass * _BANDWIDTH
    position, velocity, carried = place[0].copy(), np.zeros(arm.joints), 0.0 * mass
    table = np.empty((3, time.size, arm.joints))
    for tick in range(time.size):
        torque = _TRUST * (
            pinocchio.rnea(model, state, place[tick], speed[tick], gain[tick])
            + arm.rotor * gain[tick]
            + arm.coulomb * np.tanh(speed[tick] / 0.05)
            + arm.viscous * speed[tick]
        )
        torque += stiffness * (place[tick] - position) + damping * (speed[tick] - velocity)
        table[:, tick] = position, velocity, torque
        for _ in range(_STEPS):
            middle = position + 0.5 * step * velocity
            moving = inertia(middle)
            links = pinocchio.nonLinearEffects(model, state, middle, velocity)
            push = moving @ velocity + step * (torque - links)
            slope, level = arm.viscous, arm.coulomb + arm.load * carried
            if arm.rise.any():
                # Implicit in the speed, like the other terms: the chord of tanh at the last speed.
                chord = np.tanh(velocity / arm.rise) / np.where(velocity, velocity, 1.0)
                slope = slope + level * np.where(velocity, chord, 1.0 / arm.rise)
                level = np.zeros(arm.joints)
            back = np.asarray(np.linalg.inv(moving + step * np.diag(slope)), dtype=np.float64)
            sign = np.asarray(np.sign(velocity), dtype=np.float64)
            after = _slowed(back, back @ push, step * level, sign)
            if arm.load.any():
                change = (after - velocity) / step
                carried = np.abs(moving @ change - arm.rotor * change + links)
            position = position + 0.5 * step * (velocity + after)
            velocity = after
    return Signals(time=time, position=table[0], velocity=table[1], torque=table[2])


def _slowed(back: Array, free: Array, bound: Array, sign: Array) -> Array:
    """Return speeds after the impulses of friction, each within its bound, which stop a joint if they can."""
    after = free - back @ (sign * bound)
    if np.all((sign * after > 0.0) | (bound == 0.0)):
        return np.asarray(after)
    yields, impulse = np.diag(back), sign * bound
    for _ in range(_SWEEPS):
        before = impulse.copy()
        for joint in range(bound.size):
            rest = free[joint] - back[joint] @ impulse + yields[joint] * impulse[joint]
            impulse[joint] = min(max(rest / yields[joint], -bound[joint]), bound[joint])
        if np.all(np.abs(impulse - before) <= 1e-9 * bound):
            break
    after = free - back @ impulse
    after[np.abs(after) < _STILL] = 0.0
    return np.asarray(after)
