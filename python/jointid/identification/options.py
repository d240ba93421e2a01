"""Keyword arguments of `identify` and `compare`: settings of the problem and of the search."""

from typing import Annotated, TypedDict

from jointid.base.options import Option
from jointid.identification.search.search import Method, Search
from jointid.problem.settings import FitOptions, ProblemOptions


class SearchOptions(TypedDict, total=False):
    """Options of the search for the minimum."""

    search: Annotated[
        Search | Method | None,
        Option(
            kind="Search or str, optional",
            help='Settings of the search, or a method: "separable" (default), "ga" or "random".',
            checked=lambda _, value: Search.of(value),
        ),
    ]


class IdentifyOptions(ProblemOptions, SearchOptions, total=False):
    """Keyword arguments of `identify`."""


class CompareOptions(FitOptions, SearchOptions, total=False):
    """Options that all models of a comparison share."""

    min_speed: Annotated[
        float,
        Option(
            kind="float",
            help="Speed below which motion is left out, for all models [rad/s or m/s]. Default: 0 (no motion is left "
            "out).",
            default=0.0,
        ),
    ]
