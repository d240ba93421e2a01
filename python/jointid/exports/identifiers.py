"""Names of a joint and its parameters that programming languages allow."""

from __future__ import annotations

import re

from jointid.exports.provenance import plain

_LONGEST = 24  # C99 distinguishes the first 31 characters of an external name


def identifier(name: str, usual: str = "joint", *, longest: int = _LONGEST) -> str:
    """Return a name of letters, digits and single underscores that begins with a letter.

    `usual` is the prefix of a name that does not begin with a letter, and replaces an empty name.

    Examples
    --------
    >>> identifier("Joint 1 (left)")
    'Joint_1_left'
    """
    words = re.findall(r"[A-Za-z0-9]+", plain(name))
    text = "_".join(words)[:longest].strip("_")
    if not text:
        return usual
    return text if text[0].isalpha() else f"{usual}_{text}"


def parameter_identifier(name: str) -> str:
    """Return a parameter's name with its order as a word: ``ripple_cos_2.5`` is ``ripple_cos_2p5``.

    Examples
    --------
    >>> parameter_identifier("ripple_cos_2.5")
    'ripple_cos_2p5'
    """
    return re.sub(r"[^A-Za-z0-9]+", "_", name.replace(".", "p").replace("e+", "e")).strip("_")
