"""The loop closed on a bench: run a joint, identify it, run it again with the estimate."""

from jointid.commissioning.ring import BenchRun, Commissioning, commission

__all__ = ["BenchRun", "Commissioning", "commission"]
