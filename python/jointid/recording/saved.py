"""Reading the attributes of a saved recording, which are not columns."""

from __future__ import annotations

from jointid.base.errors import InputError
from jointid.recording.signals import KINDS

SCHEMA = 1
CSV_MARK = "# jointid recording "
NPZ_MEMBER = "jointid_recording"
ATTRIBUTES = ("name", "kind", "torque_hold", "velocity_derived", "metadata", "truth")


def saved_attributes(text: str, place: str) -> dict[str, object]:
    """Return the attributes of a saved recording: name, kind, torque hold, metadata, ...

    Parameters
    ----------
    text : str
        JSON text from `save_recording`.
    place : str
        File and line, for messages.

    Raises
    ------
    InputError
        The text is not from `save_recording`, or a later version wrote it.
    """
    from jointid.base.schema import read_json
    from jointid.recording.saved_schema import SAVED

    try:
        attributes = read_json(text)
    except InputError as error:
        reason = f"the description of the recording is damaged JSON ({error.reason})"
        raise InputError(reason, place=place) from None
    if not isinstance(attributes, dict):
        raise InputError("the description of the recording is not a JSON object", place=place)
    schema = attributes.get("schema")
    if schema != SCHEMA:
        raise InputError(
            f"this version of jointid reads schema {SCHEMA}; a later version may have written the recording",
            argument="schema",
            value=schema,
            place=place,
        )
    kind = attributes.get("kind", KINDS[0])
    if kind not in KINDS:
        raise InputError(
            f"{' or '.join(KINDS)} is expected", argument="kind", value=kind, place=place
        )
    try:
        checked = SAVED.read(attributes, "")
    except InputError as error:
        raise error.at(place) from None
    return {key: checked[key] for key in (*ATTRIBUTES, "robot") if key in checked}
