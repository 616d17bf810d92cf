"""Sweeps: every design of a study evaluated, on one machine or many, and kept.

plan (the designs by number) → settings (``[sweep]`` of a study file) → worker (evaluates a chunk)
→ pool, cluster (where workers are), flight (chunks through them) → manifest (what results are of),
store (their parts in a folder), lock (one writer) → task (what is left) → result → run (the whole).
"""

from railride.sweeps.result import SweepResult, read_sweep
from railride.sweeps.run import sweep
from railride.sweeps.settings import SweepSettings, read_sweep_study

__all__ = ["SweepResult", "SweepSettings", "read_sweep", "read_sweep_study", "sweep"]
