"""Commissioning of a bench: run a joint, identify it, run it again with the estimate."""

from jointid.commissioning.result import BenchRun, Commissioning
from jointid.commissioning.ring import commission

__all__ = ["BenchRun", "Commissioning", "commission"]
