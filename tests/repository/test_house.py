"""Who may use whom: the rules of `house_rules.py` hold in this repository, and each of them can fail."""

import re
from pathlib import Path

import pytest
from house_rules import FOLDERS, HEAVY, ROOMS, check, unused_arrows

REPOSITORY = Path(__file__).resolve().parents[2]


def test_the_house_is_in_order() -> None:
    assert sorted((REPOSITORY / "cpp").rglob("*.cpp"))
    assert sorted((REPOSITORY / "python").rglob("*.py"))
    assert check(REPOSITORY) == []


def tree(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return root


CLEAN = {
    "cpp/base/pool.hpp": "#pragma once\n#include <thread>\n#include <Eigen/Core>\n",
    "cpp/base/pool.cpp": '#include "pool.hpp"\n#include "base/pool.hpp"\n// #include <iostream>\n',
    "cpp/model/joint.hpp": '#include "base/pool.hpp"\n',
    "cpp/search/genetic.hpp": '#include "base/pool.hpp"\n',
    "cpp/identify/recording/mask.hpp": '#include "base/pool.hpp"\n',
    "cpp/identify/balance/terms.hpp": '#include "identify/recording/mask.hpp"\n',
    "cpp/identify/penalty/penalty.hpp": (
        '#include "model/joint.hpp"\n#include "identify/balance/terms.hpp"\n'
    ),
    "cpp/identify/solve/refit.hpp": (
        '#include "identify/penalty/penalty.hpp"\n#include "search/genetic.hpp"\n'
    ),
    "cpp/bind/module.cpp": (
        '#include <pybind11/pybind11.h>\n#include "identify/penalty/penalty.hpp"\n'
    ),
    "cpp/tests/check.cpp": '#include <cstdio>\n#include "model/joint.hpp"\n',
    "python/jointid/__init__.py": (
        "from jointid.estimate.estimate import Estimate\n"
        "from . import _core\n"
        "def __getattr__(name):\n    from jointid import hardware\n    return hardware\n"
    ),
    "python/jointid/base/__init__.py": "",
    "python/jointid/base/errors.py": "class InputError(ValueError): pass\n",
    "python/jointid/recording/__init__.py": "",
    "python/jointid/recording/recording.py": (
        "from typing import TYPE_CHECKING\nimport numpy as np\nfrom ..base.errors import InputError\n"
        "if TYPE_CHECKING:\n    import pandas\nclass Recording: pass\n"
    ),
    "python/jointid/estimate/__init__.py": "",
    "python/jointid/estimate/estimate.py": "def load():\n    from .json import read\n",
    "python/jointid/estimate/json.py": "def read(): pass\n",
    "python/jointid/identification/__init__.py": "",
    "python/jointid/identification/identify.py": (
        "from jointid import _core\nfrom jointid.recording.recording import Recording\n"
        "from ..estimate.estimate import Estimate\ndef find(): pass\n"
    ),
    "python/jointid/plot/__init__.py": "",
    "python/jointid/plot/estimate.py": (
        "from ..estimate.estimate import Estimate\ndef draw():\n    import matplotlib.pyplot\n"
    ),
    "python/jointid/cli/__init__.py": "",
    "python/jointid/cli/command_line.py": (
        "import jointid\n"
        "def main():\n    from ..plot.estimate import draw\n    from ..hardware.can import bus\n"
    ),
    "python/jointid/hardware/__init__.py": "from .can.bus import Bus\n",
    "python/jointid/hardware/session/__init__.py": "",
    "python/jointid/hardware/session/limits.py": "from ...recording.recording import Recording\n",
    "python/jointid/hardware/can/__init__.py": "",
    "python/jointid/hardware/can/bus.py": "import can\nclass Bus: pass\n",
}


def test_a_clean_house_passes(tmp_path: Path) -> None:
    assert check(tree(tmp_path, CLEAN)) == []


@pytest.mark.parametrize(
    ("file", "line", "complaint"),
    [
        ("cpp/base/pool.hpp", '#include "model/joint.hpp"', "base may use no other room"),
        ("cpp/base/pool.hpp", '#include "../model/joint.hpp"', "base may use no other room"),
        ("cpp/base/pool.hpp", "#include <model/joint.hpp>", "base may use no other room"),
        ("cpp/model/joint.hpp", '#  include "search/genetic.hpp"', "model may use base"),
        ("cpp/search/genetic.hpp", '#include "model/joint.hpp"', "search may use base"),
        ("cpp/model/joint.hpp", '#include "identify/penalty/penalty.hpp"', "model may use base"),
        (
            "cpp/identify/recording/mask.hpp",
            '#include "identify/balance/terms.hpp"',
            "identify/recording may use base",
        ),
        (
            "cpp/identify/penalty/penalty.hpp",
            '#include "../solve/refit.hpp"',
            "identify/penalty may use base, identify/balance, identify/recording, model",
        ),
        ("cpp/identify/extra/new.hpp", "", "room 'identify/extra' is unknown"),
        ("cpp/identify/loose.hpp", "", "room 'identify' is unknown"),
        ("cpp/tests/check.cpp", '#include "bind/module.cpp"', "tests may use base"),
        ("cpp/search/genetic.hpp", "#include <pybind11/numpy.h>", "only bind/ knows of Python"),
        ("cpp/tests/check.cpp", "#include <Python.h>", "only bind/ knows of Python"),
        ("cpp/base/pool.hpp", "#include <iostream>", "prints nothing"),
        ("cpp/bind/module.cpp", "#include <cstdio>", "prints nothing"),
        ("cpp/base/digits.cpp", "#include <iostream>", "prints nothing"),
        ("cpp/base/digits.cpp", 'void f() { printf("1"); }', "prints:"),
        ("cpp/base/pool.cpp", "void f() { std::cerr << 1; }", "prints:"),
        ("cpp/base/pool.cpp", 'void f() { printf("1"); }', "prints:"),
        ("cpp/base/pool.cpp", "#include <boost/any.hpp>", "std and Eigen only"),
        ("cpp/base/pool.cpp", "#include <pthread.h>", "std and Eigen only"),
        ("cpp/base/pool.cpp", '#include "gone.hpp"', "not in cpp/"),
        ("cpp/attic/old.cpp", "", "room 'attic' is unknown"),
        ("cpp/base/math_utils.hpp", "", "'utils' says nothing"),
        ("cpp/base/pool.hpp", "//\n" * 397, "has 401 lines"),
    ],
)
def test_a_forbidden_include_is_found(tmp_path: Path, file: str, line: str, complaint: str) -> None:
    house = tree(tmp_path, {**CLEAN, file: CLEAN.get(file, "") + line + "\n"})
    (found,) = check(house)
    assert found.startswith(f"{file}: ")
    assert complaint in found


RUN, FIND, DRAW = "recording/recording.py", "identification/identify.py", "plot/estimate.py"
LIMITS = "hardware/session/limits.py"


@pytest.mark.parametrize(
    ("file", "line", "complaint"),
    [
        (RUN, "from jointid.identification.identify import find", "recording may use base"),
        (RUN, "from jointid.identification import identify", "recording may use base"),
        (RUN, "def f():\n    from ..cli import command_line", "recording may use base"),
        (RUN, "import jointid.plot.estimate", "recording may use base"),
        (RUN, "import jointid", "jointid. (face)"),
        (RUN, "from jointid import identify", "jointid. (face)"),
        (FIND, "from jointid.hardware.can import bus", "identification may use balance, base"),
        (FIND, "def f():\n    import jointid.hardware.can.bus", "identification may use"),
        (FIND, "from ..plot.estimate import draw", "identification may use balance, base"),
        (LIMITS, "from ...identification.identify import find", "hardware/session may use base"),
        (LIMITS, "def f():\n    from jointid import plot", "hardware/session may use base"),
        (LIMITS, "from ..can import bus", "hardware/session may use base"),
        (
            RUN,
            "def f():\n    import_module('jointid.cli.command_line')",
            "recording may use base",
        ),
        (RUN, "import can", "packages allowed in recording"),
        (RUN, "import requests", "packages allowed in recording"),
        (DRAW, "def f():\n    import scipy", "packages allowed in plot"),
        (RUN, "import pandas as pd", "imports pandas with the module"),
        (
            "joint/file.py",
            "try:\n    import tomlkit\nexcept ImportError: pass",
            "imports tomlkit with",
        ),
        ("exports/matlab.py", "class A:\n    from scipy import io", "scipy with the module"),
        (DRAW, "from matplotlib import pyplot", "imports matplotlib with the module"),
        ("cli/command_line.py", "from jointid.hardware.can import bus", "with the module"),
        ("__init__.py", "from . import hardware", "with the module"),
        ("sweeping.py", "", "stands at the top"),
        ("sweeps/sweeping.py", "", "folder 'sweeps' is unknown"),
        ("hardware/can/frames/codec.py", "", "folder 'hardware/can/frames' is unknown"),
        (RUN, "from ..sweeps.sweeping import sweep", "unknown to tests/house_rules.py"),
        (RUN, "class recording: pass", "bears the name"),
        (RUN, "#\n" * 400, "lines, the longest allowed is 400"),
    ],
)
def test_a_forbidden_import_is_found(tmp_path: Path, file: str, line: str, complaint: str) -> None:
    place = f"python/jointid/{file}"
    house = tree(tmp_path, {**CLEAN, place: CLEAN.get(place, "") + line + "\n"})
    first, *others = check(house)
    assert first.startswith(f"{place}: ")
    assert complaint in first
    assert all("import each other" in other for other in others)


@pytest.mark.parametrize("word", ["data", "manager", "helper", "utils", "handler", "process", "do"])
def test_a_name_that_says_nothing_is_found(tmp_path: Path, word: str) -> None:
    house = tree(tmp_path, {**CLEAN, f"python/jointid/hardware/can/{word}_frames.py": ""})
    (found,) = check(house)
    assert f"'{word}' says nothing" in found


@pytest.mark.parametrize(
    "line",
    [
        "from .mask import Mask",
        "def f():\n    from jointid.recording import mask",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import jointid.recording.mask",
    ],
)
def test_files_that_import_each_other_are_found(tmp_path: Path, line: str) -> None:
    places = {
        "python/jointid/recording/recording.py": f"{line}\nclass Recording: pass\n",
        "python/jointid/recording/mask.py": "from .slicing import part\nclass Mask: pass\n",
        "python/jointid/recording/slicing.py": "from .recording import Recording\ndef part(): pass\n",
    }
    (found,) = check(tree(tmp_path, {**CLEAN, **places}))
    names = "recording.mask, recording.recording, recording.slicing"
    assert found == f"python/jointid: files {names} import each other"


def test_a_circle_that_crosses_folders_is_found(tmp_path: Path) -> None:
    """In a function, where the tables allow both directions: no table can allow that."""
    places = {
        "python/jointid/plot/estimate.py": "def f():\n    from jointid.report import html\n",
        "python/jointid/report/__init__.py": "",
        "python/jointid/report/html.py": "from jointid.plot import estimate\n",
    }
    found = check(tree(tmp_path, {**CLEAN, **places}))
    assert any("files plot.estimate, report.html import each other" in f for f in found)
    assert any("folders plot, report import each other" in f for f in found)


def test_folders_that_import_each_other_are_found_without_a_circle_of_modules(
    tmp_path: Path,
) -> None:
    places = {
        "python/jointid/plot/other.py": "from jointid.report import html\n",
        "python/jointid/report/__init__.py": "",
        "python/jointid/report/html.py": "from jointid.plot import estimate\n",
    }
    found = check(tree(tmp_path, {**CLEAN, **places}))
    assert not any("files" in f for f in found)
    assert any("folders plot, report import each other" in f for f in found)


def test_files_that_are_long_in_the_median_are_found(tmp_path: Path) -> None:
    long = {name: text + "#\n" * 140 for name, text in CLEAN.items() if name.endswith(".py")}
    (found,) = check(tree(tmp_path, {**CLEAN, **long}))
    assert "half of its files" in found


def test_the_tables_name_only_what_they_know() -> None:
    assert all(used <= ROOMS.keys() for used in ROOMS.values())
    assert all(folder.may_use <= FOLDERS.keys() for folder in FOLDERS.values())
    assert set().union(*(folder.packages for folder in FOLDERS.values())) >= HEAVY - {"canopen"}
    assert all(name.count("/") < 2 for name in FOLDERS)


def test_the_table_allows_no_more_than_is_used() -> None:
    assert unused_arrows(REPOSITORY / "python" / "jointid") == []


HOUSE = (REPOSITORY / "docs" / "contributors" / "house.md").read_text(encoding="utf-8")
TABLES = [
    pytest.param("Python", {n: f.may_use - {""} for n, f in FOLDERS.items() if n}, id="Python"),
    pytest.param("Core", ROOMS, id="core"),
]


def rows(heading: str) -> list[str]:
    """The folders of a table of the house's page, in its order."""
    (table,) = re.findall(rf"^## {heading}: .*?\n(.*?)(?=^## |\Z)", HOUSE, re.MULTILINE | re.DOTALL)
    return re.findall(r"^\| `([\w/]+)` \|", table, re.MULTILINE)


@pytest.mark.parametrize(("heading", "used"), TABLES)
def test_the_house_has_one_row_for_each_folder(heading: str, used: dict[str, set[str]]) -> None:
    assert sorted(rows(heading)) == sorted(used)


@pytest.mark.parametrize(("heading", "used"), TABLES)
def test_a_folder_uses_only_rows_above_its_own(heading: str, used: dict[str, set[str]]) -> None:
    """So no circle is possible, and the order of the rows is the flow of the data."""
    above: set[str] = set()
    for folder in rows(heading):
        assert used[folder] - {folder} <= above, folder
        above.add(folder)


def test_the_arrows_that_are_drawn_are_allowed() -> None:
    (drawing,) = re.findall(
        r"^```mermaid\nflowchart LR\n(.*?)^```", HOUSE, re.MULTILINE | re.DOTALL
    )
    names = dict(re.findall(r'(\w+)\["([\w/]+)"\]', drawing))
    for line in drawing.splitlines():
        arrow = re.fullmatch(r'  (\w+)(?:\[".*"\])? (-->|-\. makes \.->) (\w+)', line)
        assert arrow, line
        left, right = (names.get(each, each) for each in (str(arrow[1]), str(arrow[3])))
        user, source = (right, left) if arrow[2] == "-->" else (left, right)
        assert source in {inner.split("/")[0] for inner in used_by(user)} | used_by(user), line


def used_by(place: str) -> set[str]:
    """The folders that a folder and those inside it may use."""
    inside = [f.may_use for n, f in FOLDERS.items() if n == place or n.startswith(f"{place}/")]
    return set().union(*inside)
