"""Controllers and sensors as tables in a file: their settings by name."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from jointid import _core
from jointid.base.errors import InputError
from jointid.base.schema import Flag, Kind, Number, Plain, Record, Text
from jointid.simulation.arguments import LAWS, Controller, law_name


def controller_table(controller: Controller) -> dict[str, Any]:
    """Return a controller's law and settings, in JSON types."""
    return {"law": law_name(controller), **_settings(controller)}


def sensors_table(sensors: _core.Sensors) -> dict[str, Any]:
    """Return the settings of sensors, in JSON types."""
    return _settings(sensors)


def read_controller(table: Any, place: str) -> Controller:
    """Return the controller of a table; the inverse of `controller_table`."""
    read = Record({"law": Text(known=tuple(LAWS))}, other=Plain()).read(table, place)
    made: Controller = _made(LAWS[read.pop("law")], read, place)
    return made


def read_sensors(table: Any, place: str) -> _core.Sensors:
    """Return the sensors of a table; the inverse of `sensors_table`."""
    made: _core.Sensors = _made(_core.Sensors, Record({}, other=Plain()).read(table, place), place)
    return made


def plain(value: Any) -> Any:
    """Return a number that is not finite as the text that a schema reads. Other values are unchanged."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _settings(value: Any) -> dict[str, Any]:
    return {name: plain(each) for name, each in value.asdict().items()}


def _made(make: Callable[..., Any], table: Mapping[str, Any], place: str) -> Any:
    usual: Mapping[str, Any] = make().asdict()
    settings = Record({}, {name: _kind(value) for name, value in usual.items()})
    try:
        return make(**settings.read(table, place))
    except InputError as error:
        raise (error if error.place else error.at(place)) from None


def _kind(usual: Any) -> Kind:
    """Return the type of value that may replace a default."""
    if isinstance(usual, bool):
        return Flag()
    if isinstance(usual, int):
        return Number(low=-(2**31), high=2**31 - 1, whole=True)
    return Number(infinite=True) if isinstance(usual, float) else Text()
