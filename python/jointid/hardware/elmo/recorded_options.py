"""Convert an Elmo drive's options to a recording's metadata and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.hardware.bench.table import Table
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.session.metadata import plain

_SOURCES = (AnalogInput.__name__, SyncedConverter.__name__)


def elmo_options_document(options: ElmoOptions) -> dict[str, Any]:
    """Return the options as JSON types. The key "source" holds the kind of the torque sensor."""
    document: dict[str, Any] = plain(options)
    if options.torque is not None:
        document["torque"] = {"source": type(options.torque).__name__, **document["torque"]}
    return document


def elmo_options_of(metadata: Mapping[str, Any]) -> ElmoOptions:
    """Return the options in a recording's `drive_options`, or the default options.

    Raises
    ------
    InputError
        They are options of another drive or of a later version.
    """
    recorded = metadata.get("drive_options")
    if recorded is None:
        return ElmoOptions()
    table = Table(recorded, "drive_options", "metadata")
    source: SyncedConverter | AnalogInput | None = None
    if table.entries.get("torque") is not None:
        torque = table.table("torque")
        scaling = torque.table("scaling").make(SensorScaling)
        rest = torque.without("source", "scaling")
        if torque.choice("source", "", _SOURCES) == "AnalogInput":
            source = rest.make(AnalogInput, scaling=scaling)
        else:
            source = rest.make(SyncedConverter, scaling=scaling)
    return table.without("torque").make(ElmoOptions, torque=source)
