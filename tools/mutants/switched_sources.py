"""C++ sources with all mutants, of which a number chooses one at run time."""

from __future__ import annotations

import re
from pathlib import Path

from mutants.catalogue import Mutant, MutantError

# `const`: the answer depends only on the number, so loops may ask once.
_DECLARED = "[[gnu::const]] bool jointid_mutant(int number) noexcept;"
SWITCH = f"""#include <cstdlib>

{_DECLARED}

bool jointid_mutant(int number) noexcept {{
  static const char* const chosen = std::getenv("JOINTID_MUTANT");
  static const int active = chosen != nullptr ? std::atoi(chosen) : 0;
  return number == active;
}}
"""
_CONSTANT = re.compile(r"\bconstexpr\b")


def switched(text: str, mutants: list[Mutant]) -> str:
    """Return the file's text with a switch at each mutant's place.

    An expression becomes `(jointid_mutant(N) ? (new) : (old))`; a statement becomes `if` and `else`. A constant is no
    longer known to the compiler.

    Raises
    ------
    MutantError
        If two mutants overlap and none contains the other.
    """
    spans = sorted(((*each.place(text), each) for each in mutants), key=lambda s: (s[0], -s[1]))
    for begin, _, _ in spans:
        statement = max(text.rfind(end, 0, begin) for end in ";{}") + 1
        # The length stays the same, so places stay.
        plain = _CONSTANT.sub("const    ", text[statement:begin])
        text = text[:statement] + plain + text[begin:]
    return f"{_DECLARED}\n#line 1\n{_rewritten(text, 0, len(text), spans)}"


def _rewritten(text: str, begin: int, end: int, spans: list[tuple[int, int, Mutant]]) -> str:
    made, here = "", begin
    while spans:
        first, last, _ = spans[0]
        same = [mutant for start, stop, mutant in spans if (start, stop) == (first, last)]
        inner = [each for each in spans if each[0] < last and (each[0], each[1]) != (first, last)]
        if any(stop > last for _, stop, _ in inner):
            raise MutantError(f"{same[0].path}: two mutants overlap at `{text[first:last]}`")
        spans = [each for each in spans if each[0] >= last]
        old = _rewritten(text, first, last, inner)
        made += text[here:first] + _choice(old, same)
        here = last
    return made + text[here:end]


def _choice(old: str, mutants: list[Mutant]) -> str:
    if old.endswith(";"):
        cases = "".join(f"if (jointid_mutant({m.number})) {{ {m.becomes} }} else " for m in mutants)
        return f"{{ {cases}{{ {old} }} }}"
    cases = "".join(f"jointid_mutant({m.number}) ? ({m.becomes}) : " for m in mutants)
    return f"({cases}({old}))"


def write(tree: Path, mutants: list[Mutant]) -> None:
    """Rewrite the sources of a copy of the repository, and add the switch to its build."""
    for path in sorted({each.path for each in mutants}):
        file = tree / path
        here = [each for each in mutants if each.path == path]
        file.write_text(switched(file.read_text(encoding="utf-8"), here), encoding="utf-8")
    (tree / "cpp" / "jointid_mutant.cpp").write_text(SWITCH, encoding="utf-8")
    build = tree / "CMakeLists.txt"
    text = build.read_text(encoding="utf-8")
    # Compiling takes longer than the trials. This halves its time, with the same bits.
    changes = {
        "add_library(core STATIC)": "add_library(core STATIC cpp/jointid_mutant.cpp)",
        ":-O3>": ":-O1>",
    }
    for old, new in changes.items():
        if text.count(old) != 1:
            raise MutantError(
                f"CMakeLists.txt: `{old}` does not occur exactly once; adapt {__name__}"
            )
        text = text.replace(old, new)
    build.write_text(text, encoding="utf-8")
