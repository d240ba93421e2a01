"""The summary of an estimate for a report page."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

from jointid.base.result import Overview, Quantity
from jointid.estimate.derived import DerivedValue, derived_values
from jointid.estimate.record import EstimateRecord
from jointid.estimate.statistics import ParameterEstimate
from jointid.estimate.tables import quality, recorded, remark, shown_name, subject, systematic
from jointid.estimate.verdict import judged


def overview_of(estimate: EstimateRecord) -> Overview:
    """Return the report page's summary of an estimate."""
    return Overview(
        title=f"{subject(estimate)}: friction",
        footer=made_by(estimate.settings),
        verdict=judged(estimate),
        answer=() if estimate.selection is None else (f"Model: {estimate.selection.sentence}.",),
        parameters=(
            *map(quantity_of, estimate.parameters.values()),
            *map(_derived, derived_values(estimate).values()),
        ),
        fit=tuple(quality(estimate)),
        facts=tuple(recorded(estimate)),
        findings=estimate.findings,
        settings=settings_of(estimate.settings, without=("recordings", "version")),
    )


def made_by(settings: Mapping[str, Any]) -> str:
    """Return the version, the seed and the recordings of an estimate with these settings."""
    runs = "; ".join(
        f"{run['name'] or 'recording'} ({run['fingerprint']})" for run in settings["recordings"]
    )
    return f"jointid {settings['version']}, seed {settings['seed']}; {runs}"


def quantity_of(p: ParameterEstimate, name: str = "") -> Quantity:
    """Return a parameter as a row of a table, under its own name or another one."""
    return _quantity(p, name or shown_name(p.name), p.shown_value, remark(p))


def _derived(each: DerivedValue) -> Quantity:
    return _quantity(each, shown_name(each.name), each.value, f"= {each.formula}")


def _quantity(p: ParameterEstimate | DerivedValue, name: str, value: float, text: str) -> Quantity:
    endless = p.stderr is not None and not math.isfinite(p.stderr)
    return Quantity(
        name=name,
        value=value if math.isfinite(value) else None,
        error=None if endless else p.stderr,
        systematic=systematic(p),
        unit=p.unit,
        meaning=p.meaning,
        remark=text or "not determined" * endless,
    )


def settings_of(
    settings: Mapping[str, Any], without: Collection[str] = ()
) -> tuple[tuple[str, str], ...]:
    """Return settings as label and text, without these names and without unset settings."""
    pairs = ((name, _text(value)) for name, value in settings.items() if name not in without)
    return tuple((name.replace("_", " "), text) for name, text in pairs if text)


def _text(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Mapping):
        inner = ((name, _text(each)) for name, each in value.items())
        return ", ".join(f"{name} {text}" for name, text in inner if text)
    if isinstance(value, list | tuple):
        return ", ".join(filter(None, map(_text, value)))
    return f"{value:.6g}" if isinstance(value, float) else str(value)
