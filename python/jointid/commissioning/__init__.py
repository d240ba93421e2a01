"""The ring closed on a bench: run a joint, identify it, run it again with what was identified."""

from jointid.commissioning.ring import BenchRun, Commissioning, bench_drive, commission

__all__ = ["BenchRun", "Commissioning", "bench_drive", "commission"]
