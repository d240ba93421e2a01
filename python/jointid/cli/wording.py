"""Errors and findings in the words of a command, with its options instead of Python's arguments."""

from __future__ import annotations

import argparse
import re
import shlex
from typing import TYPE_CHECKING, Any

from jointid.base.advice import Action
from jointid.base.error_text import on_one_line
from jointid.base.errors import NOT_GIVEN, InputError
from jointid.base.values import dataclass
from jointid.cli.advice import command_of_action, option_with_value, words_of_action
from jointid.cli.facts_advice import words_of_facts
from jointid.cli.options import FLAGS, OPTIONS, PLACEHOLDERS, option_of
from jointid.cli.values import as_typed, behind_option, in_sentence

if TYPE_CHECKING:
    from jointid.estimate.estimate import Estimate

_OWN_FILE = r"\.(?:toml|json|jsonl)\b"


@dataclass(frozen=True, slots=True)
class Wording:
    """Wording of one command.

    Parameters
    ----------
    command : str
        Name of the command: "identify", "compare", …
    model : str
        Model of the command line, if it has exactly one. Default: none or several.
    grid : frozenset of str
        Settings that ``--grid`` names. Default: none.
    joint_file : str
        Joint file that the command reads. Default: none.
    saved : str
        File (.json) in which the command saves its estimate. Default: none.
    typed : tuple of str
        Words of the command line, the command first. Default: not known.
    facts : str
        File with the facts of a robot. Default: none.
    joint : str
        Name of the joint, if the file has several. Default: the file has one.
    """

    command: str
    model: str = ""
    grid: frozenset[str] = frozenset()
    joint_file: str = "the joint file"
    saved: str = "ESTIMATE"
    joint: str = ""
    typed: tuple[str, ...] = ()
    facts: str = ""

    @classmethod
    def of(cls, arguments: argparse.Namespace) -> Wording:
        """Return the wording for a parsed command line."""
        from jointid.cli.outputs import estimate_file

        models = getattr(arguments, "models", None) or [getattr(arguments, "model", None)]
        saved = estimate_file(arguments)
        return cls(
            arguments.command,
            models[0] if len(models) == 1 and models[0] else "",
            frozenset(name for name, _ in getattr(arguments, "grid", ())),
            str(getattr(arguments, "joint", None) or "the joint file"),
            "ESTIMATE" if saved is None else str(saved),
            typed=getattr(arguments, "typed", ()),
            facts=str(getattr(arguments, "facts", None) or ""),
        )

    @property
    def saved_file(self) -> str:
        """Return the file of the estimate; empty if none is written."""
        return "" if self.saved == "ESTIMATE" else self.saved

    def of_error(self, error: InputError) -> str:
        """Return an error in one line: place, subject, reason, and remedy."""
        if type(error).__str__ is not InputError.__str__:  # it has its own text
            return " ".join(str(error).split())
        place, name = self._located(error)
        subject = self._subject(place, name, error.value)
        sentence = ": ".join(filter(None, (place, subject, error.reason)))
        remedies = self._alternatives(error.remedy)
        return on_one_line(" ".join(f"{sentence}{f'; {remedies}' if remedies else ''}".split()))

    def of_action(self, action: Action) -> str:
        """Return the advice with the command's options; empty if the command line cannot follow it."""
        if action.designs:
            from jointid.cli.next_motion import words_of_next_motion

            joint = (
                "JOINT" if self.joint_file == "the joint file" else behind_option(self.joint_file)
            )
            return words_of_next_motion(action, joint, behind_option(self.saved), self.joint)
        if action.function == "Robot.from_urdf":
            return words_of_facts(action, self.facts)
        named = self.joint_file != "the joint file"
        words = words_of_action(action, self.command, self.model, file=named)
        return words.replace("the joint file", self.joint_file)

    def of_command(self, action: Action) -> str:
        """Return one command that can be pasted, or one plain action."""
        if action.designs:
            return self._recording(action)
        named = self.joint_file != "the joint file"
        command = command_of_action(action, self.command, self.typed, self.model, file=named)
        if action.kind == "call":
            return command or self.of_action(action)
        return f"{action.kind} {action.text}"

    def _recording(self, action: Action) -> str:
        """Return the advice to record another motion: from the saved estimate, if the user needs to add nothing."""
        from jointid.cli.next_motion import runs_as_printed

        if not self.saved_file or not runs_as_printed(action):
            return f"record {action.text}"
        of_joint = ["--after-joint", self.joint] if self.joint else []
        words = ["design", "--after", self.saved, *of_joint, "--output", "motion.toml"]
        return f"jointid {shlex.join(words)}"

    def of_answer(self, estimate: Estimate, *, verbose: bool) -> str:
        """Return an estimate in a few lines, or its complete report, with commands as advice."""
        from jointid.estimate.answers import answer
        from jointid.estimate.tables import text_report

        if verbose:
            return text_report(estimate, self.of_command)
        return answer(estimate, self.of_command, self.saved_file)

    def _alternatives(self, remedies: tuple[str | Action, ...]) -> str:
        texts = [each if isinstance(each, str) else self.of_action(each) for each in remedies]
        options = any(isinstance(each, Action) for each in remedies)  # each one is pasted alone
        return ("; or " if options else " or ").join(text for text in texts if text)

    def _located(self, error: InputError) -> tuple[str, str]:
        """Return the place and the subject of an error. A place with an option is part of the name."""
        place, name = error.place, error.argument
        options = OPTIONS.get(self.command, {})
        parameter = place.removeprefix("parameter '").removesuffix("'")
        if place in options and name:
            return "", f"{place}.{name}"
        if parameter != place and name == "value" and "parameters" in options:
            return "", f"parameters.{parameter}"
        return place, name

    def _subject(self, place: str, name: str, value: Any) -> str:
        """Return the subject that cannot be used: an option with its value, a key of a file, or a plain name."""
        known = value is not NOT_GIVEN
        if not name:
            return in_sentence(value) if known else ""
        if not re.search(_OWN_FILE, place):
            if name in self.grid:
                return option_with_value("--grid", name, value) if known else f"--grid {name}"
            if subject := self._in_model(name):
                return subject
            option, key = option_of(self.command, name)
            if option:
                return _typed(option, key, value)
        return f"{name} is {in_sentence(value)}" if known else name

    def _in_model(self, name: str) -> str:
        """Return the model as it was typed, and the affected option of the model, if any."""
        field = name.removeprefix("model.")
        stated = re.split("[:=]", self.model)
        if not self.model or "model" not in OPTIONS.get(self.command, {}):
            return ""
        if field in ("name", "model"):
            return f"--model {as_typed(self.model)}"
        return f"--model {as_typed(self.model)}, {field}" if field in stated else ""


ADVICE = Wording("identify")
"""Wording for pages: advice is followed by a new identification."""


def _typed(option: str, key: str, value: Any) -> str:
    """Return an option as the user typed it, as far as known."""
    if option in PLACEHOLDERS and not key:
        if isinstance(value, str):  # only the name behind the option
            return f"{option} {as_typed(value)}"
        if not isinstance(value, dict) or len(value) != 1:
            return option
        ((key, value),) = value.items()
    if value is NOT_GIVEN or (option in FLAGS and isinstance(value, bool)):
        return f"{option} {key}".rstrip()
    if option in PLACEHOLDERS or not key:
        return option_with_value(option, key, as_typed(value) if isinstance(value, str) else value)
    return f"{option}: {key} is {in_sentence(value)}"
