"""The gallery: a page for each finding, with a recording that has it: symptom, cause, picture, remedy.

What a finding means and what to do comes from the registry of the checks, its sentence from the identification of a
recording that was made for it.
"""

from __future__ import annotations

import re
import tempfile
from html import escape
from pathlib import Path

import jointid as jid
from documentation.defective import GOOD, Case, cases
from documentation.pictures import friction, windows
from documentation.staging import Stage
from documentation.symptoms import SYMPTOMS
from jointid.base.html import Html
from jointid.cli.advice import words_of_action
from jointid.estimate.findings import Finding
from jointid.identification.warnings.check import FindingType
from jointid.identification.warnings.registry import finding_types

_KINDS = {
    "blocking": "Blocking: the values cannot be used before the cause is removed.",
    "warning": "Warning: values may be biased, or less certain than usual.",
    "info": "Info: worth knowing; values are not affected.",
}


def write_pictures(stage: Stage) -> None:
    """Put the pictures of recordings without a defect there: a real joint's friction, and windows."""
    joint = GOOD.parent / "kr300_joint1.toml"
    real = jid.load(joint.with_suffix(".csv.gz"))
    found = jid.identify(real, jid.Joint.load(joint), search="separable")
    stage.write("generated/friction_map.html", _framed(friction(real, found)))
    good = jid.load(GOOD)
    estimate = jid.identify(good, jid.thesis_joint(), search="separable")
    stage.write("generated/windows.html", _framed(windows(good, estimate)))


def write_gallery(stage: Stage) -> None:
    """Put a page for each finding there, and one with all of them."""
    pictures = {}
    with tempfile.TemporaryDirectory() as folder:
        made = cases(Path(folder))
        for code, each in finding_types().items():
            found, pictures[code] = _shown(code, made[code])
            stage.write(f"gallery/{code}.md", _page(each, made[code], found, pictures[code]))
    stage.write("gallery/index.md", _overview(pictures))


def _shown(code: str, case: Case) -> tuple[Finding, str]:
    """The finding of a case, and the picture of it."""
    estimate = case.estimate()
    found = next((each for each in estimate.findings if each.code == code), None)
    if found is None:
        raise LookupError(f"the recording that is made for {code} does not have that finding")
    draw = SYMPTOMS[code].picture
    if draw is None:
        return found, f"<pre>{escape(case.text)}\n…</pre>"
    return found, _framed(draw(case.recording, estimate))


def _framed(figure: Html) -> str:
    """A picture, with the frame that the style sheet knows."""
    return f'<div class="jointid-picture">{figure}</div>'


def _page(each: FindingType, case: Case, found: Finding, picture: str) -> str:
    lines = [
        f"# `{each.code}`",
        "",
        f"**What you see.** {SYMPTOMS[each.code].seen}",
        "",
        *_raw(picture),
        *(
            ["```text", case.text, "…", "```", ""]
            if case.text and SYMPTOMS[each.code].picture
            else []
        ),
        "## Cause",
        "",
        f"{_KINDS[each.severity]} It is raised when: {each.meaning}.",
        "",
        "Of the recording in the picture, `identify` says:",
        "",
        f"> {_plain(found.cause)}.",
        "",
        "## Remedy",
        "",
        f"{each.advice[:1].upper()}{each.advice[1:]}.",
        "",
    ]
    python = [str(action) for action in found.advice]
    shell = [text for action in found.advice if (text := words_of_action(action, "identify"))]
    if python:
        lines += ["Advice for this recording, in Python:", ""]
        lines += [f"- {_code(text)}" for text in python] + [""]
    if shell and shell != python:
        lines += ["On the command line:", "", *(f"- {_code(text)}" for text in shell), ""]
    lines += [
        "[All findings in one table](../findings.md) · [how to read a finding](../how_to/read_a_finding.md)",
        "",
    ]
    return "\n".join(lines)


def _plain(text: str) -> str:
    """A sentence that Markdown shows as it is."""
    return text.replace("_", "\\_").replace("*", "\\*").replace("<", "&lt;").replace("|", "\\|")


def _code(text: str) -> str:
    """An advice: what can be pasted stands behind "with" or "by", and what it is for in brackets behind that."""
    code = r"(?=--|jointid |[\w.]+[=(])[^`]+?"
    found = re.fullmatch(rf"(.*?\b(?:with|designed by)) ({code})( \([^()]*\))?", text)
    if found is None:
        return _plain(text)
    return f"{found[1]} `{found[2]}`{_plain(found[3] or '')}"


def _raw(html: str) -> list[str]:
    return ["```{raw} html", html, "```", ""]


def _overview(pictures: dict[str, str]) -> str:
    types = finding_types()
    lines = [
        "# Gallery of findings",
        "",
        "Each picture shows a recording that was made with one defect, and what `identify` finds in it. "
        "Look for what your own signals look like; each page has the cause and the remedy. "
        "Nothing found means that nothing suspicious was found, not that the joint is as modelled.",
        "",
    ]
    for severity, meaning in _KINDS.items():
        lines += [f"## {severity.capitalize()}", "", meaning.partition(": ")[2].capitalize(), ""]
        cards = [
            f'<a class="card" href="{code}.html">{pictures[code]}<code>{code}</code>'
            f"<span>{escape(SYMPTOMS[code].seen)}</span></a>"
            for code, each in types.items()
            if each.severity == severity
        ]
        lines += _raw(f'<div class="cards pictures">{"".join(cards)}</div>')
    names = [f"{code} <{code}>" for code in types]
    lines += ["```{toctree}", ":hidden:", "", *names, "```", ""]
    return "\n".join(lines)
