"""Commissioning of a bench: run a joint, identify it, run it again with the estimate."""

from jointid.commissioning.cycles import commission
from jointid.commissioning.result import BenchRun, Commissioning

__all__ = ["BenchRun", "Commissioning", "commission"]
