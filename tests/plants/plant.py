"""The joint that is simulated, with all in which it may differ from the model that is identified."""

from __future__ import annotations

from dataclasses import dataclass

from plants.columns import Columns, PerRun


@dataclass(frozen=True, kw_only=True)
class Plant(Columns):
    """A joint; every field is a number, or an array with one value for each run. SI units, output side.

    The drive: (inertia) q'' + friction + harmonic_torque sin(harmonic_order q + harmonic_phase) +
    constant + disturbance + coupling + link = torque. The link: link_inertia q'' +
    pose_inertia (cos 2q q'' - sin 2q q'²) + gravity cos(q + gravity_angle), which is what a sensor measures.
    """

    # Drive.
    inertia: PerRun = 2.472e-4 * 101.0**2
    coulomb: PerRun = 25.0
    static: PerRun = 20.0
    stribeck: PerRun = 100.0
    exponent: PerRun = 2.0  # exp(-(sqrt(stribeck) |v|) ** exponent)
    viscous: PerRun = 20.0
    asymmetry: PerRun = 0.0  # Coulomb is (1 ± asymmetry) of its mean
    viscous_asymmetry: PerRun = 0.0
    load_friction: PerRun = 0.0  # times |torque that the gear transmits| sgn v
    constant: PerRun = 0.0  # of the torque [N·m]
    harmonic_torque: PerRun = 0.0
    harmonic_order: PerRun = 3.0
    harmonic_phase: PerRun = 0.0
    torque_scale: PerRun = 1.0  # applied torque = scale * recorded torque (wrong torque constant)
    # Presliding: a LuGre bristle; 0 is set-valued friction. With static = 0 and bristle_damping = 0 Dahl's.
    bristle_stiffness: PerRun = 0.0  # [N·m/rad]
    bristle_damping: PerRun = 0.0  # [N·m·s/rad]
    # Changes with time.
    coulomb_drift: PerRun = 0.0  # share of the value, over the whole run
    viscous_drift: PerRun = 0.0
    bump: PerRun = 0.0  # half a sine [N·m]
    bump_time: PerRun = 4.0  # its begin [s]
    bump_width: PerRun = 1.0  # [s]
    coupling: PerRun = (
        0.0  # torque of another axis, coupling sin(coupling_rate t + coupling_phase) [N·m]
    )
    coupling_rate: PerRun = 5.3  # [rad/s]
    coupling_phase: PerRun = 0.7
    # Link; behind the sensor where there is one.
    link_inertia: PerRun = 0.25
    gravity: PerRun = 3.0 * 9.817 * 0.25  # mass · g · centre of mass [N·m]
    gravity_angle: PerRun = -1.5707963267948966  # -90°: about the vertical, hanging at q = 0
    pose_inertia: PerRun = 0.0
    # Gear; 0 is rigid. An elastic one has the encoder on the drive's side.
    gear_stiffness: PerRun = 0.0  # [N·m/rad]
    gear_damping: PerRun = 0.0
    backlash: PerRun = 0.0  # whole play [rad]
