"""What `identify` and `compare` take by keyword: the settings of the problem, and the search."""

from typing import Annotated, TypedDict

from jointid.base.options import Option
from jointid.identification.search.search import Method, Search
from jointid.problem.settings import FitOptions, ProblemOptions


class SearchOptions(TypedDict, total=False):
    """How the minimum is searched."""

    search: Annotated[
        Search | Method | None,
        Option(
            kind="Search or str, optional",
            help='Settings of the search, or a method: "separable" (default), "ga" or "random".',
            checked=lambda _, value: Search.of(value),
        ),
    ]


class IdentifyOptions(ProblemOptions, SearchOptions, total=False):
    """All that `identify` takes besides recordings and joint."""


class CompareOptions(FitOptions, SearchOptions, total=False):
    """What all models of a comparison share; they are judged from a speed on."""

    min_speed: Annotated[
        float,
        Option(
            kind="float",
            help="As in `identify`, the same for all models. Default 0: all motion is judged.",
            default=0.0,
        ),
    ]
