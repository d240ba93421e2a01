"""Settings of a closed loop without the seed, for many simulations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, fields, replace
from typing import Any, Self, get_args

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import suggestion
from jointid.joint.joint import Joint
from jointid.joint.link import Link
from jointid.simulation.arguments import Controller
from jointid.simulation.batch import SimulatedBatch, simulate_batch
from jointid.simulation.plant import Bristle, control_estimates
from jointid.simulation.trajectory import Trajectory


@dataclass(frozen=True)
class Scenario:
    """All settings of a simulation except its seed: joint, controller, trajectory, sensors and options.

    Parameters
    ----------
    joint : Joint
        The simulated joint with its true parameters.
    controller : OpenLoop, Pd, Pid, CompensatedPid, AdaptiveRobust or LugreObserver
    trajectory : Trajectory
    sensors : Sensors
        Default: exact signals.
    duration, control_period, sample_period, integration_step, payload, bristle, position, velocity
        As in `simulate`.

    Raises
    ------
    InputError
        Joint, controller, trajectory or sensors have the wrong type.

    Examples
    --------
    >>> scenario = jid.Scenario(known, jid.Pd(stiffness=8000.0, damping=400.0), jid.Trajectory.thesis(duration=2.0))
    >>> len(scenario.simulate(0).recordings)
    1

    Other controllers, each with its own settings:

    >>> laws = [jid.Pid(stiffness=8000.0, integral=2000.0, damping=400.0), jid.OpenLoop(gain=1.0),
    ...     jid.CompensatedPid(stiffness=8000.0, damping=400.0), jid.LugreObserver(bandwidth=60.0),
    ...     jid.AdaptiveRobust(bandwidth=80.0, robust_torque=5.05)]
    >>> jid.Scenario(known, laws[2], jid.Trajectory.thesis(duration=2.0)).believing(known).coulomb
    25.0
    """

    joint: Joint
    controller: Controller
    trajectory: Trajectory
    sensors: _core.Sensors = field(default_factory=_core.Sensors)
    duration: float | None = field(default=None, kw_only=True)
    control_period: float = field(default=1e-3, kw_only=True)
    sample_period: float | None = field(default=None, kw_only=True)
    integration_step: float | None = field(default=None, kw_only=True)
    payload: Link | float = field(default=0.0, kw_only=True)
    bristle: Bristle | None = field(default=None, kw_only=True)
    position: float | None = field(default=None, kw_only=True)
    velocity: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        known: dict[str, tuple[type, ...]] = {
            "joint": (Joint,),
            "controller": get_args(Controller),
            "trajectory": (Trajectory,),
            "sensors": (_core.Sensors,),
        }
        for name, kinds in known.items():
            if not isinstance(getattr(self, name), kinds):
                expected = (
                    "a Sensors value"  # plural noun
                    if name == "sensors"
                    else f"{'one of' if len(kinds) > 1 else 'a'} "
                    + ", ".join(kind.__name__ for kind in kinds)
                )
                raise InputError(
                    f"{expected} is expected", argument=name, value=getattr(self, name)
                )

    def simulate(
        self,
        seeds: int | Sequence[int] = 0,
        *,
        controllers: Controller | Sequence[Controller] | None = None,
        recordings: bool = True,
        threads: int = 0,
    ) -> SimulatedBatch:
        """Simulate once for each seed or controller. The results are bit-identical to the results of `simulate`.

        Parameters
        ----------
        seeds : int or sequence of int
            Seeds of the sensors' noise. Default 0.
        controllers : optional
            Controllers that replace the scenario's controller: one for all simulations, or one for each seed.
        recordings : bool
            Whether to keep the signals. Default True.
        threads : int
            Number of threads. Default 0: all processors.

        Raises
        ------
        InputError
            As in `simulate`.
        """
        return simulate_batch(
            self.joint,
            self.controller if controllers is None else controllers,
            self.trajectory,
            duration=self.duration,
            control_period=self.control_period,
            sample_period=self.sample_period,
            integration_step=self.integration_step,
            sensors=self.sensors,
            payload=self.payload,
            bristle=self.bristle,
            position=self.position,
            velocity=self.velocity,
            seeds=seeds,
            recordings=recordings,
            threads=threads,
        )

    def options(self) -> list[str]:
        """Return the names of the fields that `changed` accepts. ``truth.NAME`` is a true parameter of the joint."""
        own = [item.name for item in fields(self)]
        for part in ("sensors", "controller"):
            own += [f"{part}.{name}" for name in getattr(self, part).asdict()]
        return own + [f"truth.{name}" for name in self.joint.parameters]

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return the scenario with new fields, ``sensors.FIELD``, ``controller.FIELD`` or ``truth.PARAMETER``.

        Complete fields change first, and then single values inside fields.

        Raises
        ------
        InputError
            A name is unknown, or a value is invalid.
        """
        known = self.options()
        for name in changes:
            if name not in known and "." not in name:
                raise InputError(
                    f"no such field; {suggestion(name, known)}",
                    argument=f"Scenario.{name}",
                )
        scenario = replace(self, **{n: v for n, v in changes.items() if "." not in n})
        inside: dict[str, dict[str, Any]] = {}
        for name, value in changes.items():
            part, _, field_name = name.partition(".")
            if field_name:
                inside.setdefault(part, {})[field_name] = value
        for part, values in inside.items():
            scenario = scenario._with(part, values)
        return scenario

    def _with(self, part: str, values: Mapping[str, Any]) -> Self:
        if part == "truth":
            return replace(self, joint=self.joint.with_parameters(values))
        if part not in ("sensors", "controller"):
            raise InputError(
                "there is no such field; only fields inside sensors, controller or truth can be changed",
                argument=f"Scenario.{part}.{next(iter(values))}",
            )
        return replace(self, **{part: getattr(self, part).replace(**values)})

    @property
    def truth(self) -> dict[str, float]:
        """True values of the joint's parameters in SI units; parameters without a value are omitted."""
        values = ((name, p.value) for name, p in self.joint.parameters.items())
        return {name: value for name, value in values if value is not None}

    def believing(self, joint: Joint) -> Controller:
        """Return the controller with the values of `control_estimates` for a joint, e.g. an identified joint.

        Raises
        ------
        InputError
            The controller uses no estimates, or the joint lacks a value.
        """
        return believing(self.controller, joint)


def believing(controller: Controller, joint: Joint) -> Controller:
    """Return a controller with the values of `control_estimates` for a joint, e.g. an identified joint."""
    estimates = control_estimates(joint)
    used = {n: v for n, v in estimates.items() if n in controller.asdict()}
    if "coulomb" not in used:
        raise InputError(
            f"{type(controller).__name__} uses no estimates of friction",
            argument="controller",
            remedy="use CompensatedPid, AdaptiveRobust or LugreObserver",
        )
    return controller.replace(**used)
