"""Errors and findings in the words of a command: its options instead of Python's arguments."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.errors import NOT_GIVEN, InputError
from jointid.cli.advice import MODEL_FIELDS, model_text, option_with_value, words_of_action
from jointid.cli.options import FLAGS, PLACEHOLDERS, option_of
from jointid.cli.values import in_sentence

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate

_OWN_FILE = re.compile(r"\.(?:toml|json|jsonl)\b")


@dataclass(frozen=True, slots=True)
class Wording:
    """How one command words a value.

    Parameters
    ----------
    command : str
        "identify", "compare", …
    model : str
        The one model that the command was called with. Default: none, or several.
    grid : frozenset of str
        Settings that ``--grid`` names. Default: none.
    """

    command: str
    model: str = ""
    grid: frozenset[str] = frozenset()

    @classmethod
    def of(cls, arguments: argparse.Namespace) -> Wording:
        """The wording for a command line that was read."""
        models = getattr(arguments, "models", None) or [getattr(arguments, "model", None)]
        return cls(
            arguments.command,
            models[0] if len(models) == 1 and models[0] else "",
            frozenset(name for name, _ in getattr(arguments, "grid", ())),
        )

    def of_error(self, error: InputError) -> str:
        """An error in one line: where, what, why, and what to do."""
        if type(error).__str__ is not InputError.__str__:  # it words itself
            return " ".join(str(error).split())
        subject = self._subject(error)
        sentence = f"{subject}: {error.reason}" if subject else error.reason
        place = f"{error.place}: " if error.place else ""
        remedies = self._alternatives(error.remedy)
        return " ".join(f"{place}{sentence}{f'; {remedies}' if remedies else ''}".split())

    def of_finding(self, finding: Any) -> str:
        """A finding in one line: its cause, and what to do."""
        if not hasattr(finding, "advice"):
            return str(finding)
        advice = self._alternatives(finding.advice)
        return f"{finding.cause}; {advice}" if advice else str(finding.cause)

    def of_report(self, estimate: Estimate) -> str:
        """An estimate's report as text, its findings in the words of the command."""
        from jointid.estimate.tables import text_report

        return text_report(estimate, finding_text=self.of_finding)

    def _alternatives(self, remedies: tuple[str | Action, ...]) -> str:
        texts = [
            each if isinstance(each, str) else words_of_action(each, self.command, self.model)
            for each in remedies
        ]
        return " or ".join(text for text in texts if text)

    def _subject(self, error: InputError) -> str:
        """What cannot be used: an option with its value, a key of a file, or a plain name."""
        name, value = error.argument, error.value
        known = value is not NOT_GIVEN
        if not name:
            return in_sentence(value) if known else ""
        if not _OWN_FILE.search(error.place):
            if name in self.grid:
                return option_with_value("--grid", name, value) if known else f"--grid {name}"
            field = name.removeprefix("model.")
            if (
                field in MODEL_FIELDS
                and known
                and self.model
                and option_of(self.command, "model")[0]
            ):
                return f"--model {model_text(self.model, {field: value})}"
            option, key = option_of(self.command, name)
            if option:
                return _typed(option, key, value)
        return f"{name} is {in_sentence(value)}" if known else name


def _typed(option: str, key: str, value: Any) -> str:
    """An option as the user typed it, so far as that is known."""
    if option in PLACEHOLDERS and not key:
        if isinstance(value, str):  # only the name behind the option
            return f"{option} {in_sentence(value)}"
        if not isinstance(value, dict) or len(value) != 1:
            return option
        ((key, value),) = value.items()
    if value is NOT_GIVEN or (option in FLAGS and isinstance(value, bool)):
        return f"{option} {key}".rstrip()
    if option in PLACEHOLDERS or not key:
        return option_with_value(
            option, key, in_sentence(value) if isinstance(value, str) else value
        )
    return f"{option}: {key} is {in_sentence(value)}"
