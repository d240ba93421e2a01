"""One line with the assumptions of a design: the sensors' noise and the controller."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from jointid import _core
from jointid.excitation.design_fields import DesignFields
from jointid.simulation.arguments import law_name

_GAINS = ("stiffness", "integral", "damping")
_VELOCITIES = {"counts": "velocity from its counts", "difference": "velocity from differences"}


def assumed(design: DesignFields) -> str:
    """Return the sensors, the controller and the period that a design assumes."""
    sensors = list(_sensors(design.sensors, design.joint.kind == "prismatic"))
    return (
        f"assumes {', '.join(sensors) or 'sensors without noise'}; "
        f"controller {_controller(design.controller)}, every {1e3 * design.control_period:.4g} ms"
    )


def _sensors(sensors: _core.Sensors, prismatic: bool) -> Iterator[str]:
    """Yield the differences of the sensors from exact ones; rare settings by their names."""
    usual: Mapping[str, Any] = _core.Sensors().asdict()
    stated = {name: each for name, each in sensors.asdict().items() if each != usual[name]}
    if "torque_noise" in stated:
        unit = "N" if prismatic else "N·m"
        yield f"noise of {stated.pop('torque_noise'):.3g} {unit} at the torque sensor"
    if "encoder_counts" in stated:
        yield f"an encoder of {stated.pop('encoder_counts'):.7g} counts per motor revolution"
    if stated.get("velocity") in _VELOCITIES:
        yield _VELOCITIES[stated.pop("velocity")]
    for name, value in stated.items():
        shown = f"{value:.4g}" if isinstance(value, float) else str(value)
        yield f"{name.replace('_', ' ')} {shown}"


def _controller(controller: Any) -> str:
    """Return the controller's law, its assumed friction or gains, and whether it feeds back the torque sensor."""
    settings: Mapping[str, Any] = controller.asdict()
    friction = {term.name for term in _core.terms() if term.friction}
    friction |= {shape.name for shape in _core.shapes()}
    believed = [name for name in settings if name in friction]
    named = believed or [name for name in _GAINS if name in settings]
    shown = [f"{name} {settings[name]:.4g}" for name in named]
    text = law_name(controller)
    if shown:
        text += f" {'that believes' if believed else 'with'} {', '.join(shown)}"
    fed_back = settings.get("torque_feedback")
    if fed_back is not None:
        text += f", {'with' if fed_back else 'without'} torque feedback"
    return text
