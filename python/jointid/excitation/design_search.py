"""Settings and progress of the search for a motion."""

from __future__ import annotations

from dataclasses import dataclass

from jointid import _core
from jointid.base.argument_checks import whole_number

_POPULATION = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSearch:
    """Settings of the search for a motion.

    Parameters
    ----------
    evaluations : int
        Approximate number of motions to try. Default 3600: the search takes a few seconds for 12 s of motion.
    joints : int
        Number of joints drawn from the prior to evaluate each motion. Default 4.
    rehearsals : int
        Number of simulated noisy recordings, from which the errors of the chosen motion are computed. Default 256.
    seed : int
        Random seed. The same seed gives the same motion with any number of threads. Default 0.
    threads : int
        Number of threads. Default 0: all processors.

    Raises
    ------
    InputError
        A value is invalid.

    Examples
    --------
    >>> search = DesignSearch(evaluations=500, seed=1)
    """

    evaluations: int = 3600
    joints: int = 4
    rehearsals: int = 256
    seed: int = 0
    threads: int = 0

    def __post_init__(self) -> None:
        for name, low, high in (
            ("evaluations", 2 * _POPULATION, 10_000_000),
            ("joints", 1, 1000),
            ("rehearsals", 10, 100_000),
            ("seed", 0, 2**63 - 1),
            ("threads", 0, 1024),
        ):
            whole_number(f"search.{name}", getattr(self, name), low, high)

    def options(self, share: float) -> _core.GaOptions:
        """Return the genetic algorithm's options for a share of the evaluations."""
        generations = round(share * self.evaluations / (_POPULATION - _core.GaOptions().elite)) - 1
        return _core.GaOptions(
            population=_POPULATION, generations=max(1, generations), polish=False
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignProgress:
    """Progress of the search for a motion.

    Attributes
    ----------
    number, total : int
        Number of motions tried so far, and total number of motions.
    best : float
        Criterion of the best motion so far, as a relative error.

    Examples
    --------
    >>> said = []
    >>> search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)
    >>> design = jid.design(known, {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}, duration=4.0,
    ...     search=search, callback=said.append)
    >>> isinstance(said[-1], jid.DesignProgress)
    True
    """

    number: int
    total: int
    best: float
