"""A session on a real joint, or an emulated one: drives over CAN, limits, recording. No analysis here."""

from jointid.hardware.elmo_codec import Command, DriveError, Reply

__all__ = ["Command", "DriveError", "Reply"]
