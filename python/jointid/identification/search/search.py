"""Settings of a search: method, budget, seed, checkpoint."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Literal, cast, get_args

from jointid import _core
from jointid.base.argument_checks import require_path, whole_number
from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import check_choice

Callback = Callable[[_core.Generation], bool | None]
StatePath = str | os.PathLike[str]

Method = Literal["separable", "ga", "random"]
Preset = Literal["default", "thesis", "thesis_code"]
METHODS: tuple[str, ...] = get_args(Method)
PRESETS: Mapping[str, Callable[[], _core.GaOptions]] = MappingProxyType(
    {
        "default": _core.GaOptions,
        "thesis": _core.GaOptions.thesis,
        "thesis_code": _core.GaOptions.thesis_code,
    }
)


@dataclass(frozen=True, slots=True)
class Search:
    """Settings of the search for the minimum of the penalty.

    Parameters
    ----------
    method : {"separable", "ga", "random"}, optional
        "separable" eliminates the linear parameters exactly and searches only the shape parameters. "ga" runs a
        genetic algorithm and then a local search. With the model "stribeck_general" and 12,000 samples, "ga" takes
        seven times as long as "separable". "random" is a random search for comparison, with the evaluations of the
        genetic algorithm and no local search. Default: "ga" if `ga`, `callback`, `checkpoint` or `resume` is set,
        otherwise "separable".
    ga : GaOptions or {"default", "thesis", "thesis_code"}, optional
        Settings of the genetic algorithm. Default "default".
    seed : int
        Random seed. The same seed gives bit-identical results for any number of threads. Default 0.
    threads : int
        Number of threads. Default 0: all processors.
    callback : callable, optional
        Function that the search calls with each `Generation`. If the function returns True, the search stops.
        "separable" has no generations and does not call the function.
    checkpoint : path, optional
        File for the state of the genetic search. The search replaces the file every 50 generations and at the end.
    resume : path, optional
        Checkpoint from which the search continues. The result is bit-identical to that of an uninterrupted search.

    Raises
    ------
    InputError
        A field is invalid, or `checkpoint` or `resume` is set with a method other than "ga".

    Examples
    --------
    >>> Search(seed=3).chosen_method
    'separable'
    >>> search = Search(ga=jid.GaOptions(population=50), seed=3)
    >>> search.chosen_method, search.genetic.population
    ('ga', 50)
    >>> seen = []
    >>> estimate = jid.identify(recording, joint, model="stribeck", search=Search(callback=seen.append))
    >>> isinstance(seen[-1], jid.Generation), seen[-1].best <= seen[0].best
    (True, True)
    """

    method: Method | None = None
    ga: _core.GaOptions | Preset | None = None
    seed: int = 0
    threads: int = 0
    callback: Callback | None = None
    checkpoint: StatePath | None = None
    resume: StatePath | None = None

    def __post_init__(self) -> None:
        if self.method is not None:
            check_choice("", "method", self.method, METHODS)
        if isinstance(self.ga, str):
            check_choice("", "ga", self.ga, PRESETS)
        elif self.ga is not None and not isinstance(self.ga, _core.GaOptions):
            raise InputError(
                f"GaOptions or one of {', '.join(PRESETS)} is expected",
                argument="ga",
                value=self.ga,
            )
        object.__setattr__(self, "seed", whole_number("seed", self.seed, 0, 2**64 - 1))
        object.__setattr__(self, "threads", whole_number("threads", self.threads, 0, 1024))
        for name in ("checkpoint", "resume"):
            if getattr(self, name) is not None:
                require_path(name, getattr(self, name))
                if self.chosen_method != "ga":
                    raise InputError(
                        "only the method ga can write or resume a checkpoint",
                        argument="method",
                        value=self.method,
                    )
        if self.callback is not None and not callable(self.callback):
            raise InputError("a function is expected", argument="callback", value=self.callback)

    @classmethod
    def of(cls, value: object) -> Search:
        """Return a search from a search, the name of a method, or None.

        Parameters
        ----------
        value : Search, str or None

        Raises
        ------
        InputError
            The value has a wrong type, or the method is unknown.
        """
        if isinstance(value, Search):
            return value
        if value is None:
            return cls()
        if isinstance(value, str):
            return cls(cast("Method", value))  # the constructor checks it
        raise InputError(
            "a Search or the name of a method is expected", argument="search", value=value
        )

    @property
    def chosen_method(self) -> Method:
        """Method that runs: `method` if it is set, otherwise its default."""
        if self.method is not None:
            return self.method
        stated = (self.ga, self.callback, self.checkpoint, self.resume)
        return "separable" if all(each is None for each in stated) else "ga"

    @property
    def genetic(self) -> _core.GaOptions:
        """Settings of the genetic algorithm; the preset's settings if `ga` is the name of a preset."""
        ga = self.ga or "default"
        return PRESETS[ga]() if isinstance(ga, str) else ga
