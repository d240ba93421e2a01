"""The equations of motion, one small step for all runs; friction is set-valued at rest."""

from __future__ import annotations

import numpy as np

from plants.columns import Array
from plants.plant import Plant

_NOTHING = 1e-300  # keeps a quotient finite


class MovingPlants:
    """Runs of a spread `Plant`, all rigid or all elastic, stepped together.

    Attributes
    ----------
    position, velocity : ndarray, shape (runs,)
        Of the drive, at the output.
    link_torque : ndarray, shape (runs,)
        What the gear transmits, which a sensor measures.
    """

    def __init__(self, plant: Plant, position: Array, velocity: Array, duration: float) -> None:
        self.plant, self.duration = plant, duration
        self.position, self.velocity = position.copy(), velocity.copy()
        runs = position.size
        self._acceleration = np.zeros(runs)
        self._elastic = bool(np.any(plant.gear_stiffness > 0.0))
        self._link_position, self._link_velocity = position.copy(), velocity.copy()
        self._link_acceleration = np.zeros(runs)
        self.link_torque = self._weight(position)
        if self._elastic:
            play = 0.5 * plant.backlash * np.sign(self.link_torque)
            self._link_position -= self.link_torque / plant.gear_stiffness + play
        self._bristle = np.zeros(runs)
        self._root = np.sqrt(plant.stribeck)
        self._dry = np.where(plant.bristle_stiffness > 0.0, 0.0, 1.0)
        self._has_bristle = bool(np.any(plant.bristle_stiffness > 0.0))
        self._usual_exponent = bool(np.all(plant.exponent == 2.0))
        self._directional = bool(np.any(plant.asymmetry) or np.any(plant.viscous_asymmetry))
        self._has_load = bool(np.any(plant.load_friction))
        self._has_pose = bool(np.any(plant.pose_inertia))
        self._drifts = bool(np.any(plant.coulomb_drift) or np.any(plant.viscous_drift))
        others = ("constant", "harmonic_torque", "bump", "coupling")
        self._has = {name: bool(np.any(getattr(plant, name))) for name in others}
        self._has_others = any(self._has.values())
        self.coulomb, self.viscous = np.asarray(plant.coulomb), np.asarray(plant.viscous)

    def _weight(self, position: Array) -> Array:
        return np.asarray(self.plant.gravity * np.cos(position + self.plant.gravity_angle))

    def _other_torques(self, time: float, position: Array) -> Array | float:
        """Torques that depend on time or angle, those that any run has."""
        plant = self.plant
        total: Array | float = 0.0
        if self._has["constant"]:
            total = total + plant.constant
        if self._has["harmonic_torque"]:
            angle = plant.harmonic_order * position + plant.harmonic_phase
            total = total + plant.harmonic_torque * np.sin(angle)
        if self._has["bump"]:
            part = np.clip((time - plant.bump_time) / plant.bump_width, 0.0, 1.0)
            total = total + plant.bump * np.sin(np.pi * part)
        if self._has["coupling"]:
            beat = np.sin(plant.coupling_rate * time + plant.coupling_phase)
            total = total + plant.coupling * beat
        return total

    def advance(self, time: float, torque: Array, step: float, steps: int) -> None:
        """Move on with a held torque."""
        plant = self.plant
        if self._drifts:
            share = time / self.duration
            self.coulomb = np.asarray(plant.coulomb * (1.0 + plant.coulomb_drift * share))
            self.viscous = np.asarray(plant.viscous * (1.0 + plant.viscous_drift * share))
        advance = self._elastic_step if self._elastic else self._rigid_step
        for k in range(steps):
            advance(time + (k + 0.5) * step, torque, step)

    def _rigid_step(self, time: float, torque: Array, step: float) -> None:
        plant, v, q = self.plant, self.velocity, self.position
        half = 0.5 * step
        middle = q + half * v
        middle_velocity = v + half * self._acceleration
        weight = self._weight(middle)
        link_mass = plant.link_inertia
        if self._has_pose:
            link_mass = link_mass + plant.pose_inertia * np.cos(2.0 * middle)
            weight = weight - plant.pose_inertia * np.sin(2.0 * middle) * middle_velocity**2
        load = weight + link_mass * self._acceleration if self._has_load else None
        after = self._moved(
            np.asarray(plant.inertia + link_mass),
            torque - weight,
            load,
            (time, step),
            (middle, v, middle_velocity),
        )
        self._acceleration = (after - v) / step
        self.position = q + half * (v + after)
        self.velocity = after
        self.link_torque = weight + link_mass * self._acceleration

    def _elastic_step(self, time: float, torque: Array, step: float) -> None:
        plant, v, q = self.plant, self.velocity, self.position
        middle, link = q + 0.5 * step * v, self._link_position + 0.5 * step * self._link_velocity
        twist, rate = middle - link, v - self._link_velocity
        half = 0.5 * plant.backlash
        wound = twist - np.clip(twist, -half, half)
        gear = np.where(wound == 0.0, 0.0, plant.gear_stiffness * wound + plant.gear_damping * rate)
        middle_velocity = v + 0.5 * step * self._acceleration
        after = self._moved(
            np.asarray(plant.inertia),
            torque - gear,
            gear if self._has_load else None,
            (time, step),
            (middle, v, middle_velocity),
        )
        self._acceleration = (after - v) / step
        self.position = q + 0.5 * step * (v + after)
        self.velocity = after
        self.link_torque = gear
        link_mass = plant.link_inertia
        free = gear - self._weight(link)
        if self._has_pose:
            link_mass = link_mass + plant.pose_inertia * np.cos(2.0 * link)
            free = free + plant.pose_inertia * np.sin(2.0 * link) * self._link_velocity**2
        faster = self._link_velocity + step * free / link_mass
        self._link_position = self._link_position + 0.5 * step * (self._link_velocity + faster)
        self._link_velocity = faster

    def _moved(
        self,
        mass: Array,
        torque: Array,
        load: Array | None,
        when: tuple[float, float],
        state: tuple[Array, Array, Array],
    ) -> Array:
        """The velocity after a step, from position, velocity and velocity in the middle of the step."""
        plant = self.plant
        time, step = when
        q, v, middle = state
        if self._has_others:
            torque = torque - self._other_torques(time, q)
        if self._usual_exponent:
            decay = np.exp(-plant.stribeck * middle**2)
        else:
            decay = np.exp(-((self._root * np.abs(middle)) ** plant.exponent))
        slip, excess, viscous = self.coulomb, plant.static, self.viscous
        if self._directional:
            sign = np.sign(middle)
            slip = slip * (1.0 + plant.asymmetry * sign)
            viscous = viscous * (1.0 + plant.viscous_asymmetry * sign)
        if load is not None:
            slip = slip + plant.load_friction * np.abs(load)
        dry = slip + excess * decay
        if self._has_bristle:
            torque = torque - self._pull(dry, middle, step)
            dry = dry * self._dry
        moves = v.all()
        if not moves:  # at rest the whole of static friction holds; on the way it brakes
            dry = np.where(v == 0.0, (slip + excess) * self._dry, dry)
        half = 0.5 * step * viscous
        free = (mass - half) * v + step * torque
        after = np.copysign(np.maximum(np.abs(free) - step * dry, 0.0), free) / (mass + half)
        goes_on = v * after > 0.0
        if moves and goes_on.all():  # nearly every step
            return after
        crossed = v * after < 0.0
        stopped = (after == 0.0) & (v != 0.0)
        if crossed.any() or stopped.any():
            breakaway = (slip + excess) * self._dry
            # Within the step it comes to rest; for what is left of it, it holds or breaks away.
            push = torque - np.sign(v) * dry
            spent = np.clip(-mass * v / np.where(push == 0.0, _NOTHING, step * push), 0.0, 1.0)
            away = np.sign(torque) * np.maximum(np.abs(torque) - breakaway, 0.0)
            again = away * (1.0 - spent) * step / mass
            after = np.where((crossed | stopped) & (self._dry > 0.0), again, after)
        return after

    def _pull(self, dry: Array, middle: Array, step: float) -> Array:
        """Torque of the bristles in the middle of a step, exact for the speed in the middle."""
        plant = self.plant
        stiffness = np.where(self._dry > 0.0, 1.0, plant.bristle_stiffness)
        speed = np.abs(middle)
        bent = np.sign(middle) * dry / stiffness
        fade = np.exp(-0.5 * step * stiffness * speed / np.maximum(dry, _NOTHING))
        half = bent + (self._bristle - bent) * fade
        rate = middle - stiffness * speed / np.maximum(dry, _NOTHING) * half
        self._bristle = bent + (half - bent) * fade
        return np.asarray((stiffness * half + plant.bristle_damping * rate) * (1.0 - self._dry))
