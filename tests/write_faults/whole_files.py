"""Whether a file is whole, by its ending."""

import json
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import jointid as jid
from jointid.study.study_file import read

_GROWING = (".csv", ".log", ".jsonl")  # they may be empty: a session's, a study's
_TABLE = "table.csv"
_ENDS = {".html": b"</html>", ".png": b"IEND\xaeB`\x82", ".svg": b"</svg>", ".parquet": b"PAR1"}


def fault(path: Path) -> str:
    """Why a file is none that its reader takes, or not the whole of it; "" if nothing is wrong.

    What grows may be short; its reader then has to say so in one sentence, or to take what is there.
    """
    content = path.read_bytes()
    suffix = path.suffix
    if path.name == _TABLE:  # its rows, below their headers
        return "" if content.count(b"\n") == 13 and content.endswith(b"\n") else "torn"
    if not content:
        return "" if suffix in _GROWING else "empty"
    try:
        if suffix in _ENDS:
            return "" if content.rstrip(b"\n").endswith(_ENDS[suffix]) else "torn"
        if suffix == ".json":
            json.loads(content)
        elif suffix == ".toml":
            tomllib.loads(content.decode())
            return "" if content.endswith(b"\n") else "torn"
        elif suffix in (".xml", ".urdf"):
            ElementTree.fromstring(content)
        elif suffix == ".jsonl":
            read(path)
        elif suffix in (".csv", ".npz"):
            jid.load(path)
    except jid.InputError as error:
        return "" if "\n" not in str(error) and path.name in str(error) else f"torn: {error}"
    except (ValueError, ElementTree.ParseError) as error:
        return f"torn: {error}"
    return ""
