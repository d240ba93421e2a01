"""The site's page of findings. Each section has a recording with the finding: picture, meaning, remedy.

Meaning and remedy come from the registry of the checks. The sentence comes from the identification of a recording that
was made for the finding.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import get_args

import jointid as jid
from documentation.defective import GOOD, Case, cases
from documentation.findings_tables import in_place_of_the_table
from documentation.pictures import friction, windows
from documentation.staging import ROOT, Stage
from documentation.symptoms import SYMPTOMS
from jointid.base.html import Html
from jointid.cli.advice import words_of_action
from jointid.estimate.findings import Finding, Severity
from jointid.identification.warnings.check import FindingType
from jointid.identification.warnings.registry import finding_types


def write_pictures(stage: Stage) -> None:
    """Write the pictures of recordings without a defect: a real joint's friction, and windows."""
    joint = GOOD.parent / "kr300_joint1.toml"
    real = jid.load(joint.with_suffix(".csv.gz"))
    found = jid.identify(real, jid.Joint.load(joint), search="separable")
    stage.write("generated/friction_map.html", _framed(friction(real, found)))
    good = jid.load(GOOD)
    estimate = jid.identify(good, jid.thesis_joint(), search="separable")
    stage.write("generated/windows.html", _framed(windows(good, estimate)))


def write_findings(stage: Stage) -> None:
    """Write the page of findings, with a section for each finding instead of its table."""
    sections = {}
    with tempfile.TemporaryDirectory() as folder:
        made = cases(Path(folder))
        for code, each in finding_types().items():
            found, picture = _shown(code, made[code])
            sections[code] = _section(each, made[code], found, picture)
    page = (ROOT / "docs" / "findings.md").read_text(encoding="utf-8")
    page = in_place_of_the_table(page, listed_sections(sections))
    stage.write("findings.md", stage.relinked(page, "docs/findings.md", "findings.md"))


def _shown(code: str, case: Case) -> tuple[Finding, str]:
    """Return the finding of a case, and its picture."""
    estimate = case.estimate()
    found = next((each for each in estimate.findings if each.code == code), None)
    if found is None:
        raise LookupError(f"the recording for {code} does not have that finding")
    draw = SYMPTOMS[code].picture
    if draw is None:
        return found, f"<pre>{escape(case.text)}\n…</pre>"
    return found, _framed(draw(case.recording, estimate))


def _framed(figure: Html) -> str:
    """Return a picture in the frame of the style sheet."""
    return f'<div class="jointid-picture">{figure}</div>'


def _section(each: FindingType, case: Case, found: Finding, picture: str) -> str:
    lines = [
        f"#### `{each.code}`",
        "",
        f"**What you see.** {SYMPTOMS[each.code].seen}",
        "",
        *_raw(picture),
        *(
            ["```text", case.text, "…", "```", ""]
            if case.text and SYMPTOMS[each.code].picture
            else []
        ),
        f"**Meaning.** {_sentence(each.meaning)}",
        "",
        "For the recording in the picture, `identify` says:",
        "",
        f"> {_plain(found.cause)}.",
        "",
        f"**What to do.** {_sentence(each.advice)}",
        "",
    ]
    python = [str(action) for action in found.advice]
    shell = [words_of_action(action, "identify") for action in found.advice]
    shell = [text for text in shell if text and text not in python]
    if python:
        lines += ["For this recording, in Python:", ""]
        lines += [f"- {_code(text)}" for text in python] + [""]
    if shell:
        lines += ["On the command line:", "", *(f"- {_code(text)}" for text in shell), ""]
    return "\n".join(lines)


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}."


def _plain(text: str) -> str:
    """Return a sentence that Markdown shows unchanged."""
    return text.replace("_", "\\_").replace("*", "\\*").replace("<", "&lt;").replace("|", "\\|")


def _code(text: str) -> str:
    """Format an advice: code to paste follows "with" or "by", and its purpose follows in brackets."""
    code = r"(?=--|jointid |[\w.]+[=(])[^`]+?"
    found = re.fullmatch(rf"(.*?\b(?:with|designed by)) ({code})( \([^()]*\))?", text)
    if found is None:
        return _plain(text)
    return f"{found[1]} `{found[2]}`{_plain(found[3] or '')}"


def _raw(html: str) -> list[str]:
    return ["```{raw} html", html, "```", ""]


def listed_sections(sections: Mapping[str, str]) -> str:
    """Return the list of all findings, and the section of each, by severity.

    Parameters
    ----------
    sections : mapping of str to str
        By code.
    """
    codes = {
        severity: [code for code, each in finding_types().items() if each.severity == severity]
        for severity in get_args(Severity)[::-1]
    }
    lines = ["Each picture shows a recording that was made with one defect.", ""]
    for severity, listed in codes.items():
        links = " · ".join(f"[`{code}`](#{code})" for code in listed)
        lines += [f"**{severity.capitalize()}:** {links}", ""]
    for severity, listed in codes.items():
        lines += [f"### {severity.capitalize()}", "", *(sections[code] for code in listed)]
    return "\n".join(lines)
