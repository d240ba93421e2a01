"""An Elmo drive's options in a recording's metadata, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jointid.base.errors import InputError
from jointid.hardware.elmo.options import ElmoOptions
from jointid.hardware.elmo.torque_source import AnalogInput, SensorScaling, SyncedConverter
from jointid.hardware.session.metadata import plain

_SOURCES = {kind.__name__: kind for kind in (AnalogInput, SyncedConverter)}


def elmo_options_document(options: ElmoOptions) -> dict[str, Any]:
    """Return the options as JSON's types; the torque sensor's kind is its "source"."""
    document: dict[str, Any] = plain(options)
    if options.torque is not None:
        document["torque"] = {"source": type(options.torque).__name__, **document["torque"]}
    return document


def elmo_options_of(metadata: Mapping[str, Any]) -> ElmoOptions:
    """Return the options that a recording's `drive_options` hold; the default ones where there are none.

    Raises
    ------
    InputError
        They are those of another drive, or of a later version.
    """
    recorded = metadata.get("drive_options")
    if recorded is None:
        return ElmoOptions()
    try:
        torque = recorded["torque"]
        if torque is not None:
            rest = {name: entry for name, entry in torque.items() if name != "source"}
            scaling = SensorScaling(**rest.pop("scaling"))
            torque = _SOURCES[torque["source"]](**rest, scaling=scaling)
        return ElmoOptions(**{**recorded, "torque": torque})
    except (KeyError, TypeError, AttributeError) as error:  # of what a file holds
        raise InputError(
            f"not the options of an Elmo drive ({error}); pass the options",
            argument="drive_options",
        ) from None
