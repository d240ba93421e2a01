"""The tasks of a page's process. Each has `report` as first argument, for progress."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.app.call import Call
from jointid.base.options import options_of
from jointid.base.values import dataclass

if TYPE_CHECKING:
    from jointid.comparison.result import Comparison
    from jointid.estimate.estimate import Estimate
    from jointid.recording.readers.table_preview import FirstLook
    from jointid.recording.recording import Recording

Report = Callable[[float, str], object]


@dataclass(frozen=True, slots=True, kw_only=True)
class Read:
    """A recording, and remarks about the reading."""

    recording: Recording
    remarks: tuple[str, ...]


def look(_report: Report, path: Path) -> FirstLook:
    """Return the content of a file."""
    from jointid.recording.readers.table_preview import first_look

    return first_look(path)


def read(_report: Report, call: Call) -> Read:
    """Return the complete recording."""
    from jointid.recording.file_remarks import remarks

    recording = call.recording()
    return Read(recording=recording, remarks=tuple(remarks(recording.metadata)))


def identify(report: Report, call: Call) -> tuple[Estimate, str]:
    """Return the estimate, and its report as a page."""
    from jointid._core import GaOptions, Generation
    from jointid.identification.search.search import Search
    from jointid.report.saving import report_page

    total = GaOptions().generations

    def shown(generation: Generation) -> None:
        report(generation.number / total, f"generation {generation.number} of {total}")

    search = Search.of(call.identify.get("search"))
    if search.chosen_method == "ga":
        search = replace(search, callback=shown)
    recordings = call.recordings()
    estimate = call.run(recordings, search=search)
    return estimate, report_page(estimate, recordings=recordings)


def compare(report: Report, call: Call, models: Sequence[str]) -> Comparison:
    """Return the comparison of some models; the default models if none is named."""
    from jointid.comparison.comparison import compare_models
    from jointid.comparison.fitter import ComparisonStep
    from jointid.identification.options import CompareOptions

    def shown(step: ComparisonStep) -> None:
        report(step.number / step.total, f"fit {step.number} of {step.total}: {step.model}")

    shared = options_of(CompareOptions).keys() - {"search"}
    arguments = {name: value for name, value in call.identify.items() if name in shared}
    if models:
        arguments["models"] = list(models)
    return compare_models(call.recordings(), call.joint, callback=shown, **arguments)
